#pragma once

#include <span>
#include <tl/expected.hpp>

#include "core/adjustment/gravity_table.h"
#include "core/geometry/error.h"
#include "core/geometry/se3.h"

namespace skincal {

struct RelativeRotationOptions {
    /// Gravity must change direction by at least this much between some two poses: below it the turn about gravity is
    /// only as good as noise divided by its sine.
    double minSpread_rad = 5.0 * kDegree;
    int minPoses = 2;  ///< the paper's P

    [[nodiscard]] bool validate() const { return minSpread_rad > 0 && minSpread_rad < 1.5 && minPoses >= 2; }
};

struct RelativeRotation {
    Matrix3d R_c_n = Matrix3d::Identity();
    double residual_rms = 0;  ///< of the rotated vectors, m/s^2
    double spread_rad = 0;    ///< how far apart the gravity directions are, see gravitySpread
};

/// Rotation that takes gravity from module n to module c (paper, eq. 7-8).
/// Minimises sum_p |R_c_n * g_n[p] - g_c[p]|^2 over SO(3) by SVD.
/// @param g_c, g_n  same poses in the same order, m/s^2, at least `minPoses`.
/// Fails with TooFewPoses, SizeMismatch, NotFinite, or ParallelGravity when the poses differ only by a turn about
/// gravity (opposite directions are parallel, too).
/// Ref: Schoenemann, Psychometrika 31, 1966; Kabsch, Acta Cryst. A32, 1976 (det = +1).
[[nodiscard]] tl::expected<RelativeRotation, CalibrationError> estimateRelativeRotation(
    std::span<const Vector3d> g_c, std::span<const Vector3d> g_n, const RelativeRotationOptions& options = {});

/// R_a_b of two modules from the poses that both have.
[[nodiscard]] tl::expected<RelativeRotation, CalibrationError> relativeRotation(
    const GravityTable& table, std::size_t a, std::size_t b, const RelativeRotationOptions& options = {});

/// Largest angle between any two of the lines along the given vectors, [0, 90 degrees]: opposite directions are
/// parallel. 0 for fewer than two.
[[nodiscard]] double gravitySpread(std::span<const Vector3d> g);

}  // namespace skincal
