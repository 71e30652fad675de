#include "core/vision/late_pictures.h"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace skincal {
namespace {

constexpr int kLatest = 2;
/// What steps once or flares up is no LED.
constexpr int kFewestChanges = 4;
constexpr std::size_t kFewestWords = 4;
constexpr std::size_t kTimesMore = 2;  ///< words than there are as pictures are

/// A plane in which all LEDs are on, or all off.
struct AllAlike {
    Eigen::Index plane = 0;
    bool isOn = false;
};

std::vector<AllAlike> allAlikeIn(const Codebook& codebook) {
    std::vector<std::size_t> lit(codebook.planes(), 0);
    std::size_t modules = 0;
    for (const auto& planes : codebook.lit) {
        modules += planes.empty() ? 0 : 1;
        for (const std::size_t plane : planes)
            ++lit[plane];
    }
    std::vector<AllAlike> alike;
    for (std::size_t k = 0; k < lit.size(); ++k) {
        if (lit[k] == 0 || lit[k] == modules)
            alike.push_back({static_cast<Eigen::Index>(k), lit[k] != 0});
    }
    return alike;
}

using Brightness = Eigen::Array<bool, Eigen::Dynamic, 1>;

int changesOf(const Brightness& isBright) {
    int changes = 0;
    for (Eigen::Index k = 1; k < isBright.size(); ++k)
        changes += isBright[k] != isBright[k - 1] ? 1 : 0;
    return changes;
}

/// Whether a spot is bright and dark as all LEDs were, so many pictures later.
bool agrees(const Brightness& isBright, const std::vector<AllAlike>& alike, int late) {
    return std::all_of(alike.begin(), alike.end(), [&](const AllAlike& one) {
        const Eigen::Index seen = one.plane + late;
        return seen >= isBright.size() || isBright[seen] == one.isOn;
    });
}

/// As it would be in time. The pictures that were not taken any more are as dark as the first.
template <class Values>
void bringInTime(Values& values, int late) {
    if (values.size() > 0)
        std::rotate(values.data(), values.data() + late, values.data() + values.size());
}

/// Whether these spots blink so many words, so many pictures later. A lamp may shine on many spots as one word does, a
/// camera that is late shows many words. Of very many spots only some are asked, and stand for the rest.
bool blinkWords(const SpotScan& scan, const WordMatcher& matcher, const std::vector<std::size_t>& spots, int late,
                std::size_t most) {
    constexpr std::size_t kAsked = 100;
    const std::size_t step = spots.size() / kAsked + 1;
    std::set<std::size_t> words;
    for (std::size_t i = 0; i < spots.size(); i += step) {
        Eigen::VectorXd series = scan.levelled(spots[i]);
        Ambient ambient = scan.ambientOfSpot(spots[i]);
        std::vector<std::uint8_t> bounds = scan.boundsOfSpot(spots[i]);
        bringInTime(series, late);
        bringInTime(ambient.light, late);
        bringInTime(bounds, late);
        const SeriesMatch match = matcher.match({series.data(), static_cast<std::size_t>(series.size())},
                                                scan.sigma[spots[i]], ambient, bounds);
        if (match.verdict == SeriesVerdict::Matched)
            words.insert(match.words.front());
    }
    return words.size() >= kFewestWords && words.size() * step >= most;
}

}  // namespace

std::optional<int> picturesLate(const SpotScan& scan, std::size_t inTime, const WordMatchOptions& options) {
    const Codebook& codebook = scan.codebook;
    const std::vector<AllAlike> alike = allAlikeIn(codebook);
    const auto on = std::count_if(alike.begin(), alike.end(), [](const AllAlike& one) { return one.isOn; });
    if (codebook.coloured || on == 0 || on == std::ssize(alike) || alike.size() == codebook.planes())
        return std::nullopt;
    std::array<std::vector<std::size_t>, kLatest> suspects;
    for (Eigen::Index spot = 0; spot < scan.series.light.cols(); ++spot) {
        const auto series = scan.series.light.col(spot).array();
        const Brightness isBright = series > 0.5F * (series.minCoeff() + series.maxCoeff());
        if (changesOf(isBright) < kFewestChanges)
            continue;
        for (int late = 1; late <= kLatest; ++late) {
            if (agrees(isBright, alike, late))
                suspects.at(static_cast<std::size_t>(late - 1)).push_back(static_cast<std::size_t>(spot));
        }
    }
    const std::size_t enough = std::max(kFewestWords, kTimesMore * inTime);
    std::optional<WordMatcher> matcher;
    for (int late = 1; late <= kLatest; ++late) {
        const auto& spots = suspects.at(static_cast<std::size_t>(late - 1));
        if (spots.size() < enough)
            continue;
        if (!matcher)
            matcher.emplace(codebook, options);
        if (blinkWords(scan, *matcher, spots, late, enough))
            return late;
    }
    return std::nullopt;
}

}  // namespace skincal
