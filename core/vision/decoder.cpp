#include "core/vision/decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <tuple>

#include "core/vision/frame_pass.h"
#include "core/vision/scan_motion.h"
#include "core/vision/spot_series.h"

namespace skincal {
namespace {

// One spot that blinks the word of one module.
struct Sighting {
    std::size_t module = 0;
    SpotFit fit;
    double when = 0.5;      // in the scan it is seen on average, 0 to 1
    std::size_t match = 0;  // which of the matches tells it
};

// Light that some words explain together, and one map per word.
struct Match {
    SpotCandidate spot;
    std::size_t candidate = 0;
    SeriesMatch series;
    std::vector<AmplitudeMap> maps;
    std::vector<tl::expected<SpotFit, SpotFitError>> fits;
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

// What a view's pictures say, besides the pictures.
struct Scan {
    Codebook codebook;
    ImageNoise noise;
    SpotSeries series{0, 0};
    std::vector<double> gains;
    std::vector<double> sigma;  // per candidate, of its series

    [[nodiscard]] Ambient ambientOfSpot(std::size_t candidate) const {
        return ambientOf(series.around.col(static_cast<Eigen::Index>(candidate)), gains, sigma[candidate]);
    }
};

void forEach(std::size_t count, const std::function<void(std::size_t)>& work) {
    cv::parallel_for_(cv::Range(0, static_cast<int>(count)), [&](const cv::Range& range) {
        for (int i = range.start; i < range.end; ++i)
            work(static_cast<std::size_t>(i));
    });
}

void levelExposure(Scan& scan, const DecoderOptions& options) {
    const auto spots = static_cast<std::size_t>(scan.series.level.size());
    scan.sigma.resize(spots);
    for (std::size_t i = 0; i < spots; ++i)
        scan.sigma[i] =
            spotBrightnessSigma(scan.noise, scan.series.level[static_cast<Eigen::Index>(i)], options.windowRadius);
    std::vector<std::size_t> litCount(scan.codebook.planes(), 0);
    for (const auto& planes : scan.codebook.lit) {
        for (const std::size_t plane : planes)
            ++litCount[plane];
    }
    scan.gains = exposureGains(scan.series, scan.sigma, litCount);
    // Where it was darker the noise counts for more.
    double inverse = 0;
    for (const double gain : scan.gains)
        inverse += 1 / gain / static_cast<double>(scan.gains.size());
    for (double& sigma : scan.sigma)
        sigma *= inverse;
}

Eigen::VectorXd levelled(const Scan& scan, std::size_t candidate) {
    Eigen::VectorXd y = scan.series.light.col(static_cast<Eigen::Index>(candidate)).cast<double>();
    for (Eigen::Index k = 0; k < y.size(); ++k)
        y[k] /= scan.gains[static_cast<std::size_t>(k)];
    return y;
}

std::vector<Match> matchCandidates(const Scan& scan, const std::vector<SpotCandidate>& candidates,
                                   std::span<const ModuleId> modules, const DecoderOptions& options,
                                   const RunContext& context, Verdicts& verdicts) {
    const WordMatcher matcher(scan.codebook, options.words);
    std::vector<SeriesMatch> all(candidates.size());
    forEach(candidates.size(), [&](std::size_t i) {
        if (context.isCancelled())
            return;
        const Eigen::VectorXd y = levelled(scan, i);
        all[i] = matcher.match({y.data(), static_cast<std::size_t>(y.size())}, scan.sigma[i], scan.ambientOfSpot(i));
    });
    std::vector<Match> matches;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        SeriesMatch& match = all[i];
        switch (match.verdict) {
            case SeriesVerdict::Matched:
                matches.push_back({candidates[i], i, std::move(match), {}, {}});
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

// Which matches are how near to which: a grid of cells as large as what can throw light into a window.
class Neighbourhood {
  public:
    Neighbourhood(const std::vector<Match>& matches, int reach_px) : matches_(matches), reach_px_(reach_px) {
        for (std::size_t i = 0; i < matches.size(); ++i)
            cells_[cellOf(matches[i].spot.x, matches[i].spot.y)].push_back(i);
    }

    // Words of the others within reach, nearest first, none twice and none of this match's own.
    [[nodiscard]] std::vector<std::size_t> wordsAround(std::size_t match, std::size_t most) const {
        const SpotCandidate& spot = matches_[match].spot;
        std::vector<std::pair<int, std::size_t>> near;
        for (int dy = -reach_px_; dy <= reach_px_; dy += reach_px_) {
            for (int dx = -reach_px_; dx <= reach_px_; dx += reach_px_) {
                const auto cell = cells_.find(cellOf(spot.x + dx, spot.y + dy));
                if (cell == cells_.end())
                    continue;
                for (const std::size_t i : cell->second) {
                    const int x = matches_[i].spot.x - spot.x;
                    const int y = matches_[i].spot.y - spot.y;
                    if (i != match && x * x + y * y <= reach_px_ * reach_px_)
                        near.emplace_back(x * x + y * y, i);
                }
            }
        }
        std::sort(near.begin(), near.end());
        std::vector<std::size_t> words;
        for (const auto& [distance, i] : near) {
            for (const std::size_t word : matches_[i].series.words) {
                const auto known = [&](const std::vector<std::size_t>& list) {
                    return std::find(list.begin(), list.end(), word) != list.end();
                };
                if (words.size() < most && !known(words) && !known(matches_[match].series.words))
                    words.push_back(word);
            }
        }
        return words;
    }

  private:
    [[nodiscard]] std::pair<int, int> cellOf(int x, int y) const {
        return {(x + 2 * reach_px_) / reach_px_, (y + 2 * reach_px_) / reach_px_};
    }

    const std::vector<Match>& matches_;
    int reach_px_;
    std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

void prepareMaps(const Scan& scan, cv::Size size, const DecoderOptions& options, std::vector<Match>& matches,
                 ScanMotion& motion) {
    constexpr std::size_t kMostNeighbours = 12;
    constexpr std::size_t kWatched = 100;
    constexpr double kClipped = 254;
    // A halo of a few per cent reaches as far as that.
    const Neighbourhood neighbourhood(matches, options.windowRadius + 5);
    std::size_t watched = 0;
    const std::size_t every = 1 + matches.size() / kWatched;
    for (std::size_t i = 0; i < matches.size(); ++i) {
        Match& match = matches[i];
        const auto at = static_cast<Eigen::Index>(match.candidate);
        const std::vector<std::size_t> around = neighbourhood.wordsAround(i, kMostNeighbours);
        for (std::size_t j = 0; j < match.series.words.size(); ++j) {
            LightFilter filter;
            filter.words = {match.series.words[j]};
            filter.used = match.series.used;
            filter.around = scan.series.around.col(at);
            filter.gains = scan.gains;
            filter.sigma = scan.sigma[match.candidate];
            filter.shared = match.series.words.size() > 1;
            filter.clipped = scan.series.peak[at] >= kClipped;
            for (std::size_t other = 0; other < match.series.words.size(); ++other) {
                if (other != j)
                    filter.words.push_back(match.series.words[other]);
            }
            filter.words.insert(filter.words.end(), around.begin(), around.end());
            if (j == 0 && match.series.words.size() == 1 && i % every == 0 && watched++ < kWatched)
                motion.watch(match.spot, size, scan.codebook, filter);
            match.maps.emplace_back(match.spot, options.windowRadius, size, scan.codebook, std::move(filter));
        }
    }
}

bool blindNear(const SpotWindow& window, const Vector2d& centre, double radius_px) {
    for (Eigen::Index row = 0; row < window.state.rows(); ++row) {
        for (Eigen::Index col = 0; col < window.state.cols(); ++col) {
            const Vector2d pixel(static_cast<double>(window.x0 + col), static_cast<double>(window.y0 + row));
            if (window.state(row, col) == PixelState::Excluded && (pixel - centre).norm() <= radius_px)
                return true;
        }
    }
    return false;
}

// What a spot shows beyond drift, ambient and the words but one, and how much of that is there with its word dark.
struct WordLight {
    Eigen::VectorXd light;
    double dark = 0;
};

WordLight lightOf(const Scan& scan, const Match& match, std::size_t j) {
    WordLight result{levelled(scan, match.candidate) - match.series.ambient * scan.ambientOfSpot(match.candidate).light,
                     0};
    for (std::size_t other = 0; other < match.series.words.size(); ++other) {
        if (other == j)
            continue;
        for (const std::size_t plane : scan.codebook.lit[match.series.words[other]])
            result.light[static_cast<Eigen::Index>(plane)] -= match.series.amplitudes[other];
    }
    std::vector<std::uint8_t> isDark = match.series.used;
    for (const std::size_t plane : scan.codebook.lit[match.series.words[j]])
        isDark[plane] = 0;
    double count = 0;
    for (std::size_t k = 0; k < isDark.size(); ++k) {
        if (isDark[k] != 0) {
            result.dark += result.light[static_cast<Eigen::Index>(k)];
            ++count;
        }
    }
    result.dark /= std::max(1.0, count);
    return result;
}

// True where a disturbed plane is brighter than the word makes it: what hides an LED makes it darker.
bool hasMoreLight(const Scan& scan, const Match& match) {
    const WordLight spot = lightOf(scan, match, 0);
    std::vector<double> expected(match.series.used.size(), spot.dark);
    for (const std::size_t plane : scan.codebook.lit[match.series.words[0]])
        expected[plane] += match.series.amplitudes[0];
    constexpr double kShare = 0.2;
    for (std::size_t k = 0; k < expected.size(); ++k) {
        if (match.series.used[k] == 0 &&
            spot.light[static_cast<Eigen::Index>(k)] > expected[k] + kShare * match.series.amplitudes[0])
            return true;
    }
    return false;
}

double whenSeen(const Codebook& codebook, const SeriesMatch& match, std::size_t module) {
    double sum = 0;
    double count = 0;
    for (const std::size_t plane : codebook.lit[module]) {
        if (match.used[plane] != 0) {
            sum += static_cast<double>(plane);
            count += static_cast<double>(codebook.planes());
        }
    }
    return count > 0 ? sum / count : 0.5;
}

std::vector<Sighting> sightingsOf(const Scan& scan, const std::vector<Match>& matches, const DecoderOptions& options,
                                  Verdicts& verdicts) {
    std::vector<Sighting> sightings;
    for (std::size_t i = 0; i < matches.size(); ++i) {
        const Match& match = matches[i];
        for (std::size_t j = 0; j < match.maps.size(); ++j) {
            const std::size_t module = match.series.words[j];
            const auto& fit = match.fits[j];
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
            if (shared ? blindNear(match.maps[j].window(), fit->centre, options.maxShift_px)
                       : fit->clipped && (hasMoreLight(scan, match) ||
                                          match.maps[j].strayShare(fit->centre, 3.5) > options.maxStrayShare)) {
                verdicts.note(module, DetectionVerdict::Ambiguous, "its spot is clipped and has other light in it");
                continue;
            }
            sightings.push_back({module, *fit, whenSeen(scan.codebook, match.series, module), i});
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
std::vector<Sighting> distinctSpots(std::span<const Sighting> finds, const DecoderOptions& options) {
    struct Spot {
        Vector2d place;
        Sighting best;
    };
    std::vector<Spot> spots;
    const double faintest = finds.front().fit.flux() / options.reflectionRatio;
    for (const Sighting& find : finds) {
        const auto same = std::find_if(spots.begin(), spots.end(), [&](const Spot& spot) {
            return (find.fit.centre - spot.place).norm() <= options.sameSpot_px;
        });
        if (same == spots.end() && (spots.empty() || find.fit.flux() > faintest))
            spots.push_back({find.fit.centre, find});
        else if (same != spots.end() && find.fit.sigma_px < same->best.fit.sigma_px)
            same->best = find;
    }
    std::vector<Sighting> best;
    for (const Spot& spot : spots)
        best.push_back(spot.best);
    return best;
}

// Why none of several spots was taken, with the spots for whoever knows more than the picture.
Undetected undecided(const std::vector<Sighting>& spots, const DecoderOptions& options) {
    Undetected result{{}, DetectionVerdict::Ambiguous, {}};
    result.reason = spots.size() == 2 ? fmt::format("two spots {:.0f} px apart blink its word",
                                                    (spots[1].fit.centre - spots[0].fit.centre).norm())
                                      : fmt::format("{} spots blink its word", spots.size());
    // One that is left out might be the LED itself.
    if (spots.size() > static_cast<std::size_t>(options.maxSpots))
        return result;
    for (const auto& [module, fit, when, match] : spots)
        result.spots.push_back({fit.centre, fit.sigma_px, std::min(1.0, fit.flux() / spots.front().fit.flux())});
    return result;
}

// Planes at which a spot's word begins or ends to show, where it does not show throughout.
std::optional<std::size_t> breakOf(const std::vector<std::uint8_t>& used) {
    constexpr std::ptrdiff_t kShortest = 3;
    const auto first = std::find(used.begin(), used.end(), 1);
    const auto last = std::find(used.rbegin(), used.rend(), 1);
    if (first - used.begin() >= kShortest)
        return static_cast<std::size_t>(first - used.begin());
    if (last - used.rbegin() >= kShortest)
        return static_cast<std::size_t>(used.rend() - last);
    return std::nullopt;
}

// A knock of more than a spot's width: many spots show their words only up to one plane, or only from it on, and
// modules may be here before and there afterwards.
std::optional<double> jumped_px(const std::vector<Sighting>& sightings, const std::vector<Match>& matches) {
    constexpr std::size_t kFewest = 3;
    constexpr double kApart = 0.3;
    constexpr double kAtLeast = 1.5;  // a spot's width, where nothing tells by how much it was
    std::map<std::size_t, std::size_t> breaks;
    std::vector<SplitSighting> split;
    for (auto first = sightings.begin(); first != sightings.end();) {
        const auto last =
            std::find_if(first, sightings.end(), [&](const Sighting& other) { return other.module != first->module; });
        const auto [early, late] =
            std::minmax_element(first, last, [](const Sighting& a, const Sighting& b) { return a.when < b.when; });
        if (late->when - early->when > kApart)
            split.push_back({early->fit.centre, late->fit.centre});
        for (; first != last; ++first) {
            if (const auto at = breakOf(matches[first->match].series.used))
                ++breaks[*at];
        }
    }
    std::size_t alike = 0;
    for (const auto& [plane, count] : breaks) {
        const auto next = breaks.find(plane + 1);
        alike = std::max(alike, count + (next != breaks.end() ? next->second : 0));
    }
    if (alike < kFewest || 4 * alike < sightings.size())
        return std::nullopt;
    return std::max(kAtLeast, ScanMotion::moved_px(split).value_or(kAtLeast));
}

WordReading readingOf(const Scan& scan, const Match& match, std::size_t module) {
    const auto j = static_cast<std::size_t>(std::find(match.series.words.begin(), match.series.words.end(), module) -
                                            match.series.words.begin());
    const std::size_t planes = scan.codebook.planes();
    WordReading reading;
    reading.sent.assign(planes, '0');
    for (const std::size_t plane : scan.codebook.lit[module])
        reading.sent[plane] = '1';
    const WordLight spot = lightOf(scan, match, j);
    for (std::size_t k = 0; k < planes; ++k) {
        const bool isBright = spot.light[static_cast<Eigen::Index>(k)] - spot.dark > 0.5 * match.series.amplitudes[j];
        reading.received += match.series.used[k] == 0 ? '.' : isBright ? '1' : '0';
    }
    reading.snr = match.series.amplitudes[j] / scan.sigma[match.candidate];
    reading.margin = match.series.margin;
    return reading;
}

}  // namespace

bool DecoderOptions::validate() const {
    return candidates.validate() && words.validate() && fit.validate() && windowRadius >= 3 && windowRadius <= 30 &&
           maxShift_px > 0 && sameSpot_px > 0 && maxStrayShare > 0 && reflectionRatio >= 1 && maxMotion_px > 0 &&
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
    Scan scan;
    scan.codebook = makeCodebook(*words);
    const Codebook& codebook = scan.codebook;
    const std::size_t perFrame = words->planesPerFrame();

    FramePass pass(frames, load, words->coloured, context);
    SpotFinder finder(options.candidates);
    cv::Size size;
    auto done = pass.run("looking for spots", 0, 0.4, [&](std::size_t, const FramePixels& frame) {
        size = frame.size();
        finder.add(frame, words->coloured);
    });
    if (!done)
        return tl::unexpected(done.error());
    const std::vector<SpotCandidate> candidates =
        finder.candidates(modules.size() * static_cast<std::size_t>(options.candidatesPerModule) +
                          static_cast<std::size_t>(options.extraCandidates));
    scan.noise = finder.noise();

    Verdicts verdicts(modules.size());
    std::vector<Match> matches;
    ScanMotion motion(options.windowRadius, options.fit);
    if (!candidates.empty()) {
        scan.series = SpotSeries(codebook.planes(), candidates.size());
        done = pass.run("reading spots", 0.4, 0.75, [&](std::size_t k, const FramePixels& frame) {
            for (std::size_t plane = k * perFrame; plane < (k + 1) * perFrame; ++plane)
                scan.series.read(frame, candidates, options.windowRadius, plane, words->planes[plane].channel);
        });
        if (!done)
            return tl::unexpected(done.error());
        levelExposure(scan, options);
        matches = matchCandidates(scan, candidates, modules, options, context, verdicts);
        if (context.isCancelled())
            return tl::unexpected(ScanError{"cancelled", true});
        prepareMaps(scan, size, options, matches, motion);
    }
    if (!matches.empty()) {
        done = pass.run("measuring spots", 0.75, 1, [&](std::size_t k, const FramePixels& frame) {
            for (std::size_t plane = k * perFrame; plane < (k + 1) * perFrame; ++plane) {
                const int channel = words->planes[plane].channel;
                forEach(matches.size(), [&](std::size_t i) {
                    for (AmplitudeMap& map : matches[i].maps)
                        map.add(frame, plane, channel, scan.noise);
                });
                motion.add(frame, plane, channel, scan.noise);
            }
        });
        if (!done)
            return tl::unexpected(done.error());
    }
    forEach(matches.size(), [&](std::size_t i) {
        for (const AmplitudeMap& map : matches[i].maps)
            matches[i].fits.push_back(fitSpot(map.window(), options.fit));
    });

    const std::vector<Sighting> sightings = sightingsOf(scan, matches, options, verdicts);
    ViewDetections result;
    result.name = std::move(name);
    result.moved_px = jumped_px(sightings, matches);
    if (!result.moved_px)
        result.moved_px = motion.moved_px();
    const bool spoilt = result.moved_px.value_or(0) > options.maxMotion_px;
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
        } else if (spots.first != spots.second && spoilt) {
            verdicts.replace(u,
                             {{},
                              DetectionVerdict::NotFound,
                              fmt::format("the camera moved by {:.1f} px while its word was shown", *result.moved_px)});
        } else if (spots.first != spots.second) {
            const std::vector<Sighting> distinct = distinctSpots({spots.first, spots.second}, options);
            if (distinct.size() == 1) {
                const SpotFit& fit = distinct[0].fit;
                result.found.push_back(
                    {modules[u], fit.centre, std::hypot(fit.sigma_px, 0.5 * result.moved_px.value_or(0))});
                result.readings.push_back(readingOf(scan, matches[distinct[0].match], u));
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
