#include <fmt/format.h>

#include "core/simulation/world.h"
#include "core/vision/scan_code.h"

namespace skincal {
namespace {

LitSets litSetsOf(const World& world) {
    std::vector<ModuleId> modules;
    for (const SkinModule& module : world.skin.modules)
        modules.push_back(module.id);
    const ViewOptions& options = world.scenario.views;
    switch (options.scan) {
        case ScanKind::Detections:
            return {};
        case ScanKind::Coded:
            return codedScan(modules, world.seed);
        case ScanKind::OneAtATime:
            return oneAtATimeScan(modules, options.repeats);
        case ScanKind::Coloured:
            return colouredScan(modules);
    }
    return {};
}

}  // namespace

std::vector<FrameInfo> planScan(const World& world, std::size_t view) {
    constexpr double kFramesPerSecond = 30;
    std::vector<FrameInfo> frames;
    for (std::vector<LitModule>& lit : litSetsOf(world)) {
        FrameInfo& frame = frames.emplace_back();
        frame.file = fmt::format("views/{:03}/{:05}.png", view, frames.size() - 1);
        frame.lit = std::move(lit);
        frame.time_s = static_cast<double>(frames.size() - 1) / kFramesPerSecond;
    }
    return frames;
}

}  // namespace skincal
