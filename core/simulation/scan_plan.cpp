#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/simulation/world.h"
#include "core/vision/coded_scan.h"

namespace skincal {
namespace {

class ScanWriter {
  public:
    explicit ScanWriter(std::size_t view) : view_(view) {}
    void add(std::vector<LitModule> lit) {
        FrameInfo frame;
        frame.file = fmt::format("views/{:03}/{:05}.png", view_, frames_.size());
        frame.lit = std::move(lit);
        frame.time_s = static_cast<double>(frames_.size()) / 30.0;
        frames_.push_back(std::move(frame));
    }
    std::vector<FrameInfo> take() { return std::move(frames_); }

  private:
    std::size_t view_;
    std::vector<FrameInfo> frames_;
};

std::vector<FrameInfo> planCoded(const World& world, std::size_t view) {
    std::vector<ModuleId> modules;
    for (const SkinModule& module : world.skin.modules)
        modules.push_back(module.id);
    ScanWriter scan(view);
    for (std::vector<LitModule>& lit : codedScan(modules, world.seed))
        scan.add(std::move(lit));
    return scan.take();
}

}  // namespace

std::vector<FrameInfo> planScan(const World& world, std::size_t view) {
    static constexpr std::array<std::array<int, 3>, 7> kColours{
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}}};
    const ViewOptions& options = world.scenario.views;
    ScanWriter scan(view);
    const auto& modules = world.skin.modules;
    switch (options.scan) {
        case ScanKind::Detections:
            return {};
        case ScanKind::Coded:
            return planCoded(world, view);
        case ScanKind::OneAtATime:
            for (const SkinModule& module : modules) {
                for (int repeat = 0; repeat < options.repeats; ++repeat) {
                    scan.add({});
                    scan.add({{module.id, std::nullopt}});
                }
            }
            break;
        case ScanKind::Coloured:
            for (std::size_t first = 0; first < modules.size(); first += kColours.size()) {
                std::vector<LitModule> lit;
                for (std::size_t i = first; i < std::min(modules.size(), first + kColours.size()); ++i)
                    lit.push_back({modules[i].id, kColours.at(i - first)});
                scan.add({});
                scan.add(std::move(lit));
            }
            break;
    }
    scan.add({});
    return scan.take();
}

}  // namespace skincal
