#include <fmt/format.h>

#include "core/study/accuracy_study.h"

namespace skincal {
namespace {

constexpr const char* kNothing = "–";

std::string millimetres(const std::optional<PoseAccuracy>& accuracy) {
    return accuracy ? fmt::format("{:.3f}", 1e3 * accuracy->positionRms) : kNothing;
}

std::string degrees(const std::optional<PoseAccuracy>& accuracy) {
    return accuracy ? fmt::format("{:.2f}", accuracy->rotationRms / kDegree) : kNothing;
}

std::string number(const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : kNothing;
}

std::string row(const WorldAccuracy& world) {
    const auto& c = world.consistency;
    return fmt::format(
        "| {} | {} | {} of {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.1f} |\n", world.seed, world.world,
        world.placed, world.modules, millimetres(world.fromData), millimetres(world.fromTruth), number(world.ratio, 3),
        degrees(world.fromData), degrees(world.fromTruth), world.verdict ? name(*world.verdict) : world.failure,
        c ? fmt::format("{:.1f}", c->meanNees) : kNothing, c ? fmt::format("{:.1f}", c->largestSigmas) : kNothing,
        c ? fmt::format("{}", c->beyondFive) : kNothing, world.seconds);
}

std::string lines(const AccuracySummary& summary, std::size_t worlds) {
    std::string text = fmt::format("Position rms from the data to from the truth: geometric mean {}",
                                   number(summary.geometricMean, 3));
    if (summary.worst)
        text += fmt::format(", worst {:.3f} (seed {})", *summary.worst, summary.worstSeed);
    text += fmt::format(".\nOf {} modules in {} worlds {} beyond five sigma, {} not placed that could be.\n",
                        summary.modules, worlds, summary.beyondFive, summary.missed);
    if (summary.withoutResult > 0)
        text += fmt::format("Nothing to compare in {} worlds.\n", summary.withoutResult);
    if (const auto& nees = summary.nees)
        text += fmt::format(
            "NEES of one module per world: mean {:.2f}, {:.2f} to {:.2f} if the covariances are right (95 %)",
            nees->mean, nees->low, nees->high);
    if (summary.nees && summary.neesFromTruth)
        text += fmt::format("; from the truth {:.2f}", summary.neesFromTruth->mean);
    if (summary.nees)
        text += ".\n";
    return text;
}

}  // namespace

std::string accuracyTable(const AccuracyStudy& study) {
    std::string text =
        "| seed | world | placed | from data, mm | from truth, mm | ratio | from data, ° | from truth, ° | verdict | "
        "mean NEES | largest, sigma | beyond 5 | seconds |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const WorldAccuracy& world : study.worlds)
        text += row(world);
    return text + "\n" + lines(summarise(study.worlds), study.worlds.size());
}

std::string inWords(const WorldAccuracy& world) {
    std::string text =
        fmt::format("seed {} ({}): {} of {} placed, {} missed, {} mm from the data, {} mm from the truth, ratio {}",
                    world.seed, world.world, world.placed, world.modules, world.missed, millimetres(world.fromData),
                    millimetres(world.fromTruth), number(world.ratio, 3));
    if (const auto& c = world.consistency)
        text += fmt::format(", mean NEES {:.1f}, largest error {:.1f} sigma, {} beyond five", c->meanNees,
                            c->largestSigmas, c->beyondFive);
    if (!world.failure.empty())
        text += ", failed: " + world.failure;
    return text;
}

}  // namespace skincal
