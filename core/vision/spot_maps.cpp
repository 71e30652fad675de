#include "core/vision/spot_maps.h"

#include <algorithm>
#include <cmath>

#include "core/vision/clipped_planes.h"
#include "core/vision/neighbourhood.h"
#include "core/vision/parallel.h"

namespace skincal {
namespace {

/// The used planes without those whose ground is black, which swallows some of the light, where the words can still be
/// told apart.
std::vector<std::uint8_t> wholePlanes(const SpotScan& scan, const MatchedSpot& match) {
    const std::vector<std::uint8_t>& used = match.series.used;
    if (scan.codebook.coloured)
        return used;
    const std::vector<std::uint8_t> black =
        blackPlanes(scan.series.around.col(static_cast<Eigen::Index>(match.candidate)));
    std::vector<std::uint8_t> whole = used;
    for (std::size_t k = 0; k < whole.size(); ++k) {
        if (black[k] != 0)
            whole[k] = 0;
    }
    if (whole == used)
        return used;
    const Ambient ambient = scan.ambientOfSpot(match.candidate);
    const bool isEnough = std::all_of(match.series.words.begin(), match.series.words.end(), [&](std::size_t word) {
        return amplitudeWeights(scan.codebook, std::vector{word}, whole, ambient).size() > 0;
    });
    return isEnough ? whole : used;
}

/// How far a spot's halo counts beside the noise where another's centre is told from, between a little and well beyond
/// the window: each more word that light is told apart from costs some of it, and what is left out is taken for light.
double reachOf(const SpotScan& scan, const MatchedSpot& match, const DecoderOptions& options) {
    constexpr double kOfNoise = 0.05;
    // In widths of a spot.
    constexpr double kMiddle = 2;
    constexpr double kLeast = 1.7;
    constexpr double kMost = 4.2;
    const SpotPrior& usual = options.fit.prior;
    const double width = std::exp(usual.logWidth);
    const auto ground = static_cast<double>(scan.series.around.col(static_cast<Eigen::Index>(match.candidate)).mean());
    const double enough = kOfNoise * std::sqrt(scan.noise.variance(ground));
    const double halo = usual.halo * match.series.amplitudes.front();
    const double reach =
        width * (kMiddle + options.fit.haloWidth * std::sqrt(2 * std::log(std::max(1.0, halo / enough))));
    return std::clamp(reach, options.windowRadius + kLeast * width, options.windowRadius + kMost * width);
}

}  // namespace

void prepareMaps(const SpotScan& scan, cv::Size size, const DecoderOptions& options, std::vector<MatchedSpot>& matches,
                 ScanMotion& motion) {
    constexpr std::size_t kMostNeighbours = 12;
    constexpr std::size_t kWatched = 100;
    std::vector<double> reach_px(matches.size());
    std::transform(matches.begin(), matches.end(), reach_px.begin(),
                   [&](const MatchedSpot& match) { return reachOf(scan, match, options); });
    const Neighbourhood neighbourhood(matches, std::move(reach_px));
    const auto filterOf = [&](const MatchedSpot& match, std::size_t j, const std::vector<std::size_t>& around,
                              const std::vector<std::uint8_t>& used) {
        LightFilter filter;
        filter.words = {match.series.words[j]};
        filter.around = scan.series.around.col(static_cast<Eigen::Index>(match.candidate));
        filter.used = used;
        filter.gains = scan.gains;
        filter.sigma = scan.sigma[match.candidate];
        filter.shared = sharesSpot(match.series, j);
        filter.doubtful = filter.shared || scan.series.clipped[match.candidate] != 0;
        for (std::size_t other = 0; other < match.series.words.size(); ++other) {
            if (other != j)
                filter.words.push_back(match.series.words[other]);
        }
        filter.words.insert(filter.words.end(), around.begin(), around.end());
        return filter;
    };
    (void)forEach(matches.size(), {}, [&](std::size_t i) {
        MatchedSpot& match = matches[i];
        const std::vector<std::size_t> around = neighbourhood.wordsAround(i, kMostNeighbours);
        const std::vector<std::uint8_t> used = wholePlanes(scan, match);
        for (std::size_t j = 0; j < match.series.words.size(); ++j)
            match.maps.emplace_back(match.spot, options.windowRadius, size, scan.codebook,
                                    filterOf(match, j, around, used));
    });
    std::size_t watched = 0;
    const std::size_t every = 1 + matches.size() / kWatched;
    for (std::size_t i = 0; i < matches.size() && watched < kWatched; i += every) {
        if (matches[i].series.words.size() == 1) {
            motion.watch(matches[i].spot, size, scan.codebook,
                         filterOf(matches[i], 0, {}, wholePlanes(scan, matches[i])));
            ++watched;
        }
    }
}

}  // namespace skincal
