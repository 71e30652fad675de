#pragma once

#include <filesystem>
#include <tl/expected.hpp>
#include <vector>

#include "core/formats/file_error.h"
#include "core/skin/module_template.h"

namespace skincal {

/// Those that come with the program, and those of files; a file's takes the place of one of the same name.
[[nodiscard]] tl::expected<std::vector<ModuleTemplate>, FileError> knownTemplates(
    const std::vector<std::filesystem::path>& files);

}  // namespace skincal
