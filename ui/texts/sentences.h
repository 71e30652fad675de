#pragma once

#include <QString>

#include "core/geometry/sentence.h"

namespace skincal {

/// A sentence of core in the language of the window. It begins in lower case, for it may stand behind a colon.
[[nodiscard]] QString said(const Sentence& sentence);

/// The same by itself: it begins with a capital.
[[nodiscard]] QString saidAlone(const Sentence& sentence);

}  // namespace skincal
