#pragma once

#include "core/camera/frame_source.h"

namespace skincal {

/// What is wrong with a camera and what to do about it, in a sentence or two.
[[nodiscard]] QString cameraWords(const CameraFailure& failure);
/// The same for a source that just failed: its own reason where it gives no code.
[[nodiscard]] QString failureWords(const FrameSource& source, const QString& why);
/// Cameras that this user may not open, and the command that mends it; empty where there are none.
[[nodiscard]] QString forbiddenWords(const QStringList& nodes);
/// What stands still while pictures are taken and what does not; empty where nothing is known of it.
[[nodiscard]] QString controlWords(const std::vector<ControlState>& controls);
/// Whether exposure or gain may change in the midst of a scan.
[[nodiscard]] bool mayBrightnessChange(const std::vector<ControlState>& controls);
/// What that means to who scans; without a full stop.
[[nodiscard]] QString brightnessWords();
/// Pictures that were not used and why; empty where all were.
[[nodiscard]] QString refusedWords(const std::array<std::uint64_t, kFrameFaults>& refused);

}  // namespace skincal
