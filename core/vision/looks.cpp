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

using PlaceOf = std::map<ModuleId, std::size_t>;

template <class Entry>
PlaceOf placesIn(const std::vector<Entry>& entries) {
    PlaceOf places;
    for (std::size_t i = 0; i < entries.size(); ++i)
        places.emplace(entries[i].module, i);
    return places;
}

/// Spots by where they are, to find those that are nearer to a place than so far.
class Nearby {
  public:
    Nearby(std::span<const LedDetection> spots, double reach_px) : spots_(spots), reach_px_(reach_px) {
        for (std::size_t i = 0; i < spots.size(); ++i)
            cells_[cellOf(spots[i].pixel)].push_back(i);
    }
    /// The first of them, null where there is none.
    [[nodiscard]] const LedDetection* first(const Vector2d& pixel) const {
        const auto [column, row] = cellOf(pixel);
        std::size_t first = spots_.size();
        for (int dx = -1; dx <= 1; ++dx)
            for (int dy = -1; dy <= 1; ++dy) {
                const auto cell = cells_.find({column + dx, row + dy});
                if (cell == cells_.end())
                    continue;
                for (const std::size_t i : cell->second) {
                    if ((spots_[i].pixel - pixel).norm() < reach_px_)
                        first = std::min(first, i);
                }
            }
        return first == spots_.size() ? nullptr : &spots_[first];
    }

  private:
    [[nodiscard]] std::pair<int, int> cellOf(const Vector2d& pixel) const {
        return {static_cast<int>(std::floor(pixel.x() / reach_px_)),
                static_cast<int>(std::floor(pixel.y() / reach_px_))};
    }

    std::span<const LedDetection> spots_;
    double reach_px_;
    std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

/// The median distance from the median.
double scatterOf(std::vector<double> values) {
    const double middle = median(values);
    for (double& value : values)
        value = std::abs(value - middle);
    return median(std::move(values));
}

/// Of the camera, from the first look to the further one.
struct LookMotion {
    Vector2d shift = Vector2d::Zero();  ///< zero where the modules found by both can't tell it from that
    double length_px = 0;               ///< as they have it
};

/// Nothing where no module was found by both.
std::optional<LookMotion> motionSince(const ViewDetections& view, const ViewDetections& further) {
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> sigmas;
    const PlaceOf found = placesIn(view.found);
    for (const LedDetection& now : further.found) {
        if (const auto at = found.find(now.module); at != found.end()) {
            const LedDetection& before = view.found[at->second];
            x.push_back(now.pixel.x() - before.pixel.x());
            y.push_back(now.pixel.y() - before.pixel.y());
            sigmas.push_back(std::hypot(now.sigma_px, before.sigma_px));
        }
    }
    if (x.empty())
        return std::nullopt;
    // Of normal errors: standard deviation over median distance, and that of their median over theirs, times sqrt(n).
    constexpr double kOverMedian = 1.483;
    constexpr double kOfMedian = 1.253;
    constexpr double kSigmas = 3;
    const double sigma = std::max({median(std::move(sigmas)), kOverMedian * scatterOf(x), kOverMedian * scatterOf(y)});
    const double least = kSigmas * kOfMedian * sigma / std::sqrt(static_cast<double>(x.size()));
    const Vector2d motion(median(std::move(x)), median(std::move(y)));
    return LookMotion{motion.norm() > least ? motion : Vector2d::Zero(), motion.norm()};
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

bool hasChoices(const ViewDetections& view) {
    return std::any_of(view.undetected.begin(), view.undetected.end(),
                       [](const Undetected& one) { return !one.spots.empty(); });
}

bool addLook(ViewDetections& view, const ViewDetections& further, const LookOptions& options) {
    if (!options.validate())
        throw std::logic_error("LookOptions out of range");
    const bool isFirst = view.found.empty();
    // Pixels of two cameras are none of one view.
    if (isFirst && hasChoices(view))
        return false;
    const std::optional<LookMotion> motion = motionSince(view, further);
    const Vector2d shift = motion ? motion->shift : Vector2d::Zero();
    const double moved = motion ? motion->length_px : 0;
    const double movedAtAll = std::max(moved, further.moved_px.value_or(0));
    if (isFirst) {
        // Of pictures that gave nothing nothing is left that could have moved.
        view.moved_px = further.moved_px;
        view.look = further.look;
    } else if (motion || further.moved_px) {
        view.moved_px = std::max(view.moved_px.value_or(0), movedAtAll);
    }
    if (movedAtAll > options.maxMotion_px || (!isFirst && !motion))
        return false;
    view.mirrored = further.mirrored;
    const std::vector<LedDetection> before = view.found;
    const Nearby spots(before, options.sameSpot_px);
    PlaceOf places = placesIn(view.undetected);
    const auto undetected = [&](ModuleId module) -> Undetected* {
        const auto at = places.find(module);
        return at == places.end() ? nullptr : &view.undetected[at->second];
    };
    for (std::size_t i = 0; i < further.found.size(); ++i) {
        LedDetection found = further.found[i];
        Undetected* missing = undetected(found.module);
        if (missing == nullptr)
            continue;
        found.pixel -= shift;
        found.sigma_px = std::hypot(found.sigma_px, 0.5 * moved);
        if (const LedDetection* there = spots.first(found.pixel)) {
            missing->verdict = DetectionVerdict::Ambiguous;
            missing->reason = Sentence::saying("its spot is where module {} was found", there->module.value);
            missing->cause = Undetected::Cause::Alike;
            missing->spots.clear();
            missing->nearest.reset();
            if (i < further.readings.size())
                missing->nearest = NearestSpot{found.pixel, further.readings[i]};
            continue;
        }
        places.erase(found.module);
        view.found.push_back(found);
        if (i < further.readings.size())
            view.readings.push_back(further.readings[i]);
    }
    view.unexplained = further.unexplained;
    for (Undetected now : further.undetected) {
        Undetected* missing = undetected(now.module);
        if (missing == nullptr || !missing->spots.empty())
            continue;
        const bool hasReason =
            missing->cause != Undetected::Cause::OutOfSight && missing->cause != Undetected::Cause::CameraMoved;
        if (hasReason && now.spots.empty())
            continue;
        for (SpotChoice& spot : now.spots) {
            spot.pixel -= shift;
            spot.sigma_px = std::hypot(spot.sigma_px, 0.5 * moved);
        }
        if (now.nearest)
            now.nearest->pixel -= shift;
        *missing = std::move(now);
    }
    std::erase_if(view.undetected, [&](const Undetected& one) { return !places.contains(one.module); });
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
