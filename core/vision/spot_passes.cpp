#include "core/vision/spot_passes.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "core/vision/frame_pass.h"
#include "core/vision/late_pictures.h"
#include "core/vision/match_fits.h"
#include "core/vision/parallel.h"
#include "core/vision/scan_motion.h"
#include "core/vision/spot_maps.h"

namespace skincal {
namespace {

using Done = tl::expected<void, ScanError>;

class SpotPasses {
  public:
    SpotPasses(std::span<const ModuleId> modules, std::span<const FrameInfo> frames, const FrameLoader& load,
               LitWords words, const DecoderOptions& options, const RunContext& context)
        : modules_(modules),
          frames_(frames),
          words_(std::move(words)),
          options_(options),
          context_(context),
          pass_(frames, load, words_.coloured, context),
          motion_(options.windowRadius, options.fit),
          result_{{}, {}, {}, Verdicts(modules.size())} {
        result_.scan.codebook = makeCodebook(words_);
    }

    /// Where does anything blink?
    [[nodiscard]] Done find();
    /// How does it blink?
    [[nodiscard]] Done read();
    /// Whose word is that?
    [[nodiscard]] Done match();
    /// What does its light look like, and where is its centre?
    [[nodiscard]] Done measure();
    [[nodiscard]] Done fit();
    [[nodiscard]] MeasuredSpots take() {
        result_.moved_px = motion_.moved_px();
        return std::move(result_);
    }

  private:
    [[nodiscard]] Done eachPlane(const Sentence& stage, double from, double to,
                                 const std::function<void(const FramePlane&)>& visit);
    void addToMaps(std::span<const FramePlane> planes);

    std::span<const ModuleId> modules_;
    std::span<const FrameInfo> frames_;
    LitWords words_;
    const DecoderOptions& options_;
    const RunContext& context_;
    FramePass pass_;
    cv::Size size_{};
    std::vector<SpotCandidate> candidates_;
    ScanMotion motion_;
    MeasuredSpots result_;
};

Done SpotPasses::find() {
    SpotFinder finder(options_.candidates);
    auto done = pass_.run(Sentence::saying("looking for spots"), 0, 0.4, [&](std::size_t, const FramePixels& frame) {
        size_ = frame.size();
        finder.add(frame, words_.coloured);
    });
    if (!done)
        return done;
    candidates_ = finder.candidates(modules_.size() * static_cast<std::size_t>(options_.candidatesPerModule) +
                                    static_cast<std::size_t>(options_.extraCandidates));
    // Those side by side after each other: their windows share what a cache holds of a picture.
    std::sort(candidates_.begin(), candidates_.end(), [](const SpotCandidate& a, const SpotCandidate& b) {
        constexpr int kStripe = 16;
        return std::make_tuple(a.y / kStripe, a.x, a.y) < std::make_tuple(b.y / kStripe, b.x, b.y);
    });
    result_.scan.noise = finder.noise();
    return {};
}

Done SpotPasses::eachPlane(const Sentence& stage, double from, double to,
                           const std::function<void(const FramePlane&)>& visit) {
    const std::size_t perFrame = words_.planesPerFrame();
    return pass_.run(stage, from, to, [&](std::size_t k, const FramePixels& frame) {
        for (std::size_t plane = k * perFrame; plane < (k + 1) * perFrame; ++plane)
            visit({plane, words_.planes[plane].channel, frame});
    });
}

Done SpotPasses::read() {
    SpotScan& scan = result_.scan;
    if (candidates_.empty())
        return {};
    scan.series = SpotSeries(scan.codebook.planes(), candidates_.size());
    auto done = eachPlane(Sentence::saying("reading spots"), 0.4, 0.75, [&](const FramePlane& one) {
        scan.series.read(one.frame, candidates_, options_.windowRadius, one.plane, one.channel);
    });
    if (done)
        scan.levelExposure(options_.windowRadius);
    return done;
}

Done SpotPasses::match() {
    if (candidates_.empty())
        return {};
    auto matched = matchCandidates(result_.scan, candidates_, modules_, options_.words, context_, result_.verdicts);
    if (!matched)
        return tl::unexpected(ScanError{Sentence::saying("cancelled"), true});
    result_.matches = *std::move(matched);
    std::set<std::size_t> inTime;
    for (const MatchedSpot& match : result_.matches)
        inTime.insert(match.series.words.begin(), match.series.words.end());
    if (const auto late = picturesLate(result_.scan, inTime.size(), options_.words))
        return tl::unexpected(ScanError{
            Sentence::saying("{}: each picture shows what was lit {} before it: the camera is later than it was "
                             "waited for",
                             frames_.front().file,
                             *late == 1 ? Sentence::saying("one picture") : Sentence::saying("two pictures")),
            false});
    return {};
}

void SpotPasses::addToMaps(std::span<const FramePlane> planes) {
    (void)forEach(result_.matches.size(), {}, [&](std::size_t i) {
        for (AmplitudeMap& map : result_.matches[i].maps)
            map.add(planes, result_.scan.noise);
    });
    motion_.add(planes, result_.scan.noise);
}

Done SpotPasses::measure() {
    if (result_.matches.empty())
        return {};
    prepareMaps(result_.scan, size_, options_, result_.matches, motion_);
    // Some pictures at a time: all maps together are larger than caches are, each is not.
    constexpr std::size_t kAtOnce = 16;
    std::vector<FramePlane> waiting;
    auto done = eachPlane(Sentence::saying("measuring spots"), 0.75, 1, [&](const FramePlane& one) {
        waiting.push_back(one);
        if (waiting.size() < kAtOnce)
            return;
        addToMaps(waiting);
        waiting.clear();
    });
    addToMaps(waiting);
    return done;
}

Done SpotPasses::fit() {
    const bool isFitted = forEach(result_.matches.size(), context_,
                                  [&](std::size_t i) { fitMatch(result_.scan, options_, result_.matches[i]); });
    if (!isFitted)
        return tl::unexpected(ScanError{Sentence::saying("cancelled"), true});
    return {};
}

}  // namespace

tl::expected<MeasuredSpots, ScanError> measureSpots(std::span<const ModuleId> modules,
                                                    std::span<const FrameInfo> frames, const FrameLoader& load,
                                                    const DecoderOptions& options, const RunContext& context) {
    auto words = litWords(modules, frames);
    if (!words)
        return tl::unexpected(ScanError{words.error(), false});
    SpotPasses passes(modules, frames, load, *std::move(words), options, context);
    for (const auto step :
         {&SpotPasses::find, &SpotPasses::read, &SpotPasses::match, &SpotPasses::measure, &SpotPasses::fit}) {
        if (auto done = (passes.*step)(); !done)
            return tl::unexpected(std::move(done.error()));
    }
    return passes.take();
}

}  // namespace skincal
