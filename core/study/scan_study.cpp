#include "core/study/scan_study.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>

#include "core/geometry/parallel.h"
#include "core/simulation/renderer.h"
#include "core/study/centre_bound.h"
#include "core/study/scan_body.h"
#include "core/vision/decoder.h"
#include "core/vision/further_looks.h"
#include "core/vision/paper_detector.h"

namespace skincal {
namespace {

// A room that changes has no level that noise could be told from.
bool isSteady(Disturbance disturbance) {
    return disturbance == Disturbance::None || disturbance == Disturbance::Ambient ||
           disturbance == Disturbance::Focus || disturbance == Disturbance::Crowding;
}

/// A scan of the study's view, looks added one after the other.
class StudiedScan {
  public:
    StudiedScan(World world, const ScanCase& what)
        : world_(std::move(world)),
          what_(what),
          frames_(planned(world_, what)),
          renderer_(world_, kScanView, frames_.size()),
          pictures_(frames_.size() <= kKept ? frames_.size() : 0) {
        for (const SkinModule& module : world_.skin.modules)
            modules_.push_back(module.id);
    }

    [[nodiscard]] ScanScore score(const RunContext& context) {
        auto view = decode(nullptr, 0, context);
        FurtherLooks further(kScanView);
        while (view && what_.method == ScanMethod::Coded) {
            const auto look = further.next(*view);
            if (!look)
                break;
            const std::size_t first = frames_.size();
            for (const auto& lit : *look)
                frames_.push_back({{}, lit, {}, further.looks()});
            if (!pictures_.empty())
                pictures_.resize(frames_.size());
            auto looked = decode(&*view, first, context);
            // What the looks before it found is kept, as where an operator scans.
            isRefused_ = isRefused(looked);
            if (isRefused_)
                break;
            view = std::move(looked);
        }
        // First pictures that are refused give nothing, which counts against the scan.
        if (isRefused(view)) {
            isRefused_ = true;
            view = ViewDetections();
        }
        if (!view)
            return {};
        std::vector<LedDetection> taken;
        if (hasMirror(what_.disturbance))
            taken = spotsTakenByBody(world_, *view, context);
        if (context.isCancelled())
            return {};
        ScanScore result = scoreOf(world_, *view, taken, bounds(*view));
        result.refused = isRefused_ ? 1 : 0;
        result.frames = frames_.size();
        result.seconds = seconds_;
        return result;
    }

  private:
    using Clock = std::chrono::steady_clock;
    using Decoded = tl::expected<ViewDetections, ScanError>;
    // Decoders pass over the pictures several times: they are kept where that is a few, else painted anew.
    static constexpr std::size_t kKept = 300;

    static bool isRefused(const Decoded& view) { return !view && !view.error().cancelled; }

    static std::vector<FrameInfo> planned(World& world, const ScanCase& what) {
        const bool isCoded = what.method == ScanMethod::Coded || what.method == ScanMethod::CodedOnce;
        world.scenario.views.scan = isCoded ? ScanKind::Coded : ScanKind::OneAtATime;
        return planScan(world, kScanView);
    }

    cv::Mat picture(std::size_t k) {
        const auto start = Clock::now();
        cv::Mat picture = pictures_.empty() ? cv::Mat() : pictures_[k];
        if (picture.empty())
            picture = renderer_.render(frames_[k].lit, k);
        if (!pictures_.empty())
            pictures_[k] = picture;
        painting_ += std::chrono::duration<double>(Clock::now() - start).count();
        return picture;
    }

    Decoded decode(const ViewDetections* before, std::size_t first, const RunContext& context) {
        const FrameLoader load = [this](std::size_t k) { return picture(k); };
        painting_ = 0;
        const auto start = Clock::now();
        auto view = before != nullptr ? decodeFurther(*before, first, modules_, frames_, load, {}, context)
                    : what_.method == ScanMethod::PaperSingle
                        ? detectPaper("view", modules_, frames_, load, {}, context)
                        : decodeView("view", modules_, frames_, load, {}, context);
        seconds_ = std::chrono::duration<double>(Clock::now() - start).count() - painting_;
        return view;
    }

    /// Of each centre over the pictures of the look that found it: the others don't count in it.
    std::vector<std::optional<double>> bounds(const ViewDetections& view) {
        if (!isSteady(what_.disturbance) || pictures_.empty())
            return {};
        std::map<std::size_t, std::vector<ModuleId>> foundIn;
        for (std::size_t i = 0; i < view.found.size(); ++i)
            foundIn[view.readings.empty() ? 0 : view.readings[i].look].push_back(view.found[i].module);
        const auto index = world_.skin.indexById();
        std::vector<std::optional<double>> result(modules_.size());
        for (const auto& [look, found] : foundIn) {
            const auto isBefore = [](const FrameInfo& frame, std::size_t of) { return frame.look < of; };
            const auto begin = std::lower_bound(frames_.begin(), frames_.end(), look, isBefore);
            const auto end = std::lower_bound(begin, frames_.end(), look + 1, isBefore);
            const auto first = static_cast<std::size_t>(begin - frames_.begin());
            const auto count = static_cast<std::size_t>(end - begin);
            // Not every detector has looked at all of them.
            for (std::size_t k = 0; k < count; ++k)
                (void)picture(first + k);
            const auto here = centreBounds(world_, renderer_.spots(), {begin, end},
                                           std::span<const cv::Mat>(pictures_).subspan(first, count));
            for (const ModuleId module : found)
                result[index.at(module)] = here[index.at(module)];
        }
        return result;
    }

    World world_;
    ScanCase what_;
    std::vector<FrameInfo> frames_;
    FrameRenderer renderer_;
    std::vector<cv::Mat> pictures_;
    std::vector<ModuleId> modules_;
    bool isRefused_ = false;
    double painting_ = 0;  ///< s, of the last decode
    double seconds_ = 0;   ///< that the last decode took without it
};

}  // namespace

ScanScore scoreScan(const ScanCase& what, std::uint64_t seed, const RunContext& context) {
    return scoreScan(scanWorld(what, seed), what, context);
}

ScanScore scoreScan(World world, const ScanCase& what, const RunContext& context) {
    return StudiedScan(std::move(world), what).score(context);
}

bool ScanStudyOptions::validate() const {
    return !cases.empty() && seeds > 0 && seeds <= 100'000 &&
           std::all_of(cases.begin(), cases.end(), [](const ScanCase& what) {
               return what.modules > 0 && what.modules <= 20'000 && what.distance >= 0.2 && what.distance <= 5;
           });
}

ScanStudy runScanStudy(const ScanStudyOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("ScanStudyOptions out of range");
    const auto seeds = static_cast<std::size_t>(options.seeds);
    std::vector<ScanScore> scores(options.cases.size() * seeds);
    // The context is asked on this thread alone, within scans as well.
    std::atomic<bool> cancelled = false;
    const auto goesOn = [&] {
        if (context.isCancelled())
            cancelled = true;
        return !cancelled;
    };
    RunContext silent;
    silent.isCancelled = [&, own = std::this_thread::get_id()] {
        return std::this_thread::get_id() == own ? !goesOn() : cancelled.load();
    };
    forEachInParallel(
        scores.size(), 1,
        [&](std::size_t i) { scores[i] = scoreScan(options.cases[i / seeds], options.firstSeed + i % seeds, silent); },
        [&](std::size_t i) {
            context.report(Sentence::saying("scanning"), static_cast<double>(i) / static_cast<double>(scores.size()));
            return goesOn();
        },
        [&] { (void)goesOn(); });
    ScanStudy study{options, {}, cancelled};
    if (study.cancelled)
        return study;
    for (std::size_t k = 0; k < options.cases.size(); ++k) {
        ScanStudyRow row{options.cases[k], {}};
        for (std::size_t i = 0; i < seeds; ++i)
            row.score.add(scores[k * seeds + i]);
        study.rows.push_back(row);
    }
    return study;
}

}  // namespace skincal
