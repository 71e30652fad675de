#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/adjustment/measurements.h"
#include "core/estimation/body_model.h"
#include "core/simulation/world.h"

namespace skincal {

/// A world without views yet, from one scenario.
[[nodiscard]] World bareWorld(const std::vector<PatchPlan>& patches, std::uint64_t seed, double pixelNoise);

/// Patch plans of the paper's experiments.
[[nodiscard]] PatchPlan flatPatch(std::size_t modules);
[[nodiscard]] PatchPlan bentPatch(std::size_t modules, double radius);
/// Eight modules port to port, closed to a loop of 222.28 mm.
[[nodiscard]] PatchPlan ringOfEight();

/// Camera straight in front of the first patch's first module, `distance` away, the patch turned by `tilt` about the
/// camera's x axis.
[[nodiscard]] Isometry3d cameraBefore(const World& world, double distance, double tilt);

/// Measurements of a world whose views have been set.
[[nodiscard]] Measurements measurementsOf(const World& world);

/// Numbers computed from the poses of views and modules.
using PoseFunction =
    std::function<Eigen::VectorXd(const std::vector<Isometry3d>& T_r_v, const std::vector<Isometry3d>& T_r_u)>;

enum class BoundOn { Views, Modules };

/// Cramer-Rao bound of the covariance of such numbers, from the bound of the poses and their numerical gradient:
///   J C J^T,  C the bound of the poses of all views, or of all modules
/// The gauge is the first module. Nothing where the data do not fix it.
[[nodiscard]] std::optional<Eigen::MatrixXd> boundOf(const World& world, const Measurements& measurements,
                                                     BoundOn which, const PoseFunction& function);

/// Mean square of |v + e| - |v| for e normal with such a covariance: what the best unbiased estimate of a vector makes
/// of its length. With noise large against |v| it is far more than the linear n^T covariance n, n = v / |v|: the length
/// then grows by what is off across it. From 4,096 seeded draws; exact (the trace) where v is zero.
[[nodiscard]] double meanSquareOfLength(const Eigen::VectorXd& v, const Eigen::MatrixXd& covariance);

/// Poses of a body model in the order of world and views; nothing where any that `needed` names is missing.
struct BodyPoses {
    std::vector<Isometry3d> T_r_v;
    std::vector<Isometry3d> T_r_u;
};
[[nodiscard]] std::optional<BodyPoses> posesOf(const BodyModel& body, bool needViews);

/// Radius of the cylinder that fits points best (axis free), and the rms of their distances from it.
struct CylinderFit {
    double radius = 0;
    double rms = 0;
};
/// @param axis  a first guess of the axis' direction.
[[nodiscard]] CylinderFit fitCylinder(const std::vector<Vector3d>& points, const Vector3d& axis, double radius);

}  // namespace skincal
