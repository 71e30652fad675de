#pragma once

#include <QString>

#include "core/simulation/world.h"

namespace skincal {

/// Fails the test where an exported body (JSON) is not that of the simulated world: every module has its place.
void expectTrueBody(const QString& file, const World& world);

}  // namespace skincal
