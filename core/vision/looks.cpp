#include "core/vision/looks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

const LedDetection* findIn(const std::vector<LedDetection>& found, ModuleId module) {
    const auto at =
        std::find_if(found.begin(), found.end(), [&](const LedDetection& other) { return other.module == module; });
    return at == found.end() ? nullptr : &*at;
}

/// From the first look to the further one; nothing where none was found by both.
std::optional<Vector2d> motionSince(const ViewDetections& view, const ViewDetections& further) {
    std::vector<double> x;
    std::vector<double> y;
    for (const LedDetection& now : further.found) {
        if (const LedDetection* before = findIn(view.found, now.module)) {
            x.push_back(now.pixel.x() - before->pixel.x());
            y.push_back(now.pixel.y() - before->pixel.y());
        }
    }
    if (x.empty())
        return std::nullopt;
    return Vector2d(median(std::move(x)), median(std::move(y)));
}

}  // namespace

std::vector<std::size_t> beginningsOfLooks(std::span<const FrameInfo> frames) {
    std::vector<std::size_t> beginnings{0};
    for (std::size_t k = 1; k < frames.size(); ++k) {
        if (frames[k].look != frames[k - 1].look)
            beginnings.push_back(k);
    }
    return beginnings;
}

std::vector<ModuleId> modulesLitIn(std::span<const FrameInfo> look) {
    std::set<ModuleId> modules;
    for (const FrameInfo& frame : look) {
        for (const LitModule& lit : frame.lit)
            modules.insert(lit.module);
    }
    return {modules.begin(), modules.end()};
}

bool addLook(ViewDetections& view, const ViewDetections& further, const LookOptions& options) {
    if (!options.validate())
        throw std::logic_error("LookOptions out of range");
    const bool isFirst = view.found.empty();
    const std::optional<Vector2d> shift = motionSince(view, further);
    const double moved = shift ? shift->norm() : 0;
    const double movedAtAll = std::max(moved, further.moved_px.value_or(0));
    if (isFirst) {
        // Of pictures that gave nothing nothing is left that could have moved.
        view.moved_px = further.moved_px;
        view.look = further.look;
    } else if (shift || further.moved_px) {
        view.moved_px = std::max(view.moved_px.value_or(0), movedAtAll);
    }
    if (movedAtAll > options.maxMotion_px || (!isFirst && !shift))
        return false;
    const std::vector<LedDetection> before = view.found;
    const auto undetected = [&](ModuleId module) {
        return std::find_if(view.undetected.begin(), view.undetected.end(),
                            [&](const Undetected& other) { return other.module == module; });
    };
    for (std::size_t i = 0; i < further.found.size(); ++i) {
        LedDetection found = further.found[i];
        const auto missing = undetected(found.module);
        if (missing == view.undetected.end())
            continue;
        found.pixel -= shift.value_or(Vector2d::Zero());
        found.sigma_px = std::hypot(found.sigma_px, 0.5 * moved);
        const auto there = std::find_if(before.begin(), before.end(), [&](const LedDetection& other) {
            return (other.pixel - found.pixel).norm() < options.sameSpot_px;
        });
        if (there != before.end()) {
            missing->verdict = DetectionVerdict::Ambiguous;
            missing->reason = Sentence::saying("its spot is where module {} was found", there->module.value);
            missing->cause = Undetected::Cause::Alike;
            missing->spots.clear();
            continue;
        }
        view.undetected.erase(missing);
        view.found.push_back(found);
        if (i < further.readings.size())
            view.readings.push_back(further.readings[i]);
    }
    view.unexplained = further.unexplained;
    for (Undetected now : further.undetected) {
        const auto missing = undetected(now.module);
        if (missing == view.undetected.end() ||
            (missing->cause != Undetected::Cause::OutOfSight && missing->cause != Undetected::Cause::CameraMoved))
            continue;
        for (SpotChoice& spot : now.spots) {
            spot.pixel -= shift.value_or(Vector2d::Zero());
            spot.sigma_px = std::hypot(spot.sigma_px, 0.5 * moved);
        }
        *missing = std::move(now);
    }
    return true;
}

void sortAs(std::span<const ModuleId> modules, ViewDetections& view) {
    std::map<ModuleId, std::size_t> place;
    for (const ModuleId module : modules)
        place.emplace(module, place.size());
    std::vector<std::size_t> order(view.found.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return place.at(view.found[a].module) < place.at(view.found[b].module);
    });
    std::vector<LedDetection> found;
    std::vector<WordReading> readings;
    for (const std::size_t i : order) {
        found.push_back(view.found[i]);
        if (i < view.readings.size())
            readings.push_back(std::move(view.readings[i]));
    }
    view.found = std::move(found);
    view.readings = std::move(readings);
    std::sort(view.undetected.begin(), view.undetected.end(),
              [&](const Undetected& a, const Undetected& b) { return place.at(a.module) < place.at(b.module); });
}

}  // namespace skincal
