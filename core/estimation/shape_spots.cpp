#include "core/estimation/shape_spots.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <span>

#include "core/geometry/parallel.h"
#include "core/vision/looks.h"

namespace skincal {
namespace {

constexpr std::size_t kFewest = 6;  // three make a pose, and of many spots a fourth lies near it by chance

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

/// Those that all poses agree on; none where they are less than half, or some pose explains the picture from other
/// pixels altogether.
std::vector<std::size_t> agreedOn(std::span<const LedCorrespondence> leds, const std::vector<PatchPose>& poses,
                                  double apart_px) {
    for (const PatchPose& other : poses) {
        std::size_t common = 0;
        for (std::size_t i = 0; i < leds.size(); ++i)
            common += poses.front().inliers[i] && other.inliers[i] ? 1 : 0;
        if (2 * common < other.inlierCount())
            return {};
    }
    std::vector<std::size_t> agreed;
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
        if (taken && !isDisputed && !isNearAnother)
            agreed.push_back(*taken);
        first = last;
    }
    return 2 * agreed.size() < poses.front().inlierCount() ? std::vector<std::size_t>{} : agreed;
}

/// Whether a motion would bring the LEDs that a pose explains to where a mirror shows them, facing the camera: those of
/// a single row, as of a ring round an arm, lie in a plane that their axes lie in, too.
bool isMirrorSymmetric(std::span<const LedCorrespondence> leds, const PatchPose& pose, double shapeSigma) {
    constexpr double kFlatSigmas = 6;
    constexpr double kAcross = 0.7;
    Vector3d centre = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    const auto count = static_cast<double>(pose.inlierCount());
    for (std::size_t i = 0; i < leds.size(); ++i) {
        if (!pose.inliers[i])
            continue;
        centre += leds[i].led_o / count;
        normal += leds[i].normal_o;
    }
    Matrix3d spread = Matrix3d::Zero();
    for (std::size_t i = 0; i < leds.size(); ++i) {
        if (pose.inliers[i])
            spread += (leds[i].led_o - centre) * (leds[i].led_o - centre).transpose() / count;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(spread);
    const double thickness = std::sqrt(std::max(0.0, axes.eigenvalues()[0]));
    return thickness < kFlatSigmas * shapeSigma &&
           std::abs(axes.eigenvectors().col(0).dot(normal.normalized())) < kAcross;
}

Sentence whyTaken(const Undetected& undetected) {
    return undetected.spots.size() == 1
               ? Sentence::saying("{}: it lies where the shape of its patch has it", undetected.reason)
               : Sentence::saying("{}: this one lies where the shape of its patch has it", undetected.reason);
}

}  // namespace

std::vector<ChosenSpot> chooseSpotsByShape(const Measurements& measurements, const SkinLayout& layout,
                                           const std::vector<PatchShape>& shapes,
                                           const std::vector<PixelObservation>& pixels, const PatchPoseOptions& options,
                                           const RunContext& context) {
    const auto& views = measurements.views;
    if (std::none_of(views.begin(), views.end(), hasChoices))
        return {};
    const auto sure = collectSightings(measurements.skin, layout, shapes, pixels);
    // Not a vector of bool: each is written beside the others.
    std::vector<std::uint8_t> isPosed(sure.size(), 0);
    forEachInParallel(
        sure.size(), 1,
        [&](std::size_t s) {
            const bool isAsked = hasChoices(views[sure[s].view]);
            isPosed[s] = !isAsked || estimatePatchPoses(sure[s].leds, measurements.camera, options) ? 1 : 0;
        },
        [&](std::size_t) { return !context.isCancelled(); });
    std::set<std::pair<std::size_t, std::size_t>> posed;
    for (std::size_t s = 0; s < sure.size(); ++s) {
        if (isPosed[s] != 0)
            posed.insert({sure[s].view, sure[s].patch});
    }
    const Spots spots = spotsOf(measurements, layout, pixels, posed);
    PatchPoseOptions careful = options;
    careful.minInliers = std::max(static_cast<int>(kFewest), options.minInliers);
    careful.maxCandidates = std::max(4, options.maxCandidates);
    auto doubtful = collectSightings(measurements.skin, layout, shapes, spots.pixels);
    std::vector<std::vector<std::size_t>> agreed(doubtful.size());
    const auto moduleOf = [&](const PatchSighting& sighting, std::size_t i) {
        return spots.pixels[sighting.observations[i]].module;
    };
    forEachInParallel(
        doubtful.size(), 1,
        [&](std::size_t s) {
            std::vector<LedCorrespondence>& leds = doubtful[s].leds;
            for (std::size_t i = 1; i < leds.size(); ++i)
                leds[i].isAlternative = moduleOf(doubtful[s], i) == moduleOf(doubtful[s], i - 1);
            const auto poses = estimatePatchPoses(leds, measurements.camera, careful);
            if (poses && !isMirrorSymmetric(leds, poses->front(), options.shapeSigma))
                agreed[s] = agreedOn(leds, *poses, options.maxResidual_px);
        },
        [&](std::size_t s) {
            context.report(Sentence::saying("which of several spots"),
                           static_cast<double>(s) / static_cast<double>(doubtful.size()));
            return !context.isCancelled();
        });
    std::vector<ChosenSpot> chosen;
    for (std::size_t s = 0; s < doubtful.size(); ++s) {
        for (const std::size_t i : agreed[s]) {
            const Undetected* undetected = spots.undetected[doubtful[s].observations[i]];
            if (undetected == nullptr)
                continue;
            const auto spot =
                std::find_if(undetected->spots.begin(), undetected->spots.end(),
                             [&](const SpotChoice& choice) { return choice.pixel == doubtful[s].leds[i].pixel; });
            chosen.push_back({doubtful[s].view, moduleOf(doubtful[s], i), *spot, whyTaken(*undetected)});
        }
    }
    return chosen;
}

}  // namespace skincal
