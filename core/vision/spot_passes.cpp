#include "core/vision/spot_passes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "core/geometry/statistics.h"
#include "core/vision/frame_pass.h"
#include "core/vision/late_pictures.h"
#include "core/vision/match_fits.h"
#include "core/vision/parallel.h"
#include "core/vision/scan_motion.h"
#include "core/vision/spot_maps.h"

namespace skincal {
namespace {

using Done = tl::expected<void, ScanError>;

// Of the work, what finds spots, and of what is left a go at identifying them: whether there is another is not known.
constexpr double kFinding = 0.4;
constexpr double kOneGo = 0.7;

// How large a window a spot takes, and from where on it is none.
constexpr double kWidths = 4.3;
constexpr double kLargest = 0.8;
constexpr int kMostRadius = 18;

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
          result_{{}, {}, {}, options, Verdicts(modules.size())} {
        result_.scan.codebook = makeCodebook(words_);
    }

    /// Where does anything blink?
    [[nodiscard]] Done find();
    /// Who is it, and where exactly?
    [[nodiscard]] Done identify();
    /// Makes windows as large as the spots are that were identified, for another go; false where they are so already.
    [[nodiscard]] bool widen();
    /// Of the go that could measure most modules.
    [[nodiscard]] MeasuredSpots take();

  private:
    /// How does it blink?
    [[nodiscard]] Done read();
    /// Whose word is that?
    [[nodiscard]] Done match();
    /// What does its light look like, and where is its centre?
    [[nodiscard]] Done measure();
    [[nodiscard]] Done fit();
    /// @param from, to  of what there is to do after find()
    [[nodiscard]] Done eachPlane(const Sentence& stage, double from, double to,
                                 const std::function<void(const FramePlane&)>& visit);
    void addToMaps(std::span<const FramePlane> planes);
    [[nodiscard]] std::size_t modulesFitted() const;
    /// Nothing where nothing tells.
    [[nodiscard]] std::optional<double> usualWidth() const;
    void keep();

    std::span<const ModuleId> modules_;
    std::span<const FrameInfo> frames_;
    LitWords words_;
    DecoderOptions options_;
    const RunContext& context_;
    double done_ = 0;  ///< share of the work, before the next go
    FramePass pass_;
    cv::Size size_{};
    std::vector<SpotCandidate> candidates_;
    ScanMotion motion_;
    MeasuredSpots result_;
    std::optional<MeasuredSpots> kept_{};  ///< of an earlier go
    std::size_t keptModules_ = 0;          ///< that it fits
};

Done SpotPasses::find() {
    SpotFinder finder(options_.candidates);
    auto done =
        pass_.run(Sentence::saying("looking for spots"), 0, kFinding, [&](std::size_t, const FramePixels& frame) {
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
    done_ = kFinding;
    return {};
}

Done SpotPasses::eachPlane(const Sentence& stage, double from, double to,
                           const std::function<void(const FramePlane&)>& visit) {
    const std::size_t perFrame = words_.planesPerFrame();
    const double share = kOneGo * (1 - done_);
    return pass_.run(stage, done_ + share * from, done_ + share * to, [&](std::size_t k, const FramePixels& frame) {
        for (std::size_t plane = k * perFrame; plane < (k + 1) * perFrame; ++plane)
            visit({plane, words_.planes[plane].channel, frame});
    });
}

Done SpotPasses::read() {
    SpotScan& scan = result_.scan;
    if (candidates_.empty())
        return {};
    scan.series = SpotSeries(scan.codebook.planes(), candidates_.size());
    auto done = eachPlane(Sentence::saying("reading spots"), 0, 0.6, [&](const FramePlane& one) {
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
    auto done = eachPlane(Sentence::saying("measuring spots"), 0.6, 1, [&](const FramePlane& one) {
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

Done SpotPasses::identify() {
    for (const auto step : {&SpotPasses::read, &SpotPasses::match, &SpotPasses::measure, &SpotPasses::fit}) {
        if (auto done = (this->*step)(); !done)
            return done;
    }
    return {};
}

std::size_t SpotPasses::modulesFitted() const {
    std::set<std::size_t> fitted;
    for (const MatchedSpot& match : result_.matches) {
        for (std::size_t j = 0; j < match.fits.size(); ++j) {
            if (match.fits[j])
                fitted.insert(match.series.words[j]);
        }
    }
    return fitted.size();
}

std::optional<double> SpotPasses::usualWidth() const {
    constexpr std::size_t kFewest = 3;
    std::set<std::size_t> matched;
    std::vector<double> widths;
    for (const MatchedSpot& match : result_.matches) {
        matched.insert(match.series.words.begin(), match.series.words.end());
        for (const auto& fit : match.fits) {
            if (fit)
                widths.push_back(fit->width_px);
        }
    }
    // Where most fit no spot at all, windows may hold nothing but their plateaus.
    if (matched.size() >= kFewest && 2 * modulesFitted() < matched.size())
        return std::min(kLargest * options_.fit.maxWidth_px, 2 * options_.windowRadius / kWidths);
    return widths.empty() ? std::nullopt : std::optional(median(std::move(widths)));
}

bool SpotPasses::widen() {
    constexpr double kShifts = 2;
    constexpr double kMostPixels = 5e6;
    const auto usual = usualWidth();
    if (!usual)
        return false;
    const double affordable = std::sqrt(kMostPixels / static_cast<double>(result_.matches.size())) / 2;
    const int radius = static_cast<int>(
        std::min({std::ceil(kWidths * *usual), std::floor(affordable), static_cast<double>(kMostRadius)}));
    if (radius <= options_.windowRadius + 1)
        return false;
    done_ += kOneGo * (1 - done_);
    keep();
    options_.windowRadius = radius;
    options_.maxShift_px = std::max(options_.maxShift_px, kShifts * *usual);
    options_.fit.prior.logWidth = std::log(*usual);
    motion_ = ScanMotion(radius, options_.fit);
    result_.scan.codebook = kept_->scan.codebook;
    result_.scan.noise = kept_->scan.noise;
    return true;
}

void SpotPasses::keep() {
    keptModules_ = modulesFitted();
    result_.moved_px = motion_.moved_px();
    result_.options = options_;
    kept_ = std::exchange(result_, {{}, {}, {}, options_, Verdicts(modules_.size())});
}

MeasuredSpots SpotPasses::take() {
    const std::size_t fitted = modulesFitted();
    if (!kept_ || fitted >= keptModules_)
        keep();
    return *std::move(kept_);
}

}  // namespace

tl::expected<MeasuredSpots, ScanError> measureSpots(std::span<const ModuleId> modules,
                                                    std::span<const FrameInfo> frames, const FrameLoader& load,
                                                    const DecoderOptions& options, const RunContext& context) {
    auto words = litWords(modules, frames);
    if (!words)
        return tl::unexpected(ScanError{words.error(), false});
    SpotPasses passes(modules, frames, load, *std::move(words), options, context);
    Done done = passes.find();
    if (done)
        done = passes.identify();
    constexpr int kMore = 2;
    for (int more = 0; done && more < kMore && passes.widen(); ++more)
        done = passes.identify();
    if (!done)
        return tl::unexpected(std::move(done.error()));
    return passes.take();
}

}  // namespace skincal
