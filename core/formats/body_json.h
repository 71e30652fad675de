#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/estimation/body_model.h"
#include "core/formats/recording.h"

namespace skincal {

/// body-model.md. The same model gives the same bytes. Numbers survive the round trip bit by bit; rotations, matrices
/// here and quaternions there, to 1e-15; an infinite condition is written as null. Beyond the page: quality.verdict and
/// quality.missing, and the status of each view.
/// @param unknownOfTypes  keys of module types that the page does not name, as JSON text (Recording::unknownOfTypes).
[[nodiscard]] std::string bodyToJson(const BodyModel& body,
                                     const std::map<std::string, UnknownKeys>& unknownOfTypes = {});
/// Reads all that the page names; quality figures, and what says who made the body, may be missing. How many modules
/// are placed is counted, not believed. Refuses, with the place, what a recording's reader would refuse too: another
/// format or a newer version, missing keys, numbers that are none, ids that are taken or unknown, types, patches and
/// ports that are not there.
[[nodiscard]] tl::expected<BodyModel, FileError> parseBodyJson(std::string_view text,
                                                               const std::filesystem::path& file);

[[nodiscard]] tl::expected<BodyModel, FileError> readBody(const std::filesystem::path& file);
[[nodiscard]] tl::expected<void, FileError> writeBody(const BodyModel& body, const std::filesystem::path& file,
                                                      const std::map<std::string, UnknownKeys>& unknownOfTypes = {});

}  // namespace skincal
