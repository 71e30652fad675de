#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/procedure/light_stream.h"
#include "core/procedure/light_timing.h"
#include "core/procedure/machine.h"

namespace skincal {

/// One scan of one view: for each of a list of lit sets, a picture of it.
///
/// Where all LEDs go off and on in the list anyway, they are first made to do that three times, at different times
/// within the camera's period, and what the camera sees of it tells how long light takes to show (LightTiming). Then
/// patterns follow each other at the camera's rate, each lit before the one before it has been seen, and pictures are
/// told apart by their times (LightPlan); what has no picture of its own in its turn is lit again at the end. Where
/// light can't be timed, it is lit, waited for and kept, one after the other.
struct ScanRun {
    using Time = std::chrono::microseconds;

    enum class Phase {
        Idle,
        Timing,     ///< all LEDs go off and on, to see when that shows
        Streaming,  ///< at the camera's rate
        Lighting,   ///< one by one: it was commanded and not yet acknowledged
        Settling,   ///< it shows by `showsFrom`; the next picture that was exposed later is kept
        Paused,
        Decoding,  ///< all pictures are there
        Done,
        Failed,  ///< `fault` says; the pictures are of no use any more
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
    std::vector<std::size_t> left{};       ///< those that are not taken yet, ascending
    std::optional<std::uint64_t> token{};  ///< of the newest light command
    bool isAnswered = false;               ///< it was acknowledged
    int repeats = 0;                       ///< times in a row that nothing came of a light command
    Time showsFrom{};
    Fault fault = Fault::None;  ///< in Phase::Failed

    bool isTimed = false;                ///< light is being timed, or was
    int timings = 0;                     ///< how often it was begun
    bool keepsTime = false;              ///< the skin lights at a given time
    std::vector<LightToggle> toggles{};  ///< the last one under way; their shares are changes while it is
    Time slowest{};  ///< toggle, from its command to the picture that was sure to show it; 0: there was none yet
    std::optional<LightTiming> timing{};  ///< once it is known; also where it is of no use
    std::optional<LightPlan> plan{};      ///< where it is of use
    std::vector<LightShow> shows{};       ///< those that a picture may still show
    std::vector<std::size_t> queue{};     ///< frames that are to be lit yet, or again
    std::optional<Time> newest{};         ///< picture, by its own time
    Time newestCame{};                    ///< when it came
    int misses = 0;                       ///< shows in a row that no picture was kept of

    [[nodiscard]] bool isRunning() const { return phase >= Phase::Timing && phase <= Phase::Settling; }
    [[nodiscard]] std::size_t taken() const { return frames - left.size(); }
    friend bool operator==(const ScanRun&, const ScanRun&) = default;
};

struct ScanRunOptions {
    LightTimingOptions timing{};
    /// Least light, as lightChange() has it, that a toggle of all LEDs must change.
    double leastChange = 500;
    /// From the command of a toggle on: no camera is later.
    std::chrono::milliseconds toggleShows{700};
    /// Before the first toggle, for what was lit earlier; toggleShows where that was not enough.
    std::chrono::milliseconds dark{250};
    int maxTimings = 3;
    /// A skin must know this long beforehand what to light at a given time.
    std::chrono::milliseconds lead{8};
    /// Shows in a row without a picture, from which on they are lit one by one.
    int maxMisses = 10;

    /// One by one, from the acknowledgement of a light command to the exposure that certainly shows it, at least: as
    /// long as toggles took, and toggleShows where none ever told. A camera that is later than believed gives every
    /// picture to the pattern after its own, and nothing in them says so.
    std::chrono::milliseconds settle{100};
    std::chrono::milliseconds lightAnswers{500};
    /// From then to the picture at the latest.
    std::chrono::milliseconds pictureComes{1000};
    /// What did not answer, skin or camera, gets as many chances more, each from the light command on.
    int maxRepeats = 3;

    [[nodiscard]] bool validate() const {
        return timing.validate() && leastChange > 0 && toggleShows.count() > 0 && dark.count() >= 0 && maxTimings > 0 &&
               lead.count() >= 0 && maxMisses > 0 && settle.count() >= 0 && lightAnswers.count() > 0 &&
               pictureComes.count() > 0 && maxRepeats >= 0;
    }
};

namespace scan_run {

using Time = ScanRun::Time;

/// By which light can be timed.
enum class Toggles {
    None,       ///< light is not timed
    AtOnce,     ///< frame 0 is dark, and all LEDs of the scan are lit in frame 1
    GivenTime,  ///< the same, and the skin lights at a given time
};

struct Start {
    std::size_t frames = 0;
    Toggles toggles = Toggles::None;
    Time slowest{};  ///< ScanRun::slowest of an earlier scan with this camera, 0 where there was none
};
/// What SkinDevice::light returned for the effect Light.
struct LightCommanded {
    std::uint64_t token = 0;
    Time now{};  ///< just before it was commanded, of the clock that pictures carry
};
struct LightShown {
    std::uint64_t token = 0;
    Time now{};  ///< of the clock that pictures carry
};
struct PictureTaken {
    Time time{};        ///< of the beginning of its exposure, as the camera has it
    Time now{};         ///< when it came
    double change = 0;  ///< lightChange() since the reference; in Phase::Timing
};
/// In Phase::Decoding: what there is does not do, and so many more are to be taken. Those that were stay.
struct Extend {
    std::size_t frames = 0;
};
struct Pause {};
struct Resume {};
struct Cancel {};   ///< in Done and Failed: it has been seen
struct Decoded {};  ///< of the newest Decode
struct Failed {
    ScanRun::Fault fault = ScanRun::Fault::None;
};
struct TimedOut {};

using Event = std::variant<Start, Extend, LightCommanded, LightShown, PictureTaken, Pause, Resume, Cancel, Decoded,
                           Failed, TimedOut>;

struct Light {
    std::size_t frame = 0;
    std::optional<Time> at{};  ///< at once where there is none
    friend bool operator==(const Light&, const Light&) = default;
};
/// The picture that has just come is what later ones are compared with.
struct TakeReference {
    friend bool operator==(const TakeReference&, const TakeReference&) = default;
};
/// The picture that has just come is that of this frame. Frames are not kept in order; one may be kept again.
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

using Effect = std::variant<Light, TakeReference, KeepPicture, LightsOff, Decode, Discard, StartTimer, StopTimer>;

}  // namespace scan_run

/// Throws std::logic_error where options are out of range.
[[nodiscard]] Stepped<ScanRun, scan_run::Effect> step(const ScanRun& state, const scan_run::Event& event,
                                                      const ScanRunOptions& options = {});

}  // namespace skincal
