#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/simulation/world.h"

namespace skincal {

/// A fingertip on the body.
struct Contact {
    Vector3d point_r = Vector3d::Zero();  ///< on the skin, body frame, m
    double force = 0;                     ///< N
};

/// What one module's touch sensors would read if they were perfect.
struct ModuleTouch {
    double proximity = 0;           ///< 0 nothing near, 1 touching
    std::array<double, 3> force{};  ///< N, of the template's force sensors in their order, 0 where it has fewer
    double temperature = 0;         ///< degrees Celsius
};

/// What all modules feel of a hand, proximity, force and warmth:
/// - proximity falls smoothly from 1 under the fingertip (8 mm) to 0 at 5 cm from the sensor, or from the middle of a
///   module whose template doesn't say where it is;
/// - force is shared among the force sensors within 15 mm of the point, by nearness: (1 - d^2 / (15 mm)^2)^2. Together
///   they bear all of it in the midst of cells, less at their edge;
/// - a touched module warms up towards the hand's 33 degrees, half-way within about 3 s, and cools down as slowly.
/// A module feels nothing that is more than 1 cm behind its board.
class TouchField {
  public:
    explicit TouchField(std::shared_ptr<const World> world);

    /// Lets `seconds` pass while the contact is as it is.
    void advance(const std::optional<Contact>& contact, double seconds);
    /// Per module, in the order of Skin::modules.
    [[nodiscard]] const std::vector<ModuleTouch>& modules() const { return modules_; }

  private:
    void feel(const Contact& contact);

    std::shared_ptr<const World> world_;
    std::vector<double> ambient_;  ///< per module, degrees Celsius
    std::vector<ModuleTouch> modules_;
};

}  // namespace skincal
