#include "core/formats/file_error.h"

#include <algorithm>

namespace skincal {
namespace {

constexpr std::size_t kMaxPart = 400;

std::string shown(std::string text) {
    if (text.size() > kMaxPart) {
        std::size_t end = kMaxPart;
        // Not within a character of several bytes.
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
            --end;
        text = text.substr(0, end) + "…";
    }
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
    return text;
}

}  // namespace

std::string FileError::message() const {
    // The path was given by the caller and is never cut.
    std::string text = file.string();
    if (!place.empty())
        text += ": " + shown(place);
    return text + ": " + shown(problem);
}

}  // namespace skincal
