#pragma once

#include <fmt/format.h>

#include <string>

namespace skincal {

/// A number that every YAML parser takes for one: Python's asks for a point before the exponent, and OpenCV's in all
/// that is not an integer.
[[nodiscard]] inline std::string yamlNumber(double value) {
    std::string text = fmt::format("{}", value);
    if (text.find('.') == std::string::npos) {
        const std::size_t exponent = text.find('e');
        text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
    }
    return text;
}

}  // namespace skincal
