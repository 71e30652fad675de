#include "core/vision/scan_motion.h"

#include <cmath>

#include "core/geometry/statistics.h"
#include "core/vision/parallel.h"
#include "core/vision/surroundings.h"

namespace skincal {
namespace {

constexpr std::size_t kFewest = 3;

Vector2d medianOf(const std::vector<Vector2d>& shifts) {
    Vector2d middle;
    for (int axis = 0; axis < 2; ++axis) {
        std::vector<double> values;
        for (const Vector2d& shift : shifts)
            values.push_back(shift[axis]);
        middle[axis] = median(std::move(values));
    }
    return middle;
}

double spreadOf(const std::vector<Vector2d>& shifts, const Vector2d& middle) {
    std::vector<double> away;
    for (const Vector2d& shift : shifts)
        away.push_back((shift - middle).norm());
    return median(std::move(away));
}

}  // namespace

void ScanMotion::watch(const SpotCandidate& spot, cv::Size picture, const Codebook& codebook,
                       const LightFilter& filter) {
    LightFilter early = filter;
    LightFilter late = filter;
    early.words.resize(1);
    late.words.resize(1);
    for (std::size_t k = 0; k < filter.used.size(); ++k)
        (2 * k < filter.used.size() ? late : early).used[k] = 0;
    const auto canTell = [&](const LightFilter& half) {
        return amplitudeWeights(codebook, half.words, half.used,
                                ambientOf(codebook, half.around, half.gains, half.sigma))
                   .size() > 0;
    };
    if (canTell(early) && canTell(late))
        spots_.push_back({AmplitudeMap(spot, radius_, picture, codebook, std::move(early)),
                          AmplitudeMap(spot, radius_, picture, codebook, std::move(late))});
}

void ScanMotion::add(std::span<const FramePlane> planes, const ImageNoise& noise) {
    (void)forEach(spots_.size(), {}, [&](std::size_t i) {
        spots_[i].early.add(planes, noise);
        spots_[i].late.add(planes, noise);
    });
}

std::optional<double> ScanMotion::moved_px() const {
    using Fit = tl::expected<SpotFit, SpotFitError>;
    std::vector<std::pair<Fit, Fit>> fits(spots_.size());
    (void)forEach(fits.size(), {}, [&](std::size_t i) {
        fits[i] = {fitSpot(spots_[i].early.window(), options_), fitSpot(spots_[i].late.window(), options_)};
    });
    std::vector<Vector2d> shifts;
    double variance = 0;
    for (const auto& [early, late] : fits) {
        if (!early || !late)
            continue;
        shifts.push_back(late->centre - early->centre);
        variance += early->sigma_px * early->sigma_px + late->sigma_px * late->sigma_px;
    }
    if (shifts.size() < kFewest)
        return std::nullopt;
    const Vector2d middle = medianOf(shifts);
    // Of a median, pi / 2 times the variance of a mean; per axis.
    const auto count = static_cast<double>(shifts.size());
    const double sigma =
        std::max(std::sqrt(1.57 * variance / count / count), spreadOf(shifts, middle) / std::sqrt(count));
    constexpr double kSigmas = 6;
    return middle.norm() > kSigmas * sigma ? middle.norm() : 0;
}

std::optional<double> ScanMotion::moved_px(std::span<const SplitSighting> sightings) {
    std::vector<Vector2d> shifts;
    for (const SplitSighting& sighting : sightings)
        shifts.push_back(sighting.late - sighting.early);
    if (shifts.size() < kFewest)
        return std::nullopt;
    const Vector2d middle = medianOf(shifts);
    // All of them moved alike, but for a turn about the optical axis and what is nearer.
    constexpr double kAlike = 0.3;
    if (spreadOf(shifts, middle) > std::max(1.0, kAlike * middle.norm()))
        return std::nullopt;
    return middle.norm();
}

}  // namespace skincal
