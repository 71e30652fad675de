#include "core/vision/decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <tuple>

#include "core/vision/frame_pass.h"
#include "core/vision/spot_series.h"

namespace skincal {
namespace {

// One spot that blinks the word of one module.
struct Sighting {
    std::size_t module = 0;
    SpotFit fit;
};

// Light that some words explain together, and one map per word.
struct Match {
    SpotCandidate spot;
    SeriesMatch series;
    std::vector<AmplitudeMap> maps;
};

class Verdicts {
  public:
    explicit Verdicts(std::size_t modules) : reasons_(modules) {}

    // The first reason stays, but what nearly was a find says more than what never was.
    void note(std::size_t module, DetectionVerdict verdict, std::string reason) {
        auto& known = reasons_[module];
        const bool better = verdict == DetectionVerdict::Ambiguous && known.verdict == DetectionVerdict::NotFound;
        if (known.reason.empty() || better)
            known = {{}, verdict, std::move(reason)};
    }
    // Nothing says more than several finds.
    void replace(std::size_t module, Undetected with) { reasons_[module] = std::move(with); }
    [[nodiscard]] Undetected take(std::size_t module, ModuleId id) {
        Undetected result = std::move(reasons_[module]);
        result.module = id;
        if (result.reason.empty())
            result.reason = "no spot blinks its word";
        return result;
    }

  private:
    std::vector<Undetected> reasons_;
};

std::vector<Match> matchCandidates(const Codebook& codebook, const std::vector<SpotCandidate>& candidates,
                                   const Eigen::MatrixXf& series, const Eigen::VectorXd& levels,
                                   const ImageNoise& noise, std::span<const ModuleId> modules,
                                   const DecoderOptions& options, const RunContext& context, Verdicts& verdicts) {
    std::vector<Match> matches;
    for (std::size_t i = 0; i < candidates.size() && !context.isCancelled(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const Eigen::VectorXd y = series.col(at).cast<double>();
        const double sigma = spotBrightnessSigma(noise, levels[at], options.windowRadius);
        SeriesMatch match = matchSeries(codebook, {y.data(), static_cast<std::size_t>(y.size())}, sigma, options.words);
        switch (match.verdict) {
            case SeriesVerdict::Matched:
                matches.push_back({candidates[i], std::move(match), {}});
                break;
            case SeriesVerdict::Ambiguous:
                for (const std::size_t word : match.words) {
                    verdicts.note(word, DetectionVerdict::Ambiguous,
                                  match.runnerUp ? fmt::format("a spot fits its word no better than that of module {}",
                                                               modules[*match.runnerUp].value)
                                                 : std::string("a spot blinks its word too faintly to be sure"));
                }
                break;
            case SeriesVerdict::Unlike:
                verdicts.note(match.words.front(), DetectionVerdict::NotFound,
                              "a spot blinks somewhat like its word, but with other light in it");
                break;
            case SeriesVerdict::Dark:
                break;
        }
    }
    return matches;
}

std::vector<Sighting> fitMatches(const std::vector<Match>& matches, const DecoderOptions& options, Verdicts& verdicts) {
    std::vector<Sighting> sightings;
    for (const Match& match : matches) {
        for (std::size_t j = 0; j < match.maps.size(); ++j) {
            const std::size_t module = match.series.words[j];
            const auto fit = fitSpot(match.maps[j].window(), options.fit);
            if (!fit) {
                verdicts.note(module, DetectionVerdict::NotFound, std::string(name(fit.error())));
                continue;
            }
            // The skirt of a neighbour blinks the neighbour's word; its centre lies elsewhere. Where two LEDs share one
            // maximum, each may sit a little off it.
            const bool shared = match.maps.size() > 1;
            const double allowed = shared ? options.windowRadius - 1.0 : options.maxShift_px;
            if ((fit->centre - Vector2d(match.spot.x, match.spot.y)).norm() > allowed) {
                verdicts.note(module, DetectionVerdict::NotFound, "only stray light blinks its word");
                continue;
            }
            // Clipping hides a second LED from the series, which then looks like a disturbance, and makes light no
            // longer add up.
            const bool disturbed =
                std::find(match.series.used.begin(), match.series.used.end(), 0) != match.series.used.end();
            if (shared ? match.maps[j].blindNear(fit->centre, options.maxShift_px)
                       : fit->clipped &&
                             (disturbed || match.maps[j].strayShare(fit->centre, 3.5) > options.maxStrayShare)) {
                verdicts.note(module, DetectionVerdict::Ambiguous, "its spot is clipped and has other light in it");
                continue;
            }
            sightings.push_back({module, *fit});
        }
    }
    // Brightest first; ties by place, so that the result does not depend on anything else.
    std::sort(sightings.begin(), sightings.end(), [](const Sighting& a, const Sighting& b) {
        return std::make_tuple(a.module, -a.fit.flux(), a.fit.centre.x(), a.fit.centre.y()) <
               std::make_tuple(b.module, -b.fit.flux(), b.fit.centre.x(), b.fit.centre.y());
    });
    return sightings;
}

// The spots that may be a module's LED, brightest first; of several finds of one spot the sharpest counts.
std::vector<SpotFit> distinctSpots(std::span<const Sighting> finds, const DecoderOptions& options) {
    struct Spot {
        Vector2d place;
        SpotFit best;
    };
    std::vector<Spot> spots;
    const double faintest = finds.front().fit.flux() / options.reflectionRatio;
    for (const Sighting& find : finds) {
        const auto same = std::find_if(spots.begin(), spots.end(), [&](const Spot& spot) {
            return (find.fit.centre - spot.place).norm() <= options.sameSpot_px;
        });
        if (same == spots.end() && (spots.empty() || find.fit.flux() > faintest))
            spots.push_back({find.fit.centre, find.fit});
        else if (same != spots.end() && find.fit.sigma_px < same->best.sigma_px)
            same->best = find.fit;
    }
    std::vector<SpotFit> best;
    for (const Spot& spot : spots)
        best.push_back(spot.best);
    return best;
}

// Why none of several spots was taken, with the spots for whoever knows more than the picture.
Undetected undecided(const std::vector<SpotFit>& spots, const DecoderOptions& options) {
    Undetected result{{}, DetectionVerdict::Ambiguous, {}};
    result.reason = spots.size() == 2 ? fmt::format("two spots {:.0f} px apart blink its word",
                                                    (spots[1].centre - spots[0].centre).norm())
                                      : fmt::format("{} spots blink its word", spots.size());
    // One that is left out might be the LED itself.
    if (spots.size() > static_cast<std::size_t>(options.maxSpots))
        return result;
    for (const SpotFit& spot : spots)
        result.spots.push_back({spot.centre, spot.sigma_px, std::min(1.0, spot.flux() / spots.front().flux())});
    return result;
}

}  // namespace

bool DecoderOptions::validate() const {
    return candidates.validate() && words.validate() && fit.validate() && windowRadius >= 3 && windowRadius <= 30 &&
           maxShift_px > 0 && sameSpot_px > 0 && maxStrayShare > 0 && reflectionRatio >= 1 &&
           candidatesPerModule >= 1 && extraCandidates >= 0 && maxSpots >= 2;
}

cv::Mat toGrey(const cv::Mat& frame) {
    if (frame.channels() == 1)
        return frame;
    cv::Mat grey;
    cv::cvtColor(frame, grey, frame.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
    return grey;
}

tl::expected<ViewDetections, ScanError> decodeView(std::string name, std::span<const ModuleId> modules,
                                                   std::span<const FrameInfo> frames, const FrameLoader& load,
                                                   const DecoderOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("DecoderOptions out of range");
    const auto words = litWords(modules, frames);
    if (!words)
        return tl::unexpected(ScanError{words.error(), false});
    const Codebook codebook = makeCodebook(*words);
    const std::size_t perFrame = words->planesPerFrame();

    FramePass pass(frames, load, words->coloured, context);
    SpotFinder finder(options.candidates);
    auto done = pass.run("looking for spots", 0, 0.4,
                         [&](std::size_t, const FramePixels& frame) { finder.add(frame, words->coloured); });
    if (!done)
        return tl::unexpected(done.error());
    const std::vector<SpotCandidate> candidates =
        finder.candidates(modules.size() * static_cast<std::size_t>(options.candidatesPerModule) +
                          static_cast<std::size_t>(options.extraCandidates));
    const ImageNoise noise = finder.noise();

    Verdicts verdicts(modules.size());
    std::vector<Match> matches;
    if (!candidates.empty()) {
        Eigen::MatrixXf series(static_cast<Eigen::Index>(codebook.planes()),
                               static_cast<Eigen::Index>(candidates.size()));
        Eigen::VectorXd levels = Eigen::VectorXd::Zero(series.cols());
        cv::Size size;
        done = pass.run("reading spots", 0.4, 0.75, [&](std::size_t k, const FramePixels& frame) {
            size = frame.size();
            for (std::size_t plane = k * perFrame; plane < (k + 1) * perFrame; ++plane) {
                for (std::size_t i = 0; i < candidates.size(); ++i) {
                    const SpotBrightness brightness =
                        spotBrightness(frame, candidates[i], options.windowRadius, words->planes[plane].channel);
                    const auto at = static_cast<Eigen::Index>(i);
                    series(static_cast<Eigen::Index>(plane), at) = static_cast<float>(brightness.value);
                    levels[at] = std::max(levels[at], brightness.level);
                }
            }
        });
        if (!done)
            return tl::unexpected(done.error());
        matches = matchCandidates(codebook, candidates, series, levels, noise, modules, options, context, verdicts);
        if (context.isCancelled())
            return tl::unexpected(ScanError{"cancelled", true});
        for (Match& match : matches) {
            for (std::size_t j = 0; j < match.series.words.size(); ++j)
                match.maps.emplace_back(match.spot, options.windowRadius, size, codebook, match.series.words, j,
                                        match.series.used);
        }
    }
    if (!matches.empty()) {
        done = pass.run("measuring spots", 0.75, 1, [&](std::size_t k, const FramePixels& frame) {
            for (std::size_t plane = k * perFrame; plane < (k + 1) * perFrame; ++plane) {
                for (Match& match : matches) {
                    for (AmplitudeMap& map : match.maps)
                        map.add(frame, plane, words->planes[plane].channel, noise);
                }
            }
        });
        if (!done)
            return tl::unexpected(done.error());
    }

    const std::vector<Sighting> sightings = fitMatches(matches, options, verdicts);
    ViewDetections result;
    result.name = std::move(name);
    std::vector<std::size_t> sharing(modules.size(), 0);
    for (const std::size_t first : codebook.representative)
        ++sharing[first];
    for (std::size_t u = 0; u < modules.size(); ++u) {
        const auto spots = std::equal_range(sightings.begin(), sightings.end(), Sighting{u, {}},
                                            [](const Sighting& a, const Sighting& b) { return a.module < b.module; });
        if (!codebook.blinks(u)) {
            verdicts.note(
                u, DetectionVerdict::NotFound,
                codebook.lit[u].empty() ? "its LED was never lit" : "its LED was never dark, or only like a drift");
        } else if (sharing[codebook.representative[u]] > 1) {
            verdicts.note(
                u, DetectionVerdict::Ambiguous,
                fmt::format("lit in the same frames as {} other modules", sharing[codebook.representative[u]] - 1));
        } else if (spots.first != spots.second) {
            const std::vector<SpotFit> distinct = distinctSpots({spots.first, spots.second}, options);
            if (distinct.size() == 1) {
                result.found.push_back({modules[u], distinct[0].centre, distinct[0].sigma_px});
                continue;
            }
            verdicts.replace(u, undecided(distinct, options));
        }
        result.undetected.push_back(verdicts.take(u, modules[u]));
    }
    context.report("measuring spots", 1);
    return result;
}

}  // namespace skincal
