#include "core/vision/decoder.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/vision/colour_mixing.h"
#include "core/vision/looks.h"
#include "core/vision/mirror_side.h"
#include "core/vision/sightings.h"
#include "core/vision/spot_passes.h"

namespace skincal {
namespace {

ViewDetections decide(std::span<const ModuleId> modules, const SpotScan& scan, const std::vector<MatchedSpot>& matches,
                      const std::vector<Sighting>& sightings, std::optional<double> moved,
                      const DecoderOptions& options, std::vector<MirroredPair> mirrored, Verdicts& verdicts) {
    ViewDetections result;
    result.moved_px = moved;
    const bool spoilt = moved.value_or(0) > options.maxMotion_px;
    std::vector<std::size_t> sharing(modules.size(), 0);
    for (const std::size_t first : scan.codebook.representative)
        ++sharing[first];
    std::vector<std::uint8_t> isAlone(modules.size());
    for (std::size_t u = 0; u < modules.size(); ++u)
        isAlone[u] = sharing[scan.codebook.representative[u]] == 1 ? 1 : 0;
    const std::vector<MirroredPair> pairs = mirroredPairs(sightings, isAlone, options.sameSpot_px);
    mirrored.insert(mirrored.end(), pairs.begin(), pairs.end());
    const MirrorSide mirror(mirrored);
    // Beyond a mirror LEDs may be far brighter than where the camera sees them; glints never are.
    constexpr double kGlint = 0.02;
    for (std::size_t u = 0; u < modules.size(); ++u) {
        const auto spots = std::equal_range(sightings.begin(), sightings.end(), Sighting{u, {}},
                                            [](const Sighting& a, const Sighting& b) { return a.module < b.module; });
        if (!scan.codebook.blinks(u)) {
            verdicts.note(u, DetectionVerdict::NotFound, Undetected::Cause::NeverBlinked,
                          scan.codebook.lit[u].empty()
                              ? Sentence::saying("its LED was never lit")
                              : Sentence::saying("its LED was never dark, or only like a drift"));
        } else if (sharing[scan.codebook.representative[u]] > 1) {
            verdicts.note(u, DetectionVerdict::Ambiguous, Undetected::Cause::Alike,
                          sharing[scan.codebook.representative[u]] == 2
                              ? Sentence::saying("lit in the same frames as another module")
                              : Sentence::saying("lit in the same frames as {} other modules",
                                                 sharing[scan.codebook.representative[u]] - 1));
        } else if (spots.first != spots.second && spoilt) {
            verdicts.replace(u, {{},
                                 DetectionVerdict::NotFound,
                                 Sentence::saying("the camera moved while its word was shown"),
                                 {},
                                 Undetected::Cause::CameraMoved,
                                 nearestSpot(scan, matches[spots.first->match], u)});
        } else if (spots.first != spots.second) {
            const bool isDoubtful = mirror.mayReflect(spots.first->fit.centre);
            const std::vector<Sighting> distinct =
                distinctSpots({spots.first, spots.second}, isDoubtful ? kGlint : 1 / options.reflectionRatio, options);
            if (distinct.size() == 1 && !isDoubtful) {
                const SpotFit& fit = distinct[0].fit;
                result.found.push_back({modules[u], fit.centre, std::hypot(fit.sigma_px, 0.5 * moved.value_or(0))});
                result.readings.push_back(readingOf(scan, matches[distinct[0].match], u));
                continue;
            }
            Undetected several = undecided(distinct, options);
            several.nearest = nearestSpot(scan, matches[distinct.front().match], u);
            several.nearest->pixel = distinct.front().fit.centre;
            for (std::size_t k = 0; k < several.spots.size(); ++k)
                several.spots[k].reading = readingOf(scan, matches[distinct[k].match], u);
            verdicts.replace(u, std::move(several));
        }
        result.undetected.push_back(verdicts.take(u, modules[u]));
    }
    result.mirrored = std::move(mirrored);
    using Cause = Undetected::Cause;
    result.unexplained =
        verdicts.unexplained() + static_cast<std::size_t>(std::count_if(
                                     result.undetected.begin(), result.undetected.end(), [](const Undetected& one) {
                                         return one.cause == Cause::Alike || one.cause == Cause::NotAnLed ||
                                                one.cause == Cause::TooBright || one.cause == Cause::TooWeak;
                                     }));
    return result;
}

/// Pictures in which a channel is a colour.
FrameLoader unmixing(const ColourMixing& mixing, const FrameLoader& load) {
    return [&mixing, &load](std::size_t frame) {
        return load(frame).map([&](const cv::Mat& picture) { return mixing.unmixed(picture); });
    };
}

/// @param mirrored  in the looks before it
tl::expected<ViewDetections, ScanError> decodeLook(std::span<const ModuleId> modules, std::span<const FrameInfo> frames,
                                                   const FrameLoader& load, std::vector<MirroredPair> mirrored,
                                                   const DecoderOptions& options, const RunContext& context) {
    const auto mixing = ColourMixing::measured(frames, load);
    if (!mixing)
        return tl::unexpected(ScanError{Sentence::verbatim(mixing.error()), false});
    auto measured = measureSpots(modules, frames, *mixing ? unmixing(**mixing, load) : load, options, context);
    if (!measured)
        return tl::unexpected(std::move(measured.error()));
    auto& [scan, matches, moved_px, suited, verdicts] = *measured;
    // What moves leaves light that its word does not explain, about as much as the square of the way over that of a
    // spot's width.
    suited.maxStrayShare += std::pow(std::min(moved_px.value_or(0), options.maxMotion_px), 2);
    const std::vector<Sighting> sightings = sightingsOf(scan, matches, suited, verdicts);
    // Who stops in front of a part of the skin hides it as suddenly as a knock does; the rest has not moved then.
    if (!moved_px || *moved_px > 0)
        moved_px = std::max(moved_px, knocked_px(sightings, matches));
    ViewDetections result = decide(modules, scan, matches, sightings, moved_px, options, std::move(mirrored), verdicts);
    result.look = frames.empty() ? 0 : frames.front().look;
    for (WordReading& reading : result.readings)
        reading.look = result.look;
    for (Undetected& undetected : result.undetected) {
        if (undetected.nearest)
            undetected.nearest->reading.look = result.look;
        for (SpotChoice& spot : undetected.spots)
            spot.reading.look = result.look;
    }
    context.report(Sentence::saying("measuring spots"), 1);
    return result;
}

/// Some pictures of a view.
FrameLoader from(std::size_t first, const FrameLoader& load) {
    return [first, &load](std::size_t k) { return load(first + k); };
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
    const std::vector<std::size_t> beginnings = beginningsOfLooks(frames);
    const std::size_t end = beginnings.size() > 1 ? beginnings[1] : frames.size();
    auto view = decodeLook(modules, frames.first(end), load, {}, options, context);
    if (!view)
        return view;
    view->name = std::move(name);
    if (end == frames.size())
        return view;
    return decodeFurther(*std::move(view), end, modules, frames, load, options, context);
}

tl::expected<ViewDetections, ScanError> decodeFurther(ViewDetections view, std::size_t first,
                                                      std::span<const ModuleId> modules,
                                                      std::span<const FrameInfo> frames, const FrameLoader& load,
                                                      const DecoderOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("DecoderOptions out of range");
    while (first < frames.size()) {
        const auto rest = frames.subspan(first);
        const std::vector<std::size_t> beginnings = beginningsOfLooks(rest);
        const auto look = rest.first(beginnings.size() > 1 ? beginnings[1] : rest.size());
        if (const auto words = litWords(modules, look); !words)
            return tl::unexpected(ScanError{words.error(), false});
        // A look at a few may show too few twice to tell of a mirror that those before it showed.
        const auto further = decodeLook(modulesLitIn(look), look, from(first, load), view.mirrored, options, context);
        if (!further)
            return further;
        (void)addLook(view, *further, {options.maxMotion_px, options.sameSpot_px});
        first += look.size();
    }
    sortAs(modules, view);
    return view;
}

}  // namespace skincal
