#include "core/formats/file_error.h"

#include <utility>

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
    return printable(std::move(text));
}

}  // namespace

std::string printable(std::string text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        if (byte < 0x20 || byte == 0x7F) {
            text[i] = ' ';
        } else if (byte == 0xC2 && next >= 0x80 && next < 0xA0) {
            // U+0080 to U+009F: some terminals take these for escape sequences, too.
            text.replace(i, 2, " ");
        }
    }
    return text;
}

std::string FileError::message() const {
    // Never cut: people copy it.
    std::string text = printable(file.string());
    if (!place.empty())
        text += ": " + shown(place);
    return text + ": " + shown(problem);
}

}  // namespace skincal
