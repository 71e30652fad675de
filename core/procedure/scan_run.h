#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/procedure/machine.h"

namespace skincal {

/// One scan of one view: for each of a list of lit sets, light it, wait until it shows, keep a picture.
struct ScanRun {
    enum class Phase {
        Idle,
        Lighting,  ///< frame `next` was commanded and not yet acknowledged
        Settling,  ///< it shows by `showsFrom`; the next picture that was exposed later is kept
        Paused,
        Decoding,  ///< all pictures are there
        Done,
        Failed,  ///< `fault` says; what was kept is thrown away
    };
    /// Why a scan was broken off; the window has a sentence for each.
    enum class Fault {
        None,
        SkinSilent,    ///< it does not answer to light commands
        CameraSilent,  ///< it gives no pictures
        SkinGone,
        OtherSkin,
        OtherCamera,
        CameraFailed,  ///< it said so, in words of its own
        NotDecoded,    ///< the pictures don't tell who is where
    };
    Phase phase = Phase::Idle;
    std::size_t frames = 0;                ///< how many there are to take
    std::size_t next = 0;                  ///< the one being taken
    std::optional<std::uint64_t> token{};  ///< of the light command that is waited for
    int repeats = 0;                       ///< times that this frame's light was commanded in vain
    std::chrono::microseconds showsFrom{};
    Fault fault = Fault::None;  ///< in Phase::Failed

    [[nodiscard]] bool isRunning() const { return phase == Phase::Lighting || phase == Phase::Settling; }
    friend bool operator==(const ScanRun&, const ScanRun&) = default;
};

struct ScanRunOptions {
    /// From the acknowledgement of a light command to the exposure that certainly shows it.
    std::chrono::milliseconds settle{100};
    std::chrono::milliseconds lightAnswers{500};
    /// From then to the picture at the latest.
    std::chrono::milliseconds pictureComes{1000};
    /// What did not answer, skin or camera, gets as many chances more, each from the light command on.
    int maxRepeats = 3;

    [[nodiscard]] bool validate() const {
        return settle.count() >= 0 && lightAnswers.count() > 0 && pictureComes.count() > 0 && maxRepeats >= 0;
    }
};

namespace scan_run {

struct Start {
    std::size_t frames = 0;
};
/// What SkinDevice::light returned for the effect Light.
struct LightCommanded {
    std::uint64_t token = 0;
};
struct LightShown {
    std::uint64_t token = 0;
    std::chrono::microseconds now{};  ///< of the clock that pictures carry
};
struct PictureTaken {
    std::chrono::microseconds time{};  ///< of the beginning of its exposure
};
struct Pause {};
struct Resume {};
struct Cancel {};   ///< in Done and Failed: it has been seen
struct Decoded {};  ///< of the newest Decode
struct Failed {
    ScanRun::Fault fault = ScanRun::Fault::None;
};
struct TimedOut {};

using Event =
    std::variant<Start, LightCommanded, LightShown, PictureTaken, Pause, Resume, Cancel, Decoded, Failed, TimedOut>;

struct Light {
    std::size_t frame = 0;
    friend bool operator==(const Light&, const Light&) = default;
};
/// The picture that has just come is that of this frame.
struct KeepPicture {
    std::size_t frame = 0;
    friend bool operator==(const KeepPicture&, const KeepPicture&) = default;
};
struct LightsOff {
    friend bool operator==(const LightsOff&, const LightsOff&) = default;
};
struct Decode {
    friend bool operator==(const Decode&, const Decode&) = default;
};
/// Pictures and decoding are of no use any more.
struct Discard {
    friend bool operator==(const Discard&, const Discard&) = default;
};

using Effect = std::variant<Light, KeepPicture, LightsOff, Decode, Discard, StartTimer, StopTimer>;

}  // namespace scan_run

/// Throws std::logic_error where options are out of range.
[[nodiscard]] Stepped<ScanRun, scan_run::Effect> step(const ScanRun& state, const scan_run::Event& event,
                                                      const ScanRunOptions& options = {});

}  // namespace skincal
