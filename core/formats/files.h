#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/formats/file_error.h"
#include "core/geometry/run_context.h"

namespace skincal {

/// The whole file; refused above `maxBytes`, and where cancelled.
[[nodiscard]] tl::expected<std::string, FileError> readFile(const std::filesystem::path& file, std::size_t maxBytes,
                                                            const RunContext& context = {});

/// Where writing to `file` ends up, symbolic links followed. Refuses what is there and is no regular file (a directory,
/// a device, a pipe), and a place whose directory is missing or may not be written to: ask before a long computation.
[[nodiscard]] tl::expected<std::filesystem::path, FileError> resolveOutput(const std::filesystem::path& file);

/// True where both paths name one file, or will once it is written.
[[nodiscard]] bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Writes beside the target, flushes to the disk and renames: a reader sees the old file or the new one, whole. A
/// symbolic link stays and what it points to is written; refuses as resolveOutput does.
[[nodiscard]] tl::expected<void, FileError> writeFileAtomically(const std::filesystem::path& file,
                                                                std::string_view bytes);

/// Lower-case hexadecimal SHA-256.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// A path from inside a recording, made absolute. Refuses what is absolute, empty, or leads out of the directory, be
/// it by ".." or through a symbolic link.
[[nodiscard]] tl::expected<std::filesystem::path, std::string> resolveInside(const std::filesystem::path& directory,
                                                                             const std::string& relative);

}  // namespace skincal
