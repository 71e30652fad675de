#pragma once

#include <QPointF>
#include <optional>
#include <vector>

#include "core/geometry/ids.h"

namespace skincal {

/// A module, and where it is drawn.
struct ModulePlace {
    ModuleId module;
    QPointF at;  ///< px, y down
};

/// Where a key leads to in a drawing of modules: arrows to the nearest in their direction, Page Up and Page Down to the
/// one before and after by number, Home and End to the first and the last. The first time any of them leads to
/// the first. Nothing for other keys, and where there are no modules.
/// @param current  where the keys are; it stays where nothing lies in the direction.
[[nodiscard]] std::optional<ModuleId> moduleByKey(int key, std::vector<ModulePlace> places,
                                                  std::optional<ModuleId> current);

}  // namespace skincal
