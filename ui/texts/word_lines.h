#pragma once

#include <QString>
#include <vector>

#include "core/vision/word_reading.h"

namespace skincal {

/// A part of a word that was sent, and what was received of it: two lines to stand below each other.
struct WordLines {
    QString sent;
    QString received;
};

/// As bits, at most `width` in a line; where LEDs are lit one at a time, the numbers of the few pictures in which
/// something was.
[[nodiscard]] std::vector<WordLines> linesOf(const WordReading& reading, int width);

}  // namespace skincal
