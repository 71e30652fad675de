#pragma once

#include "core/formats/recording.h"
#include "core/simulation/world.h"
#include "core/workflow/calibrate.h"

namespace skincal {

/// What hardware would have recorded in a simulated world: readings, and per view frames or detections.
[[nodiscard]] Recording recordingOf(const World& world);

/// Pictures of a simulated world, drawn when asked for.
[[nodiscard]] RecordingFrameLoader framesOf(const World& world, const Recording& recording);

/// Writes a simulated recording with its pictures.
[[nodiscard]] tl::expected<void, FileError> writeSimulation(const World& world, const std::filesystem::path& directory,
                                                            bool overwrite, const RunContext& context = {});

}  // namespace skincal
