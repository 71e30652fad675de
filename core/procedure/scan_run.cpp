#include "core/procedure/scan_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace skincal {
namespace {

using namespace scan_run;
using Phase = ScanRun::Phase;
using Fault = ScanRun::Fault;
using Result = Stepped<ScanRun, Effect>;

constexpr std::size_t kDark = 0;
constexpr std::size_t kAllLit = 1;
constexpr std::size_t kToggles = 3;

/// What the newest toggle lights: on, off, on.
std::size_t toggledFrame(const ScanRun& state) {
    return state.toggles.size() % 2 == 1 ? kAllLit : kDark;
}

/// A picture shows all of a change once the next one shows no more of it.
bool isToggleOver(const ScanRun& state, const ScanRunOptions& options) {
    const LightToggle& toggle = state.toggles.back();
    if (!state.isAnswered || toggle.pictures.size() < 3)
        return false;
    const double sign = toggledFrame(state) == kAllLit ? 1 : -1;
    const double last = sign * toggle.pictures.back().share;
    const double before = sign * toggle.pictures[toggle.pictures.size() - 2].share;
    constexpr double kSame = 0.05;
    return std::min(last, before) >= options.leastChange && std::abs(last - before) <= kSame * last;
}

LightToggle withShares(LightToggle toggle) {
    const double whole = toggle.pictures.back().share;
    for (LightToggle::Picture& picture : toggle.pictures)
        picture.share /= whole;
    return toggle;
}

std::vector<std::size_t> allFrames(std::size_t count) {
    std::vector<std::size_t> frames(count);
    std::iota(frames.begin(), frames.end(), std::size_t{0});
    return frames;
}

struct Stepper {
    const ScanRun& state;
    const ScanRunOptions& options;

    [[nodiscard]] bool in(Phase phase) const { return state.phase == phase; }
    [[nodiscard]] bool isBusy() const { return state.isRunning() || in(Phase::Paused) || in(Phase::Decoding); }

    /// Lights a frame, whatever becomes of it.
    static void command(Result& result, std::size_t frame, std::optional<Time> at, std::chrono::milliseconds patience) {
        result.state.token.reset();
        result.state.isAnswered = false;
        result.effects.emplace_back(Light{frame, at});
        result.effects.emplace_back(StartTimer{patience});
    }
    static void keep(Result& result, std::size_t frame) {
        ScanRun& next = result.state;
        std::erase(next.left, frame);
        next.repeats = 0;
        next.misses = 0;
        result.effects.emplace_back(KeepPicture{frame});
        if (!next.left.empty())
            return;
        next.phase = Phase::Decoding;
        result.effects.insert(result.effects.end(), {StopTimer{}, LightsOff{}, Decode{}});
    }
    [[nodiscard]] Result failed(Fault fault) const {
        ScanRun next = state;
        next.phase = Phase::Failed;
        next.fault = fault;
        return {std::move(next), {StopTimer{}, LightsOff{}, Discard{}}};
    }

    // One by one.

    void lightNext(Result& result) const {
        result.state.phase = Phase::Lighting;
        command(result, result.state.left.front(), std::nullopt, options.lightAnswers);
    }
    void giveUpTiming(Result& result) const {
        ScanRun& next = result.state;
        // Pictures of toggles that say nothing are none to be kept.
        if (next.phase == Phase::Timing)
            next.left = allFrames(next.frames);
        next.isTimed = false;
        next.plan.reset();
        next.toggles.clear();
        next.shows.clear();
        next.queue.clear();
        lightNext(result);
    }
    [[nodiscard]] std::chrono::milliseconds settle() const {
        if (state.slowest == Time{})
            return std::max(options.settle, options.toggleShows);
        const Time seen = state.slowest + options.timing.minMargin;
        return std::max(options.settle, std::chrono::ceil<std::chrono::milliseconds>(seen));
    }

    // Timing the light.

    void beginTiming(Result& result) const {
        result.state.phase = Phase::Timing;
        result.state.toggles.clear();
        ++result.state.timings;
        command(result, kDark, std::nullopt, options.lightAnswers);
    }
    /// Each a third of a period later than the one before it.
    void toggle(Result& result, const PictureTaken& picture) const {
        ScanRun& next = result.state;
        Time at = picture.now + options.lead;
        if (!next.toggles.empty()) {
            const auto& seen = next.toggles.front().pictures;
            const Time period = (seen.back().time - seen.front().time) / static_cast<Time::rep>(seen.size() - 1);
            at += static_cast<Time::rep>(next.toggles.size()) * period / static_cast<Time::rep>(kToggles);
        }
        LightToggle& begun = next.toggles.emplace_back();
        begun.commanded = at;
        begun.pictures.push_back({picture.time, 0});
        result.effects.emplace_back(TakeReference{});
        command(result, toggledFrame(next), next.keepsTime ? std::optional(at) : std::nullopt, options.lightAnswers);
    }
    [[nodiscard]] Result timed(const PictureTaken& picture) const {
        Result result{state};
        ScanRun& next = result.state;
        next.newest = picture.time;
        next.newestCame = picture.now;
        if (next.toggles.empty()) {
            if (next.isAnswered && picture.time >= next.showsFrom)
                toggle(result, picture);
            return result;
        }
        LightToggle& current = next.toggles.back();
        current.pictures.push_back({picture.time, picture.change});
        if (!isToggleOver(next, options)) {
            if (picture.now > current.commanded + options.toggleShows)
                next.timings == 1 ? beginTiming(result) : giveUpTiming(result);
            return result;
        }
        current = withShares(std::move(current));
        next.slowest = std::max(next.slowest, picture.time - current.commanded);
        keep(result, toggledFrame(next));
        if (next.phase == Phase::Decoding)
            return result;
        if (next.toggles.size() < kToggles)
            toggle(result, picture);
        else
            planStream(result, picture.now);
        return result;
    }
    void planStream(Result& result, Time now) const {
        ScanRun& next = result.state;
        if (const auto timing = estimateLightTiming(next.toggles, options.timing)) {
            next.timing = *timing;
            next.plan = planLights(*timing, next.keepsTime, options.timing);
        }
        // What was lit earlier may have spoilt it.
        if (!next.timing && next.timings == 1)
            return beginTiming(result);
        if (!next.plan)
            return giveUpTiming(result);
        // Now that it is known when toggles were over, those pictures that came too early for it are taken again.
        for (const std::size_t frame : {kAllLit, kDark}) {
            const LightToggle& toggle = next.toggles[frame == kDark ? kToggles - 2 : kToggles - 1];
            if (toggle.pictures.back().time < toggle.acknowledged + next.plan->from)
                next.left.insert(next.left.begin(), frame);
        }
        next.toggles.clear();
        beginStream(result);
        goOn(result, now);
    }

    /// The skin says that it lights at a given time, and has done it before.
    [[nodiscard]] bool isHasty(Time now) const {
        constexpr std::chrono::milliseconds kClocksDiffer{5};
        const bool isToggle = in(Phase::Timing) && !state.toggles.empty();
        if (!state.keepsTime || (!isToggle && !in(Phase::Streaming)))
            return false;
        const Time due = isToggle ? state.toggles.back().commanded : state.shows.back().commanded;
        return now < due - kClocksDiffer;
    }

    // At the camera's rate.

    void beginStream(Result& result) const {
        ScanRun& next = result.state;
        next.phase = Phase::Streaming;
        next.shows.clear();
        next.queue = next.left;
        next.misses = 0;
        next.isAnswered = true;
        result.effects.emplace_back(StartTimer{options.pictureComes});
    }
    /// Lights what is next in the queue, where it is time to say so.
    void goOn(Result& result, Time now) const {
        ScanRun& next = result.state;
        const LightPlan& plan = *next.plan;
        if (next.phase != Phase::Streaming || !next.isAnswered || next.queue.empty() || !next.newest)
            return;
        // Nothing is lit for a camera that is silent.
        if (now - next.newestCame > 4 * plan.period)
            return;
        std::optional<Time> at;
        if (next.keepsTime)
            at = nextShowAt(next.shows, *next.newest, now + options.lead, plan);
        else if (!isNextShowDue(next.shows, now, plan))
            return;
        const std::size_t frame = next.queue.front();
        next.queue.erase(next.queue.begin());
        next.shows.push_back({frame, at.value_or(now), {}});
        const auto wait = std::chrono::ceil<std::chrono::milliseconds>(at.value_or(now) - now);
        command(result, frame, at, options.lightAnswers + wait);
    }
    [[nodiscard]] Result streamed(const PictureTaken& picture) const {
        Result result{state};
        ScanRun& next = result.state;
        next.newest = picture.time;
        next.newestCame = picture.now;
        const LightPlan& plan = *next.plan;
        const auto isLeft = [&](std::size_t frame) {
            return std::binary_search(next.left.begin(), next.left.end(), frame);
        };
        if (const auto seen = showIn(next.shows, picture.time, picture.now, plan)) {
            if (const std::size_t frame = next.shows[*seen].frame; isLeft(frame)) {
                keep(result, frame);
                if (next.phase == Phase::Decoding)
                    return result;
                result.effects.emplace_back(StartTimer{options.pictureComes});
            }
        }
        for (std::size_t over = showsOver(next.shows, picture.time, plan); over > 0; --over) {
            if (const std::size_t frame = next.shows.front().frame; isLeft(frame)) {
                next.queue.push_back(frame);
                ++next.misses;
            }
            next.shows.erase(next.shows.begin());
        }
        if (next.misses >= options.maxMisses)
            giveUpTiming(result);
        else
            goOn(result, picture.now);
        return result;
    }

    Result operator()(const Start& start) const {
        if (isBusy() || start.frames == 0)
            return {state};
        Result result{ScanRun{}};
        result.state.frames = start.frames;
        result.state.left = allFrames(start.frames);
        result.state.isTimed = start.toggles != Toggles::None && start.frames > kAllLit;
        result.state.keepsTime = start.toggles == Toggles::GivenTime;
        result.state.slowest = start.slowest;
        begin(result);
        return result;
    }
    Result operator()(const Extend& more) const {
        if (!in(Phase::Decoding) || more.frames == 0)
            return {state};
        Result result{state};
        ScanRun& next = result.state;
        next.left.resize(more.frames);
        std::iota(next.left.begin(), next.left.end(), next.frames);
        next.frames += more.frames;
        next.repeats = 0;
        begin(result);
        return result;
    }
    /// Or goes on after a break: by the next picture it is known what time it is.
    void begin(Result& result) const {
        result.state.newest.reset();
        if (result.state.plan)
            beginStream(result);
        else if (result.state.isTimed)
            beginTiming(result);
        else
            lightNext(result);
    }
    Result operator()(const LightCommanded& commanded) const {
        if (!state.isRunning() || in(Phase::Settling) || state.isAnswered)
            return {state};
        ScanRun next = state;
        next.token = commanded.token;
        if (!next.keepsTime && in(Phase::Streaming))
            next.shows.back().commanded = commanded.now;
        if (!next.keepsTime && in(Phase::Timing) && !next.toggles.empty())
            next.toggles.back().commanded = commanded.now;
        return {std::move(next)};
    }
    Result operator()(const LightShown& shown) const {
        if (!state.isRunning() || state.isAnswered || shown.token != state.token)
            return {state};
        Result result{state};
        ScanRun& next = result.state;
        next.isAnswered = true;
        if (in(Phase::Lighting)) {
            next.phase = Phase::Settling;
            next.showsFrom = shown.now + settle();
            result.effects.emplace_back(StartTimer{settle() + options.pictureComes});
            return result;
        }
        if (isHasty(shown.now)) {
            next.keepsTime = false;
            next.plan.reset();
            next.left = allFrames(next.frames);
            begin(result);
            return result;
        }
        result.effects.emplace_back(StartTimer{options.pictureComes});
        if (in(Phase::Streaming)) {
            // Clocks differ by a little; what is acknowledged has been commanded.
            next.shows.back().acknowledged = std::max(shown.now, next.shows.back().commanded);
            goOn(result, shown.now);
        } else if (!next.toggles.empty()) {
            next.toggles.back().acknowledged = std::max(shown.now, next.toggles.back().commanded);
        } else {
            next.showsFrom = shown.now + (next.timings > 1 ? options.toggleShows : options.dark);
        }
        return result;
    }
    Result operator()(const PictureTaken& picture) const {
        const bool isNewer = !state.newest || picture.time > *state.newest;
        if (in(Phase::Timing) && isNewer)
            return timed(picture);
        if (in(Phase::Streaming) && isNewer)
            return streamed(picture);
        if (!in(Phase::Settling) || picture.time < state.showsFrom)
            return {state};
        Result result{state};
        keep(result, state.left.front());
        if (!result.state.left.empty())
            lightNext(result);
        return result;
    }
    Result operator()(const Pause&) const {
        if (!state.isRunning())
            return {state};
        ScanRun next = state;
        next.phase = Phase::Paused;
        return {std::move(next), {StopTimer{}, LightsOff{}}};
    }
    Result operator()(const Resume&) const {
        if (!in(Phase::Paused))
            return {state};
        Result result{state};
        result.state.repeats = 0;
        begin(result);
        return result;
    }
    Result operator()(const Cancel&) const {
        if (state.isRunning())
            return {{}, {StopTimer{}, LightsOff{}, Discard{}}};
        if (in(Phase::Paused) || in(Phase::Decoding))
            return {{}, {Discard{}}};
        return {ScanRun{}};
    }
    Result operator()(const Decoded&) const {
        if (!in(Phase::Decoding))
            return {state};
        ScanRun next = state;
        next.phase = Phase::Done;
        return {std::move(next)};
    }
    Result operator()(const Failed& what) const { return isBusy() ? failed(what.fault) : Result{state}; }
    Result operator()(const TimedOut&) const {
        if (!state.isRunning())
            return {state};
        // A camera that hiccups once must not cost all pictures so far. Its light is repeated, too: it may be gone.
        if (state.repeats >= options.maxRepeats)
            return failed(state.isAnswered ? Fault::CameraSilent : Fault::SkinSilent);
        Result result{state};
        ++result.state.repeats;
        // In a stream pictures may have come, and none that is surely of a pattern.
        if ((in(Phase::Streaming) && state.isAnswered) || (in(Phase::Timing) && state.timings >= options.maxTimings))
            giveUpTiming(result);
        else
            begin(result);
        return result;
    }
};

}  // namespace

Stepped<ScanRun, scan_run::Effect> step(const ScanRun& state, const scan_run::Event& event,
                                        const ScanRunOptions& options) {
    if (!options.validate())
        throw std::logic_error("ScanRunOptions out of range");
    return std::visit(Stepper{state, options}, event);
}

}  // namespace skincal
