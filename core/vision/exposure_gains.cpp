#include "core/vision/exposure_gains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/geometry/statistics.h"
#include "core/vision/clipped_planes.h"
#include "core/vision/parallel.h"

namespace skincal {
namespace {

constexpr double kStrong = 3;
constexpr double kLeastStep = 0.05;
constexpr double kLeastPart = 0.3;  ///< of a step that levels and surroundings must follow
constexpr float kDark = 8;          // what is darker has no ground to speak of
constexpr std::size_t kFewest = 3;

/// A spot that tells of the exposure.
struct Witness {
    Eigen::Index spot = 0;
    float ground = 0;      ///< brighter than its surroundings without its LED, over their level
    double strongest = 0;  ///< of its LED's light, but for the top tenth, which a flash may have
    double highest = 0;    ///< the same of its grey level
    double around = 0;     ///< level of its surroundings, the median
    std::vector<std::uint8_t> isBlack;
};

/// What the spots that shine in a plane have of what they have at best, and of their level.
struct PlaneShare {
    double gain = 1;
    double level = 1;
    std::optional<double> around{};  ///< of their surroundings, where these are no darker than a dark room
};

/// The value that nine tenths of them stay below.
double highOf(std::vector<float>& values) {
    const auto high = values.begin() + static_cast<std::ptrdiff_t>(9 * (values.size() - 1) / 10);
    std::nth_element(values.begin(), high, values.end());
    return static_cast<double>(*high);
}
float middleOf(std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}
/// That one quarter of them stays below: of what blinks a balanced word, about the middle of what is dark.
double lowOf(std::vector<float>& values) {
    const auto low = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 4);
    std::nth_element(values.begin(), low, values.end());
    return static_cast<double>(*low);
}

/// How much brighter than its surroundings a spot is while its LED is dark, over their level.
float groundOf(const SpotSeries& series, Eigen::Index spot, std::vector<float>& values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
        const auto plane = static_cast<Eigen::Index>(k);
        values[k] = series.light(plane, spot) / std::max(kDark, series.around(plane, spot));
    }
    return static_cast<float>(std::max(0.0, lowOf(values)));
}

std::optional<Witness> witnessOf(const SpotSeries& series, Eigen::Index spot, double sigma) {
    const Eigen::Index planes = series.light.rows();
    std::vector<float> values(static_cast<std::size_t>(planes));
    Witness witness;
    witness.spot = spot;
    witness.ground = groundOf(series, spot, values);
    Eigen::Map<Eigen::VectorXf> each(values.data(), planes);
    each = series.light.col(spot) - witness.ground * series.around.col(spot);
    witness.strongest = highOf(values);
    if (!(witness.strongest > kStrong * sigma))
        return std::nullopt;
    each = series.light.col(spot) + series.around.col(spot);
    witness.highest = highOf(values);
    each = series.around.col(spot);
    witness.around = static_cast<double>(middleOf(values));
    witness.isBlack = blackPlanes(series.around.col(spot));
    return witness;
}

/// @param leds  how many there are
std::vector<Witness> witnessesIn(const SpotSeries& series, std::span<const double> sigma, std::size_t leds) {
    // Exposure is the same for all: some of them, from all over the picture, tell as well.
    constexpr std::size_t kAsked = 2000;
    const std::size_t step = series.clipped.size() / kAsked + 1;
    std::vector<std::optional<Witness>> all((series.clipped.size() + step - 1) / step);
    (void)forEach(all.size(), {}, [&](std::size_t i) {
        all[i] = witnessOf(series, static_cast<Eigen::Index>(i * step), sigma[i * step]);
    });
    std::vector<Witness> witnesses;
    std::vector<double> sorted;
    for (const auto& one : all) {
        if (one) {
            witnesses.push_back(*one);
            sorted.push_back(one->strongest);
        }
    }
    // Skirts and reflections shine with several LEDs at once, and tell nothing.
    constexpr double kOfStrong = 0.4;
    if (sorted.empty())
        return witnesses;
    // Of all that blinks a tenth may be LEDs, or far less where the ground is patterned; half of the LEDs may be seen.
    constexpr std::size_t kStrongest = 10;
    const std::size_t rank = std::min({kStrongest, (sorted.size() - 1) / 10, leds / (2 * step)});
    const auto nearlyMost = sorted.end() - 1 - static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sorted.begin(), nearlyMost, sorted.end());
    std::erase_if(witnesses, [&](const Witness& one) { return one.strongest < kOfStrong * *nearlyMost; });
    return witnesses;
}

std::optional<PlaneShare> shareIn(const SpotSeries& series, Eigen::Index plane, const std::vector<Witness>& witnesses,
                                  std::span<const double> sigma) {
    std::vector<std::pair<double, const Witness*>> shares;
    std::size_t black = 0;
    for (const Witness& one : witnesses) {
        auto light = static_cast<double>(series.light(plane, one.spot) - one.ground * series.around(plane, one.spot));
        // Clipped it may have as much as ever, however little of its range the sun leaves to it.
        if (series.isFull(plane, one.spot) != 0)
            light = std::max(light, one.strongest);
        // What of it black ground swallows looks like a shorter exposure.
        if (one.isBlack[static_cast<std::size_t>(plane)] != 0)
            ++black;
        else if (light > kStrong * sigma[static_cast<std::size_t>(one.spot)])
            shares.emplace_back(light / one.strongest, &one);
    }
    if (shares.size() < kFewest || 2 * black > witnesses.size())
        return std::nullopt;
    const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
    const auto nearlyMost = shares.begin() + static_cast<std::ptrdiff_t>(9 * (shares.size() - 1) / 10);
    std::nth_element(shares.begin(), nearlyMost, shares.end(), less);
    const double top = nearlyMost->first;
    const auto shining =
        std::partition(shares.begin(), shares.end(), [&](const auto& share) { return share.first < 0.5 * top; });
    const auto count = shares.end() - shining;
    // Less than that is what stray light makes of LEDs that nobody sees.
    constexpr double kLeastShare = 0.1;
    if (top < kLeastShare || count < static_cast<std::ptrdiff_t>(kFewest))
        return std::nullopt;
    // A lamp leaves less of its range to a clipped LED; then the spots are brighter, as a shorter exposure makes none.
    std::vector<double> levels;
    std::vector<double> around;
    for (auto share = shining; share != shares.end(); ++share) {
        const Witness& one = *share->second;
        levels.push_back(static_cast<double>(series.light(plane, one.spot) + series.around(plane, one.spot)) /
                         one.highest);
        if (one.around > static_cast<double>(kDark))
            around.push_back(static_cast<double>(series.around(plane, one.spot)) / one.around);
    }
    std::nth_element(shining, shining + count / 2, shares.end(), less);
    PlaneShare result{(shining + count / 2)->first, median(std::move(levels))};
    if (2 * around.size() > static_cast<std::size_t>(count))
        result.around = median(std::move(around));
    return result;
}

/// Whether surroundings change as LEDs do, as far as they can be seen: after a knock they do not.
bool surroundingsFollow(const PlaneShare& share, const PlaneShare& reference) {
    const double step = std::log(share.gain / reference.gain);
    if (!share.around || !reference.around || std::abs(step) < kLeastStep)
        return true;
    return std::log(*share.around / *reference.around) / step >= kLeastPart;
}

}  // namespace

std::vector<double> exposureGains(const SpotSeries& series, std::span<const double> sigma,
                                  std::span<const std::size_t> litCount) {
    std::vector<double> gains(static_cast<std::size_t>(series.light.rows()), 1);
    const std::size_t leds = litCount.empty() ? 0 : *std::max_element(litCount.begin(), litCount.end());
    const std::vector<Witness> witnesses = witnessesIn(series, sigma, leds);
    if (witnesses.size() < kFewest)
        return gains;
    std::vector<std::optional<PlaneShare>> shares(gains.size());
    (void)forEach(gains.size(), {}, [&](std::size_t k) {
        if (litCount[k] >= kFewest)
            shares[k] = shareIn(series, static_cast<Eigen::Index>(k), witnesses, sigma);
    });
    std::vector<double> told;
    std::vector<double> levels;
    for (const auto& share : shares) {
        if (share) {
            told.push_back(share->gain);
            levels.push_back(share->level);
        }
    }
    if (told.empty())
        return gains;
    const double usual = median(std::move(told));
    const double usualLevel = median(std::move(levels));
    // The plane that is most as usual.
    const auto away = [&](const std::optional<PlaneShare>& share) {
        return share ? std::abs(std::log(share->gain / usual)) : std::numeric_limits<double>::infinity();
    };
    const auto reference = *std::min_element(shares.begin(), shares.end(),
                                             [&](const auto& a, const auto& b) { return away(a) < away(b); });
    for (std::size_t k = 0; k < gains.size(); ++k) {
        if (!shares[k])
            continue;
        const double gain = shares[k]->gain / usual;
        const bool isStep = std::abs(gain - 1) >= kLeastStep &&
                            !(std::log(shares[k]->level / usualLevel) / std::log(gain) < kLeastPart) &&
                            surroundingsFollow(*shares[k], *reference);
        gains[k] = isStep ? gain : 1;
    }
    return gains;
}

}  // namespace skincal
