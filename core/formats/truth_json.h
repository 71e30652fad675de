#pragma once

#include <filesystem>
#include <string_view>
#include <tl/expected.hpp>

#include "core/formats/file_error.h"
#include "core/simulation/truth.h"

namespace skincal {

/// truth.json as it lies beside simulated recordings: modules with R (row by row) and t in the body frame, views
/// likewise, pixels as [view, module, x, y].
[[nodiscard]] tl::expected<Truth, FileError> parseTruthJson(std::string_view text, const std::filesystem::path& file);
[[nodiscard]] tl::expected<Truth, FileError> readTruth(const std::filesystem::path& file);
[[nodiscard]] tl::expected<void, FileError> writeTruth(const Truth& truth, const std::filesystem::path& file);

}  // namespace skincal
