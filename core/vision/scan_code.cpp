#include "core/vision/scan_code.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace skincal {
namespace {

using Colour = std::array<int, 3>;

std::vector<LitModule> allOf(std::span<const ModuleId> modules, std::optional<Colour> colour = std::nullopt) {
    std::vector<LitModule> all;
    for (const ModuleId module : modules)
        all.push_back({module, colour});
    return all;
}

LitSets afterPrimaries(std::span<const ModuleId> modules, LitSets scan) {
    scan.insert(scan.begin(),
                {allOf(modules, Colour{1, 0, 0}), allOf(modules, Colour{0, 1, 0}), allOf(modules, Colour{0, 0, 1})});
    return scan;
}

LitSets afterAToggle(std::span<const ModuleId> modules, LitSets scan) {
    scan.insert(scan.begin(), {{}, allOf(modules)});
    return scan;
}

}  // namespace

LitSets oneAtATimeScan(std::span<const ModuleId> modules, int repeats) {
    LitSets scan;
    for (const ModuleId module : modules) {
        for (int repeat = 0; repeat < repeats; ++repeat) {
            scan.emplace_back();
            scan.push_back({{module, std::nullopt}});
        }
    }
    scan.emplace_back();
    return scan;
}

LitSets colouredScan(std::span<const ModuleId> modules) {
    static constexpr std::array<Colour, 7> kColours{
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}}};
    LitSets scan;
    for (std::size_t first = 0; first < modules.size(); first += kColours.size()) {
        scan.emplace_back();
        auto& lit = scan.emplace_back();
        for (std::size_t i = first; i < std::min(modules.size(), first + kColours.size()); ++i)
            lit.push_back({modules[i], kColours.at(i - first)});
    }
    scan.emplace_back();
    return scan;
}

LitSets scanOf(ScanCode code, std::span<const ModuleId> modules, std::uint64_t seed) {
    switch (code) {
        case ScanCode::Words:
            return codedScan(modules, seed);
        case ScanCode::OneAtATime:
            return afterAToggle(modules, oneAtATimeScan(modules));
        case ScanCode::Colours:
            return afterAToggle(modules, afterPrimaries(modules, colouredScan(modules)));
    }
    throw std::logic_error("unknown ScanCode");
}

}  // namespace skincal
