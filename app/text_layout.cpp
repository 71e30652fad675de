#include "app/text_layout.h"

#include <algorithm>

namespace skincal {
namespace {

constexpr std::size_t kColumns = 100;

}  // namespace

std::size_t columnsOf(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string wrapped(const std::string& lead, const std::string& text) {
    const std::size_t indent = columnsOf(lead);
    std::string lines = lead;
    std::size_t column = indent;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        begin = end + 1;
        if (word.empty())
            continue;
        if (column > indent && column + 1 + columnsOf(word) > kColumns) {
            lines += "\n" + std::string(indent, ' ');
            column = indent;
        }
        lines += (column > indent ? " " : "") + word;
        column += (column > indent ? 1 : 0) + columnsOf(word);
    }
    return lines + "\n";
}

}  // namespace skincal
