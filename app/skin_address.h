#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/device/line_address.h"
#include "core/skin/module_template.h"

namespace skincal {

/// A skin that a command talks to, as its user says it.
struct SkinArguments {
    std::string device;
    std::vector<std::filesystem::path> templates;  ///< files
};

struct SkinAddress {
    LineAddress line;
    std::vector<ModuleTemplate>
        templates;  ///< that come with the program, and those of files in place of the same name
};

/// The error is a sentence.
[[nodiscard]] tl::expected<SkinAddress, std::string> skinAddress(const SkinArguments& arguments);

}  // namespace skincal
