#pragma once

#include <vector>

#include "core/simulation/world.h"

namespace skincal {

/// Flat polygons that are drawn together, the farthest group first.
struct PolygonGroup {
    struct Polygon {
        std::vector<Vector3d> corners;  ///< camera frame
        double brightness = 1;          ///< 1 is the mean of the picture
    };
    double depth = 0;  ///< m
    std::vector<Polygon> polygons;
};

/// Boards, the tubes and plates they are mounted on, and cards, as they are lit and in the order in which they are to
/// be drawn over each other. What is seen from behind is left out.
/// @param T_v_r  from the body into the camera's frame
[[nodiscard]] std::vector<PolygonGroup> bodyPolygons(const World& world, const Isometry3d& T_v_r);

}  // namespace skincal
