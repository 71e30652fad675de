#include "core/procedure/pose_capture.h"

#include <algorithm>
#include <stdexcept>

namespace skincal {
namespace {

using namespace pose_capture;
using Phase = PoseCapture::Phase;
using Result = Stepped<PoseCapture, Effect>;

struct Stepper {
    const PoseCapture& state;
    const PoseCaptureOptions& options;

    Result operator()(const Start&) const {
        if (state.phase != Phase::Off)
            return {state};
        return {{Phase::Moving, {}}};
    }
    Result operator()(const Stop&) const { return {PoseCapture{}}; }

    Result operator()(const Sample& sample) const {
        if (state.phase == Phase::Off)
            return {state};
        if (!sample.isAtRest)
            return {{Phase::Moving, {}}};
        // A clock that began anew says nothing about how long the body has rested.
        if (state.phase == Phase::Moving || sample.time < state.since)
            return {{sample.isNew ? Phase::Resting : Phase::Captured, sample.time}};
        if (state.phase == Phase::Captured) {
            // A pose that was dropped is worth capturing again, though nothing moved.
            return sample.isNew ? Result{{Phase::Resting, sample.time}} : Result{state};
        }
        if (!sample.isNew)
            return {{Phase::Captured, state.since}};
        if (options.isAutomatic && sample.time - state.since >= options.rest)
            return {{Phase::Captured, sample.time}, {Capture{sample.time - options.rest}}};
        return {state};
    }

    Result operator()(const CaptureNow& now) const {
        if (state.phase == Phase::Off)
            return {state};
        // Half of the time gives readings that are 1.4 times as noisy; less would be the tremble of coming to rest.
        const bool hasRested = state.phase != Phase::Moving && now.time - state.since >= options.rest / 2;
        if (!hasRested)
            return {state, {Refuse{}}};
        return {{Phase::Captured, now.time}, {Capture{std::max(state.since, now.time - options.rest)}}};
    }
};

}  // namespace

Stepped<PoseCapture, pose_capture::Effect> step(const PoseCapture& state, const pose_capture::Event& event,
                                                const PoseCaptureOptions& options) {
    if (!options.validate())
        throw std::logic_error("PoseCaptureOptions out of range");
    return std::visit(Stepper{state, options}, event);
}

}  // namespace skincal
