#pragma once

#include "core/rig/simulated_rig.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Where a rig's devices are among what is offered.
struct RigOffers {
    std::size_t skin = 0;
    std::size_t camera = 0;
};

/// Puts a simulated rig's skin and camera among what can be chosen, and lends its hands. The rig must outlive the
/// workbench.
RigOffers offerRig(Workbench& workbench, SimulatedRig& rig);

}  // namespace skincal
