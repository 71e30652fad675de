#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/rig/held_body.h"
#include "core/rig/touch_field.h"
#include "core/simulation/simulated_accelerometer.h"
#include "core/simulation/world.h"

namespace skincal {

/// What the modules of a rig's skin measure: accelerometers with the errors that they were made with, on a body that
/// moves, and touch with a little noise.
class RigSenses {
  public:
    using Time = std::chrono::microseconds;

    struct Touch {
        double proximity = 0;           ///< 0 nothing near, 1 touching
        std::array<double, 3> force{};  ///< N, 0 where the template has fewer sensors
        double temperature = 0;         ///< degrees Celsius
    };

    explicit RigSenses(std::shared_ptr<const World> world);

    /// One reading, m/s^2, module frame.
    [[nodiscard]] Vector3d acceleration(std::size_t module, const BodyForces& forces, Random& chance) const;
    /// Lets the skin feel a contact until then.
    void feel(const std::optional<Contact>& contact, Time time);
    /// As it was felt last.
    [[nodiscard]] Touch touch(std::size_t module, Random& chance) const;

  private:
    std::shared_ptr<const World> world_;
    std::vector<SimulatedAccelerometer> accelerometers_;
    TouchField touch_;
    std::optional<Time> feltAt_;
};

}  // namespace skincal
