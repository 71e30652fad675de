#include <fmt/format.h>

#include <cmath>

#include "core/study/paper_experiments.h"

namespace skincal {
namespace {

std::string number(const std::optional<double>& value) {
    if (!value)
        return "–";
    return *value != 0 && std::abs(*value) < 1 ? fmt::format("{:.3f}", *value) : fmt::format("{:.2f}", *value);
}

std::string outcome(const MethodOutcome& m, int trials) {
    if (!m.mean)
        return "none solved";
    if (!m.rms)
        return number(m.mean);
    std::string text = fmt::format("{} ({})", number(m.mean), number(m.rms));
    if (m.solved < trials)
        text += fmt::format(", {} of {}", m.solved, trials);
    return text;
}

}  // namespace

std::string studyTable(const PaperStudy& study) {
    std::string text =
        "| experiment | quantity | truth | paper printed | paper method | ours | Cramér–Rao |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n";
    for (const ExperimentRow& row : study.rows)
        text += fmt::format("| {} | {}, {} | {} | {} | {} | {} | {} |\n", row.experiment, row.quantity, row.unit,
                            row.paper.rms || row.ours.rms ? number(row.truth) : "–", number(row.printed),
                            outcome(row.paper, study.options.trials), outcome(row.ours, study.options.trials),
                            number(row.bound));
    return text;
}

}  // namespace skincal
