#pragma once

#include <chrono>
#include <variant>
#include <vector>

#include "core/procedure/machine.h"

namespace skincal {

/// Captures gravity poses by itself: the body is turned, comes to rest, rests for a while, is captured, is turned
/// again.
struct PoseCapture {
    enum class Phase {
        Off,
        Moving,    ///< or trembling
        Resting,   ///< in a pose that is worth capturing
        Captured,  ///< at rest in a pose that is there already: to be turned on
    };
    Phase phase = Phase::Off;
    std::chrono::microseconds since{};  ///< the body rests from there on, and no pose has readings from there on

    friend bool operator==(const PoseCapture&, const PoseCapture&) = default;
};

struct PoseCaptureOptions {
    /// How long the body has to rest; what it read during that time is averaged.
    std::chrono::milliseconds rest{800};
    bool isAutomatic = true;

    [[nodiscard]] bool validate() const { return rest.count() > 0; }
};

namespace pose_capture {

struct Start {};
struct Stop {};
/// What the newest reading says.
struct Sample {
    std::chrono::microseconds time{};
    bool isAtRest = false;
    bool isNew = false;  ///< no captured pose is like it
};
/// The operator wants this pose, new or not; refused while the body moves, has rested for less than half of
/// PoseCaptureOptions::rest, or was captured less than that ago: no reading counts twice.
struct CaptureNow {
    std::chrono::microseconds time{};
};

using Event = std::variant<Start, Stop, Sample, CaptureNow>;

/// The mean of all readings from there to now is a pose.
struct Capture {
    std::chrono::microseconds from{};
    friend bool operator==(const Capture&, const Capture&) = default;
};
/// The operator asked for a pose, and there is none.
struct Refuse {
    friend bool operator==(const Refuse&, const Refuse&) = default;
};

using Effect = std::variant<Capture, Refuse>;

}  // namespace pose_capture

/// Throws std::logic_error where options are out of range.
[[nodiscard]] Stepped<PoseCapture, pose_capture::Effect> step(const PoseCapture& state,
                                                              const pose_capture::Event& event,
                                                              const PoseCaptureOptions& options = {});

}  // namespace skincal
