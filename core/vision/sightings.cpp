#include "core/vision/sightings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/geometry/statistics.h"
#include "core/vision/scan_motion.h"

namespace skincal {
namespace {

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

Undetected::Cause causeOf(SpotFitError error) {
    switch (error) {
        case SpotFitError::NoLight:
            return Undetected::Cause::TooWeak;
        case SpotFitError::TooFewPixels:
            return Undetected::Cause::TooBright;
        default:
            return Undetected::Cause::NotAnLed;
    }
}

// One lens draws all LEDs alike, but for those that are nearer than it is focused on.
void dropStrangeWidths(const SpotScan& scan, const std::vector<MatchedSpot>& matches, std::vector<Sighting>& sightings,
                       Verdicts& verdicts) {
    constexpr std::size_t kFewest = 5;
    constexpr double kAlike = 1.6;
    constexpr double kSigmas = 3;
    if (sightings.size() < kFewest)
        return;
    std::vector<double> widths;
    for (const Sighting& sighting : sightings)
        widths.push_back(std::log(sighting.fit.width_px));
    const double usual = median(std::move(widths));
    std::erase_if(sightings, [&](const Sighting& sighting) {
        const double away = std::abs(std::log(sighting.fit.width_px) - usual);
        const bool isStrange = away > std::log(kAlike) + kSigmas * sighting.fit.logWidthSigma;
        if (isStrange)
            verdicts.replace(sighting.module, {{},
                                               DetectionVerdict::NotFound,
                                               sentenceOf(SpotFitError::WrongShape),
                                               {},
                                               Undetected::Cause::NotAnLed,
                                               nearestSpot(scan, matches[sighting.match], sighting.module)});
        return isStrange;
    });
}

// How much light may follow another word than one of a spot's. LEDs shine a little unevenly, each after its brightness:
// beside a bright one, more of a faint one's. What follows its word only half is a third LED's, which the two add up to
// nearly.
double mostStrayShare(const SeriesMatch& series, std::size_t j, const DecoderOptions& options) {
    constexpr double kHalf = 0.25;  // of the brightness, in energy
    double squares = 0;
    for (const double amplitude : series.amplitudes)
        squares += std::pow(amplitude / series.amplitudes[j], 2);
    return std::min(options.maxStrayShare * squares, std::max(options.maxStrayShare, kHalf));
}

/// Spots that were refused although they may be the LED.
using Refused = std::multimap<std::size_t, SpotFit>;

// Where the words of two LEDs add up to those of two others, and one of them is known, the others are both taken for
// the other one; but no two are in one place.
void dropSamePlaces(const SpotScan& scan, const std::vector<MatchedSpot>& matches, std::vector<Sighting>& sightings,
                    Refused& refused, Verdicts& verdicts) {
    constexpr double kSamePlace_px = 0.7;
    constexpr double kMost_px = 1.5;
    constexpr double kSigmas = 4;
    std::sort(sightings.begin(), sightings.end(), [](const Sighting& a, const Sighting& b) {
        return std::make_tuple(a.fit.centre.x(), a.fit.centre.y(), a.module) <
               std::make_tuple(b.fit.centre.x(), b.fit.centre.y(), b.module);
    });
    const auto isOfTwo = [&](std::size_t i) { return matches[sightings[i].match].series.words.size() > 1; };
    std::vector<std::uint8_t> isTaken(sightings.size(), 0);
    for (std::size_t i = 0; i < sightings.size(); ++i) {
        const SpotFit& here = sightings[i].fit;
        for (std::size_t j = i + 1; j < sightings.size(); ++j) {
            const SpotFit& there = sightings[j].fit;
            if (there.centre.x() - here.centre.x() > kMost_px)
                break;
            const double same_px =
                std::clamp(kSigmas * std::hypot(here.sigma_px, there.sigma_px), kSamePlace_px, kMost_px);
            if (sightings[j].module == sightings[i].module || (there.centre - here.centre).norm() > same_px)
                continue;
            // A word that explains its spot alone adds up to nothing.
            isTaken[i] |= isOfTwo(i) ? 1 : 0;
            isTaken[j] |= isOfTwo(j) ? 1 : 0;
        }
    }
    std::size_t at = 0;
    std::erase_if(sightings, [&](const Sighting& sighting) {
        const bool isSame = isTaken[at++] != 0;
        if (isSame) {
            refused.emplace(sighting.module, sighting.fit);
            verdicts.note(sighting.module, DetectionVerdict::Ambiguous, Undetected::Cause::Alike,
                          Sentence::saying("its spot is that of another module, too"),
                          nearestSpot(scan, matches[sighting.match], sighting.module));
        }
        return isSame;
    });
}

// Where the brightest spot of a module was refused, a fainter one elsewhere may be its reflection.
void dropFainterElsewhere(const Refused& refused, double sameSpot_px, std::vector<Sighting>& sightings) {
    std::erase_if(sightings, [&](const Sighting& sighting) {
        const auto [first, last] = refused.equal_range(sighting.module);
        return std::any_of(first, last, [&](const auto& one) {
            const SpotFit& fit = one.second;
            return fit.flux() >= sighting.fit.flux() && (fit.centre - sighting.fit.centre).norm() > sameSpot_px;
        });
    });
}

}  // namespace

std::vector<Sighting> sightingsOf(const SpotScan& scan, const std::vector<MatchedSpot>& matches,
                                  const DecoderOptions& options, Verdicts& verdicts) {
    std::vector<Sighting> sightings;
    Refused refused;
    for (std::size_t i = 0; i < matches.size(); ++i) {
        const MatchedSpot& match = matches[i];
        for (std::size_t j = 0; j < match.fits.size(); ++j) {
            const std::size_t module = match.series.words[j];
            const auto& fit = match.fits[j];
            if (!fit) {
                verdicts.note(module, DetectionVerdict::NotFound, causeOf(fit.error()), sentenceOf(fit.error()),
                              nearestSpot(scan, match, module));
                continue;
            }
            // The skirt of a neighbour blinks the neighbour's word; its centre lies elsewhere. Where two LEDs share one
            // maximum, each may sit a little off it, and where the middle is blind the maximum is on the rim.
            const bool isOff = sharesSpot(match.series, j) || fit->blind;
            const double allowed = isOff ? options.windowRadius - 1.0 : options.maxShift_px;
            if ((fit->centre - Vector2d(match.spot.x, match.spot.y)).norm() > allowed) {
                verdicts.note(module, DetectionVerdict::NotFound, Undetected::Cause::NotAnLed,
                              sentenceOf(SpotFitError::OutsideWindow), nearestSpot(scan, match, module));
                continue;
            }
            if (match.strays[j] > mostStrayShare(match.series, j, options)) {
                refused.emplace(module, *fit);
                verdicts.note(module, DetectionVerdict::Ambiguous,
                              fit->clipped ? Undetected::Cause::TooBright : Undetected::Cause::Alike,
                              fit->clipped ? Sentence::saying("its spot is clipped and has other light in it")
                                           : Sentence::saying("its spot has other light in it"),
                              nearestSpot(scan, match, module));
                continue;
            }
            sightings.push_back({module, *fit, whenSeen(scan.codebook, match.series, module), i});
        }
    }
    dropStrangeWidths(scan, matches, sightings, verdicts);
    dropSamePlaces(scan, matches, sightings, refused, verdicts);
    dropFainterElsewhere(refused, options.sameSpot_px, sightings);
    // Brightest first; ties by place, so that the result does not depend on anything else.
    std::sort(sightings.begin(), sightings.end(), [](const Sighting& a, const Sighting& b) {
        return std::make_tuple(a.module, -a.fit.flux(), a.fit.centre.x(), a.fit.centre.y()) <
               std::make_tuple(b.module, -b.fit.flux(), b.fit.centre.x(), b.fit.centre.y());
    });
    return sightings;
}

std::vector<Sighting> distinctSpots(std::span<const Sighting> finds, double faintest, const DecoderOptions& options) {
    struct Spot {
        Vector2d place;
        Sighting best;
    };
    std::vector<Spot> spots;
    const double least = faintest * finds.front().fit.flux();
    for (const Sighting& find : finds) {
        const auto same = std::find_if(spots.begin(), spots.end(), [&](const Spot& spot) {
            return (find.fit.centre - spot.place).norm() <= options.sameSpot_px;
        });
        if (same == spots.end() && (spots.empty() || find.fit.flux() > least))
            spots.push_back({find.fit.centre, find});
        else if (same != spots.end() && find.fit.sigma_px < same->best.fit.sigma_px)
            same->best = find;
    }
    std::vector<Sighting> best;
    for (const Spot& spot : spots)
        best.push_back(spot.best);
    return best;
}

std::vector<MirroredPair> mirroredPairs(std::span<const Sighting> sightings, std::span<const std::uint8_t> counts,
                                        double sameSpot_px) {
    std::vector<MirroredPair> pairs;
    for (auto first = sightings.begin(); first != sightings.end();) {
        const auto last =
            std::find_if(first, sightings.end(), [&](const Sighting& other) { return other.module != first->module; });
        const SpotFit& led = first->fit;
        const auto second = std::find_if(
            first, last, [&](const Sighting& other) { return (other.fit.centre - led.centre).norm() > sameSpot_px; });
        if (second != last && counts[first->module] != 0)
            pairs.push_back({led.centre, second->fit.centre, second->fit.flux() / led.flux()});
        first = last;
    }
    return pairs;
}

Undetected undecided(const std::vector<Sighting>& spots, const DecoderOptions& options) {
    Undetected result{{}, DetectionVerdict::Ambiguous, {}, {}, Undetected::Cause::Reflected};
    result.reason = spots.size() == 1   ? Sentence::saying("its only spot lies where others are reflected")
                    : spots.size() == 2 ? Sentence::saying("two spots {:.0f} px apart blink its word",
                                                           (spots[1].fit.centre - spots[0].fit.centre).norm())
                                        : Sentence::saying("{} spots blink its word", spots.size());
    // One that is left out might be the LED itself.
    if (spots.size() > static_cast<std::size_t>(options.maxSpots))
        return result;
    for (const auto& [module, fit, when, match] : spots)
        result.spots.push_back({fit.centre, fit.sigma_px, std::min(1.0, fit.flux() / spots.front().fit.flux())});
    return result;
}

std::optional<double> knocked_px(const std::vector<Sighting>& sightings, const std::vector<MatchedSpot>& matches) {
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

}  // namespace skincal
