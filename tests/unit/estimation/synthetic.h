#pragma once

#include <optional>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/adjustment/measurements.h"
#include "core/estimation/patch_pose.h"
#include "core/estimation/skin_layout.h"
#include "core/geometry/random.h"

namespace skincal {

/// A patch whose link points meet exactly, bent or not: rows of modules on the sides of a prism whose axis is y.
struct PrismPatch {
    int columns = 3;
    int rows = 3;
    double radius = 0;  ///< m, of the prism's inscribed circle; 0 for a flat patch
    Isometry3d T_r_s = Isometry3d::Identity();
    bool rectangles = false;  ///< else the paper's hexagons
    bool ring = false;        ///< rectangles all round, first and last column linked; sets the radius
};

struct SyntheticOptions {
    std::vector<PrismPatch> patches{PrismPatch{}};
    int poses = 12;
    int views = 4;
    double distance = 0.5;           ///< m from a camera to what it looks at
    double viewTilt = 35 * kDegree;  ///< how far cameras stand off the body's normal, at most
    double accelerometerNoise = 0;   ///< m/s^2
    double bias = 0;                 ///< m/s^2, standard deviation per axis
    double scale = 0;                ///< standard deviation about 1 per axis
    double pixelNoise = 0;
    double outliers = 0;  ///< share of detections that are 40 to 200 px off
    bool distorted = true;
};

/// What was measured, and what really is. The frame r is the world's own.
struct SyntheticWorld {
    Measurements measurements;
    std::vector<Isometry3d> T_r_u;                         ///< per module
    std::vector<std::size_t> patchOf;                      ///< per module
    std::vector<Isometry3d> T_r_v;                         ///< per view
    std::vector<Vector3d> up_r;                            ///< per pose
    std::vector<AccelerometerCalibration> accelerometers;  ///< per module
    std::vector<std::pair<std::size_t, ModuleId>> outliers;

    /// The true state in the form of the adjustment, all modules in one gravity group.
    [[nodiscard]] BodyState state() const;
    /// Measurements of the true shape, one gravity group. Refers to this world and to `gravity`.
    [[nodiscard]] AdjustmentInput input(const GravityTable& gravity) const;
};

[[nodiscard]] CameraModel syntheticCamera(bool distorted);
/// A camera at `position` that looks at `target`, turned about its axis by `roll`.
[[nodiscard]] Isometry3d lookAt(const Vector3d& position, const Vector3d& target, double roll = 0);
[[nodiscard]] SyntheticWorld makeWorld(Random& random, const SyntheticOptions& options);

/// One view of `world` more (or anew): what a camera at T_r_v sees of the modules for which `wanted` is true.
[[nodiscard]] ViewDetections seenFrom(const SyntheticWorld& world, const Isometry3d& T_r_v,
                                      const std::vector<bool>& wanted = {});

/// LEDs of a patch of `count` modules, flat or bent to a radius, in its own frame.
[[nodiscard]] std::vector<LedCorrespondence> patchLeds(std::size_t count, double radius);

/// Largest differences between two bodies that share their frame.
[[nodiscard]] PoseDifference largestDifference(const std::vector<std::optional<Isometry3d>>& found,
                                               const std::vector<Isometry3d>& truth);

/// A pose turned and moved a little.
[[nodiscard]] Isometry3d perturbed(Random& random, const Isometry3d& T, double angle, double distance);

}  // namespace skincal
