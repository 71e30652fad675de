#include "core/procedure/scan_run.h"

#include <stdexcept>

namespace skincal {
namespace {

using namespace scan_run;
using Phase = ScanRun::Phase;
using Fault = ScanRun::Fault;
using Result = Stepped<ScanRun, Effect>;

struct Stepper {
    const ScanRun& state;
    const ScanRunOptions& options;

    [[nodiscard]] bool in(Phase phase) const { return state.phase == phase; }
    [[nodiscard]] bool isBusy() const { return state.isRunning() || in(Phase::Paused) || in(Phase::Decoding); }

    [[nodiscard]] Result light(ScanRun next) const {
        next.phase = Phase::Lighting;
        next.token.reset();
        const std::size_t frame = next.next;
        return {std::move(next), {Light{frame}, StartTimer{options.lightAnswers}}};
    }
    [[nodiscard]] Result failed(Fault fault) const {
        ScanRun next = state;
        next.phase = Phase::Failed;
        next.fault = fault;
        return {std::move(next), {StopTimer{}, LightsOff{}, Discard{}}};
    }

    Result operator()(const Start& start) const {
        if (isBusy() || start.frames == 0)
            return {state};
        ScanRun next;
        next.frames = start.frames;
        return light(std::move(next));
    }
    Result operator()(const LightCommanded& commanded) const {
        if (!in(Phase::Lighting))
            return {state};
        ScanRun next = state;
        next.token = commanded.token;
        return {std::move(next)};
    }
    Result operator()(const LightShown& shown) const {
        if (!in(Phase::Lighting) || shown.token != state.token)
            return {state};
        ScanRun next = state;
        next.phase = Phase::Settling;
        next.showsFrom = shown.now + options.settle;
        return {std::move(next), {StartTimer{options.settle + options.pictureComes}}};
    }
    Result operator()(const PictureTaken& picture) const {
        if (!in(Phase::Settling) || picture.time < state.showsFrom)
            return {state};
        ScanRun next = state;
        next.repeats = 0;
        ++next.next;
        if (next.next < next.frames) {
            Result result = light(std::move(next));
            result.effects.insert(result.effects.begin(), KeepPicture{state.next});
            return result;
        }
        next.phase = Phase::Decoding;
        return {std::move(next), {KeepPicture{state.next}, StopTimer{}, LightsOff{}, Decode{}}};
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
        ScanRun next = state;
        next.repeats = 0;
        return light(std::move(next));
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
            return failed(in(Phase::Lighting) ? Fault::SkinSilent : Fault::CameraSilent);
        ScanRun next = state;
        ++next.repeats;
        return light(std::move(next));
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
