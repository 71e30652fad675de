#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

struct SensorSite {
    std::string kind;  ///< "proximity", "force", …
    Vector3d position = Vector3d::Zero();
};

/// One shape of module, in the module frame: origin in the middle of the board, z out of the skin, metres.
struct ModuleTemplate {
    std::string name;
    std::vector<Vector2d> outline;          ///< the board's edge, counter-clockwise
    Vector3d led = Vector3d::Zero();        ///< the LED's light centre
    std::vector<Vector3d> ports;            ///< to the link point, half the gap between neighbours included
    std::optional<Vector3d> accelerometer;  ///< place of the accelerometer, where known
    std::vector<SensorSite> sensors;

    /// Radius of the circle about the origin that holds the ports; a scale for tolerances, m.
    [[nodiscard]] double portRadius() const;
};

/// The paper's cell: half-port vectors (±12, ±7, 0) mm, LED at (7.9, 0, 0) mm, pitch 27.785 mm.
[[nodiscard]] ModuleTemplate paperHexagon();
/// A triangle of 27.7 mm edges with a port in the middle of each edge.
[[nodiscard]] ModuleTemplate triangleTemplate();
/// A rectangle of 30 by 20 mm with a port in the middle of each edge.
[[nodiscard]] ModuleTemplate rectangleTemplate();

}  // namespace skincal
