#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/estimation/body_model.h"
#include "core/workflow/calibrate.h"

namespace skincal {

/// kDone where every module is placed and the body may be trusted; kDataDoNotSuffice where any is not, there is none,
/// or the verdict is "not to be trusted".
[[nodiscard]] int exitCodeOf(const BodyModel& body);

/// Prints why there is no body; the exit code.
int reportFailure(const CalibrateError& error);

/// A complaint where `output` can't be written, or is one of `inputs`, which writing it would destroy. Asked before
/// computing, so that nobody waits for a result that has no place to go.
[[nodiscard]] std::optional<std::string> complaintAboutOutput(const std::filesystem::path& output,
                                                              const std::vector<std::filesystem::path>& inputs = {});

/// A complaint where there is such a file already. What took long to measure or to compute, recordings and body models,
/// is replaced only where --force is given; what follows from a body model in a moment is replaced without a word.
[[nodiscard]] std::optional<std::string> complaintAboutExisting(const std::filesystem::path& output);

/// The files of a recording, for complaintAboutOutput.
[[nodiscard]] std::vector<std::filesystem::path> pathsOf(const std::filesystem::path& directory,
                                                         const Recording& recording);

}  // namespace skincal
