#pragma once

#include <optional>
#include <span>

#include "core/geometry/se3.h"

class vtkCamera;

namespace skincal {

/// What to keep free along the borders, as shares of the picture's width and height, each below a half.
struct Margins {
    double left = 0.03;
    double right = 0.03;
    double top = 0.04;
    double bottom = 0.04;
};

/// From where to look at a body: unit vectors towards the spectator and upwards, at right angles.
struct Spectator {
    Vector3d from = Vector3d::UnitZ();
    Vector3d up = Vector3d::UnitY();
};

/// From where most boards face, a little aside so that depth shows; turned so that the body lies along the picture's
/// longer side.
/// @param boards  poses of the modules in the scene; none gives a view along z.
/// @param up      what should rather point up, where known.
[[nodiscard]] Spectator bestSpectator(std::span<const Isometry3d> boards, const std::optional<Vector3d>& up,
                                      bool landscape);

/// Places a perspective camera as near as all points stay inside the margins.
/// @param points  m; none counts as the origin.
/// @param centre  what the camera turns about, somewhere among the points.
/// @param aspect  width over height of the picture.
/// @return how much of the world the picture is high at the centre's distance, m.
double fitCamera(vtkCamera& camera, const Spectator& spectator, std::span<const Vector3d> points,
                 const Vector3d& centre, const Margins& margins, double aspect);

/// The same for a scene that is turned by hand: `centre` is what the camera turns about and appears in the middle of
/// what the margins leave free, so that a turn leaves it there; single points come less near to the margins.
void fitAbout(vtkCamera& camera, const Spectator& spectator, std::span<const Vector3d> points, const Vector3d& centre,
              const Margins& margins, double aspect);

}  // namespace skincal
