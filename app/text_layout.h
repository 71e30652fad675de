#pragma once

#include <string>

namespace skincal {

/// Columns that `text` takes on a terminal, UTF-8, one for each character.
[[nodiscard]] std::size_t columnsOf(std::string_view text);

/// `lead` and `text` as lines at most 100 columns wide, broken between words; further lines begin below the first word.
[[nodiscard]] std::string wrapped(const std::string& lead, const std::string& text);

}  // namespace skincal
