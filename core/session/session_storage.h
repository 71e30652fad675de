#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "core/geometry/run_context.h"
#include "core/session/session_data.h"

namespace skincal {

/// Reads a recording, or one that is only begun, and decodes its pictures, which stay in memory. The error is a
/// sentence; empty where cancelled.
[[nodiscard]] tl::expected<OpenedRecording, std::string> readSession(const std::filesystem::path& directory,
                                                                     const RunContext& context = {});

/// Writes what was measured and decided as a recording: its pictures first, recording.json last and in one go, so that
/// what is there before is whole until the new one is. A picture that is there already is not written again, and none
/// is ever overwritten: a view that was scanned anew gets another folder. Without Decisions::camera it is only begun
/// (see Completeness). The error is a sentence.
[[nodiscard]] tl::expected<void, std::string> writeSession(const Measured& measured, const Decisions& decisions,
                                                           const std::filesystem::path& directory);

/// SHA-256 of a view's pictures as they are written: what was once computed stays.
using PictureDigests = std::map<std::shared_ptr<const Pictures>, std::vector<std::string>>;

/// SHA-256 of each file that writeSession would write where there is nothing yet, by its name in the recording, so that
/// a result can be told from the very data that it follows from. Pictures are encoded for it: 20 ms each, once.
/// Nothing where cancelled, or where Decisions::camera is missing.
[[nodiscard]] std::optional<std::map<std::string, std::string>> digestSession(const Measured& measured,
                                                                              const Decisions& decisions,
                                                                              PictureDigests& known,
                                                                              const RunContext& context = {});

}  // namespace skincal
