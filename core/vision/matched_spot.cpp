#include "core/vision/matched_spot.h"

#include <algorithm>

#include "core/vision/parallel.h"
#include "core/vision/surroundings.h"

namespace skincal {
namespace {

/// What a spot shows beyond drift, ambient and the words but one.
Eigen::VectorXd lightOf(const SpotScan& scan, const MatchedSpot& match, std::size_t j) {
    Eigen::VectorXd light = scan.levelled(match.candidate) - scan.codebook.drift * match.series.drift;
    const Ambient ambient = centred(scan.ambientOfSpot(match.candidate), match.series.used);
    if (ambient.light.size() > 0)
        light -= match.series.ambient * ambient.light;
    for (std::size_t other = 0; other < match.series.words.size(); ++other) {
        if (other == j)
            continue;
        for (const std::size_t plane : scan.codebook.lit[match.series.words[other]])
            light[static_cast<Eigen::Index>(plane)] -= match.series.amplitudes[other];
    }
    return light;
}

}  // namespace

std::optional<std::vector<MatchedSpot>> matchCandidates(const SpotScan& scan, std::span<const SpotCandidate> candidates,
                                                        std::span<const ModuleId> modules,
                                                        const WordMatchOptions& options, const RunContext& context,
                                                        Verdicts& verdicts) {
    const WordMatcher matcher(scan.codebook, options);
    std::vector<SeriesMatch> all(candidates.size());
    const bool isDone = forEach(candidates.size(), context, [&](std::size_t i) {
        const Eigen::VectorXd y = scan.levelled(i);
        all[i] = matcher.match({y.data(), static_cast<std::size_t>(y.size())}, scan.sigma[i], scan.ambientOfSpot(i),
                               scan.boundsOfSpot(i));
    });
    if (!isDone)
        return std::nullopt;
    std::vector<MatchedSpot> matches;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        MatchedSpot spot{candidates[i], i, std::move(all[i])};
        const SeriesMatch& match = spot.series;
        switch (match.verdict) {
            case SeriesVerdict::Matched:
                matches.push_back(std::move(spot));
                break;
            case SeriesVerdict::Ambiguous:
                verdicts.countUnexplained();
                for (const std::size_t word : match.words) {
                    verdicts.note(word, DetectionVerdict::Ambiguous,
                                  match.runnerUp ? Undetected::Cause::Alike : Undetected::Cause::TooWeak,
                                  match.runnerUp
                                      ? Sentence::saying("a spot fits its word no better than that of module {}",
                                                         modules[*match.runnerUp].value)
                                      : Sentence::saying("a spot blinks its word too faintly to be sure"),
                                  nearestSpot(scan, spot, word));
                }
                break;
            case SeriesVerdict::Unlike:
                verdicts.countUnexplained();
                verdicts.note(match.words.front(), DetectionVerdict::NotFound, Undetected::Cause::NotAnLed,
                              Sentence::saying("a spot blinks somewhat like its word, but with other light in it"),
                              nearestSpot(scan, spot, match.words.front()));
                break;
            case SeriesVerdict::Dark:
                break;
        }
    }
    return matches;
}

bool sharesSpot(const SeriesMatch& series, std::size_t j) {
    constexpr double kComparable = 0.25;
    for (std::size_t other = 0; other < series.amplitudes.size(); ++other) {
        if (other != j && series.amplitudes[other] > kComparable * series.amplitudes[j])
            return true;
    }
    return false;
}

bool hasMoreLight(const SpotScan& scan, const MatchedSpot& match) {
    constexpr double kShare = 0.2;
    const double amplitude = match.series.amplitudes[0];
    Eigen::VectorXd more = lightOf(scan, match, 0);
    for (const std::size_t plane : scan.codebook.lit[match.series.words[0]])
        more[static_cast<Eigen::Index>(plane)] -= amplitude;
    const std::vector<std::uint8_t> all(match.series.used.size(), 1);
    const std::vector<std::uint8_t> calm =
        calmPlanes(scan.series.around.col(static_cast<Eigen::Index>(match.candidate)), scan.gains, all);
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (match.series.used[k] == 0 && calm[k] != 0 && more[static_cast<Eigen::Index>(k)] > kShare * amplitude)
            return true;
    }
    return false;
}

WordReading readingOf(const SpotScan& scan, const MatchedSpot& match, std::size_t module) {
    const auto j = static_cast<std::size_t>(std::find(match.series.words.begin(), match.series.words.end(), module) -
                                            match.series.words.begin());
    WordReading reading;
    reading.planes = scan.codebook.planes();
    reading.coloured = scan.codebook.coloured;
    reading.sent.assign(scan.codebook.lit[module].begin(), scan.codebook.lit[module].end());
    const Eigen::VectorXd light = lightOf(scan, match, j);
    for (std::size_t k = 0; k < reading.planes; ++k) {
        const bool isBright = light[static_cast<Eigen::Index>(k)] > 0.5 * match.series.amplitudes[j];
        // Of light that is cut off so much could not be told whether it was there.
        if (match.series.used[k] == 0 || (match.series.met[k] != 0 && !isBright))
            reading.disturbed.push_back(static_cast<std::uint32_t>(k));
        else if (isBright)
            reading.received.push_back(static_cast<std::uint32_t>(k));
    }
    reading.snr = match.series.amplitudes[j] / scan.sigma[match.candidate];
    reading.margin = match.series.margin;
    return reading;
}

NearestSpot nearestSpot(const SpotScan& scan, const MatchedSpot& match, std::size_t module) {
    return {Vector2d(match.spot.x, match.spot.y), readingOf(scan, match, module)};
}

}  // namespace skincal
