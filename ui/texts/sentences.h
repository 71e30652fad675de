#pragma once

#include <QString>

#include "core/geometry/sentence.h"

namespace skincal {

/// A sentence of core in the language of the window. It begins in lower case, for it may stand behind a colon.
[[nodiscard]] QString said(const Sentence& sentence);

/// The same by itself: it begins with a capital.
[[nodiscard]] QString saidAlone(const Sentence& sentence);

/// With a capital, where it begins with a word: "ttyUSB0", "tcp://host:1", "lens.yaml:" and other names stay as they
/// are, for with a capital they are others.
[[nodiscard]] QString capitalised(QString text);

}  // namespace skincal
