#pragma once

#include <vtkSmartPointer.h>

#include <span>

#include "ui/scene3d/scene_layout.h"

class vtkPolyData;

namespace skincal {

/// Ellipsoids of three standard deviations of position about the middle of each placed module that has a covariance,
/// times `scale`, body frame, m: with `scale` 1 the true place lies inside in 97 % of cases.
/// Needles and discs, which distances seen from one side only give, are drawn 1.6 mm thick at least, to be seen at all.
/// @param limit  at most so many: those of the largest standard deviations.
[[nodiscard]] vtkSmartPointer<vtkPolyData> ellipsoidsOf(const BodyModel& body, double scale, std::size_t limit);

/// A camera's pyramid as a closed surface: apex at the lens, base as wide as the picture `size` in front of it.
[[nodiscard]] vtkSmartPointer<vtkPolyData> pyramidOf(const Isometry3d& T_s_v, double size);

/// An arrow as a surface.
/// @param direction  of any length but zero.
[[nodiscard]] vtkSmartPointer<vtkPolyData> arrowOf(const Vector3d& from, const Vector3d& direction, double length);

/// Something that presses on the skin.
struct ContactMark {
    Vector3d point_s = Vector3d::Zero();    ///< scene, which for placed modules is the body frame, m
    Vector3d normal_s = Vector3d::UnitZ();  ///< out of the skin, of any length but zero
    double length = 0;                      ///< of its arrow, m
};

/// Arrows that stand on the skin, their tips where it is touched, along the normal.
[[nodiscard]] vtkSmartPointer<vtkPolyData> contactArrows(std::span<const ContactMark> contacts);

}  // namespace skincal
