#pragma once

#include "core/rig/simulated_rig.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Puts a simulated rig's skin and camera among what can be chosen, and lends its hands. The rig must outlive the
/// workbench.
void offerRig(Workbench& workbench, SimulatedRig& rig);

}  // namespace skincal
