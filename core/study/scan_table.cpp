#include <fmt/format.h>

#include <algorithm>

#include "core/study/scan_study.h"

namespace skincal {
namespace {

std::string percent(std::size_t part, std::size_t whole) {
    return whole > 0 ? fmt::format("{:.2f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole)) : "–";
}

std::string line(const std::string& what, const ScanScore& score) {
    const auto figure = [](std::size_t of, double value, int digits) {
        return of > 0 ? fmt::format("{:.{}f}", value, digits) : "–";
    };
    return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", what, score.visible,
                       percent(score.found, score.visible), percent(score.choices, score.visible),
                       percent(score.settled, score.visible), score.wrong, figure(score.found, score.rms_px(), 3),
                       figure(score.found, score.rmsSigmas(), 2), figure(score.sharp, score.rmsBounds(), 2));
}

}  // namespace

std::string scanTable(const ScanStudy& study) {
    std::string text =
        "| disturbance | strength | modules | distance, m | scan | pictures | visible | found | to choose from | taken "
        "by the body "
        "| wrong | rms, px | rms, sigma | rms, bounds |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    ScanScore coded;
    for (const ScanStudyRow& row : study.rows) {
        const ScanCase& what = row.what;
        text += line(
            fmt::format("{} | {} | {} | {} | {} | {}", name(what.disturbance), what.strength, what.modules,
                        what.distance, name(what.method), row.score.frames / std::max<std::size_t>(1, row.score.views)),
            row.score);
        if (what.method == ScanMethod::Coded)
            coded.add(row.score);
    }
    if (coded.views > 0)
        text += fmt::format(
            "\n{} coded scans, {} of them refused: {} modules visible, {} found, {} more by the body, {} "
            "wrong.\n",
            coded.views, coded.refused, coded.visible, percent(coded.found, coded.visible),
            percent(coded.settled, coded.visible), coded.wrong);
    return text;
}

}  // namespace skincal
