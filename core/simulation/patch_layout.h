#pragma once

#include <vector>

#include "core/geometry/random.h"
#include "core/simulation/scenario.h"

namespace skincal {

/// A module in the plane of a layout.
struct LaidModule {
    Vector2d position = Vector2d::Zero();
    double yaw = 0;
};

struct LaidLink {
    std::size_t a = 0;
    int a_port = 0;
    std::size_t b = 0;
    int b_port = 0;
};

/// Modules joined port to port in the plane, before they are bent onto a surface.
struct PatchLayout {
    std::vector<LaidModule> modules;
    std::vector<LaidLink> links;
};

/// Grows a patch from its middle: each new module goes to the open port whose new place is nearest to the middle,
/// `raggedness` letting chance have a say; it is turned by 0 or 180 degrees, whichever ports fit, at random. All ports
/// that meet are linked. A round patch of seven hexagons is the paper's test shape.
[[nodiscard]] PatchLayout growPatch(const ModuleTemplate& type, std::size_t modules, double raggedness, Random& random);

/// A row along x, port 0 to the port opposite to it; closed, the last is linked to the first.
[[nodiscard]] PatchLayout layStrip(const ModuleTemplate& type, std::size_t modules, bool closed);

/// Poses in the surface's frame of a layout laid onto it: each board touches the surface with its own normal; positions
/// are those that bring the link points together best (least squares). The first module stays over `offset`.
[[nodiscard]] std::vector<Isometry3d> bendOntoSurface(const PatchLayout& layout, const ModuleTemplate& type,
                                                      const PatchPlan& plan, std::uint64_t seed);

/// Points of that surface, in its own frame, over points of the layout's plane; of anything but a cylinder they have
/// the same x and y.
[[nodiscard]] std::vector<Vector3d> surfacePoints(const PatchPlan& plan, const ModuleTemplate& type, std::uint64_t seed,
                                                  const std::vector<Vector2d>& points);

}  // namespace skincal
