#include "core/estimation/shape_spots.h"

#include <algorithm>
#include <optional>
#include <set>
#include <span>

#include "core/vision/looks.h"

namespace skincal {
namespace {

/// Everything that may be the LED of a module where hardly one of its patch is sure.
struct Spots {
    std::vector<PixelObservation> pixels;
    std::vector<const Undetected*> undetected;  ///< whose choice it is; null for a sure one
};

/// @param posed  views and patches of which the sure ones are enough
Spots spotsOf(const Measurements& measurements, const SkinLayout& layout, const std::vector<PixelObservation>& sure,
              const std::set<std::pair<std::size_t, std::size_t>>& posed) {
    Spots spots;
    std::set<std::pair<std::size_t, std::size_t>> isSure;
    for (const PixelObservation& o : sure) {
        if (posed.contains({o.view, layout.patchOf[o.module]}))
            continue;
        isSure.insert({o.view, o.module});
        spots.pixels.push_back(o);
        spots.undetected.push_back(nullptr);
    }
    const auto index = measurements.skin.indexById();
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        for (const Undetected& undetected : measurements.views[v].undetected) {
            const auto module = index.find(undetected.module);
            if (module == index.end() || posed.contains({v, layout.patchOf[module->second]}) ||
                isSure.contains({v, module->second}))
                continue;
            for (const SpotChoice& spot : undetected.spots) {
                spots.pixels.push_back({v, module->second, spot.pixel, spot.sigma_px});
                spots.undetected.push_back(&undetected);
            }
        }
    }
    return spots;
}

/// The one of an LED's pixels, `first` up to `last`, that a pose takes.
std::optional<std::size_t> takenBy(const PatchPose& pose, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
        if (pose.inliers[i])
            return i;
    }
    return std::nullopt;
}

/// Those that all poses agree on; nothing where they agree on less than half.
std::vector<std::size_t> agreedOn(std::span<const LedCorrespondence> leds, const std::vector<PatchPose>& poses,
                                  double apart_px) {
    std::vector<std::size_t> agreed;
    std::size_t disputed = 0;
    for (std::size_t first = 0; first < leds.size();) {
        std::size_t last = first + 1;
        while (last < leds.size() && leds[last].isAlternative)
            ++last;
        const auto taken = takenBy(poses.front(), first, last);
        const bool isDisputed = std::any_of(poses.begin() + 1, poses.end(), [&](const PatchPose& other) {
            const auto own = takenBy(other, first, last);
            return own && own != taken;
        });
        bool isNearAnother = false;
        for (std::size_t i = first; taken && i < last; ++i)
            isNearAnother = isNearAnother || (i != *taken && (leds[i].pixel - leds[*taken].pixel).norm() < apart_px);
        disputed += isDisputed ? 1 : 0;
        if (taken && !isDisputed && !isNearAnother)
            agreed.push_back(*taken);
        first = last;
    }
    return disputed > agreed.size() ? std::vector<std::size_t>{} : agreed;
}

Sentence whyTaken(const Undetected& undetected) {
    return undetected.spots.size() == 1
               ? Sentence::saying("{}: it lies where the shape of its patch has it", undetected.reason)
               : Sentence::saying("{}: this one lies where the shape of its patch has it", undetected.reason);
}

}  // namespace

std::vector<ChosenSpot> chooseSpotsByShape(const Measurements& measurements, const SkinLayout& layout,
                                           const std::vector<PatchShape>& shapes,
                                           const std::vector<PixelObservation>& pixels,
                                           const PatchPoseOptions& options) {
    if (std::none_of(measurements.views.begin(), measurements.views.end(), hasChoices))
        return {};
    std::set<std::pair<std::size_t, std::size_t>> posed;
    for (const PatchSighting& sighting : collectSightings(measurements.skin, layout, shapes, pixels)) {
        if (sighting.leds.size() >= static_cast<std::size_t>(options.minInliers))
            posed.insert({sighting.view, sighting.patch});
    }
    const Spots spots = spotsOf(measurements, layout, pixels, posed);
    PatchPoseOptions careful = options;
    constexpr int kFewest = 6;  // three make a pose, and of many spots a fourth lies near it by chance
    careful.minInliers = std::max(kFewest, options.minInliers);
    careful.maxCandidates = std::max(4, options.maxCandidates);
    std::vector<ChosenSpot> chosen;
    auto doubtful = collectSightings(measurements.skin, layout, shapes, spots.pixels);
    for (PatchSighting& sighting : doubtful) {
        const auto moduleOf = [&](std::size_t i) { return spots.pixels[sighting.observations[i]].module; };
        for (std::size_t i = 1; i < sighting.leds.size(); ++i)
            sighting.leds[i].isAlternative = moduleOf(i) == moduleOf(i - 1);
        const auto poses = estimatePatchPoses(sighting.leds, measurements.camera, careful);
        if (!poses)
            continue;
        for (const std::size_t i : agreedOn(sighting.leds, *poses, options.maxResidual_px)) {
            const Undetected* undetected = spots.undetected[sighting.observations[i]];
            if (undetected == nullptr)
                continue;
            const auto spot =
                std::find_if(undetected->spots.begin(), undetected->spots.end(),
                             [&](const SpotChoice& choice) { return choice.pixel == sighting.leds[i].pixel; });
            chosen.push_back({sighting.view, moduleOf(i), *spot, whyTaken(*undetected)});
        }
    }
    return chosen;
}

}  // namespace skincal
