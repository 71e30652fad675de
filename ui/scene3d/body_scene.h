#pragma once

#include <vtkSmartPointer.h>

#include <array>

#include "core/estimation/body_model.h"

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

/// Puts a body into a renderer: boards, edges, LEDs, axes of the body's patches, cameras.
void addBody(vtkRenderer& renderer, const BodyModel& body);

/// Turns the camera to where the boards face, all of them in the picture.
void lookAtBody(vtkRenderer& renderer, const BodyModel& body);

}  // namespace skincal
