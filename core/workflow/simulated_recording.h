#pragma once

#include "core/formats/recording.h"
#include "core/simulation/world.h"
#include "core/workflow/calibrate.h"

namespace skincal {

/// What hardware would have recorded in a simulated world: readings, and per view frames or detections.
[[nodiscard]] Recording recordingOf(const World& world);

/// Pictures of a simulated world, drawn when asked for.
[[nodiscard]] RecordingFrameLoader framesOf(const World& world, const Recording& recording);

/// Writes a simulated recording, its pictures first and recording.json last: what was cancelled or failed half-way is
/// no recording, and its pictures are taken back. Refuses a directory that holds a recording unless `overwrite`: then
/// that recording is removed before anything is written: recording.json, gravity.csv, detections.csv and the pictures
/// views/NNN/NNNNN.png or .jpg, no other file.
[[nodiscard]] tl::expected<void, FileError> writeSimulation(const World& world, const std::filesystem::path& directory,
                                                            bool overwrite, const RunContext& context = {});

}  // namespace skincal
