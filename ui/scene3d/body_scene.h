#pragma once

#include <vtkSmartPointer.h>

#include <array>
#include <optional>

#include "core/estimation/body_model.h"
#include "ui/scene3d/view_fit.h"

class vtkPolyData;
class vtkRenderer;

namespace skincal {

/// Colours of patches, told apart by people who see red and green alike; repeats after eight.
[[nodiscard]] std::array<double, 3> patchColour(PatchId patch);

/// The boards of all placed modules as polygons with a colour per patch (cell scalars), body frame, m.
[[nodiscard]] vtkSmartPointer<vtkPolyData> boardsOf(const BodyModel& body);

/// Their LEDs as small spheres.
[[nodiscard]] vtkSmartPointer<vtkPolyData> ledsOf(const BodyModel& body);

/// Outlines of the cameras that saw the body: pyramids as wide as the picture.
[[nodiscard]] vtkSmartPointer<vtkPolyData> camerasOf(const BodyModel& body, double size);

/// Puts a body into a renderer: boards, edges, LEDs, cameras.
void addBody(vtkRenderer& renderer, const BodyModel& body);

/// What points up for the first camera that has a pose, body frame.
[[nodiscard]] std::optional<Vector3d> firstCameraUp(const BodyModel& body);

/// Turns the camera to where the boards face and as near as all of them stay inside the margins.
/// @param aspect  width over height of the picture.
/// @return how much of the world the picture is high at the body's distance, m.
double lookAtBody(vtkRenderer& renderer, const BodyModel& body, const Margins& margins, double aspect);

}  // namespace skincal
