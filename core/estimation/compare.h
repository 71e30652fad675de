#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "core/geometry/error.h"
#include "core/geometry/ids.h"
#include "core/geometry/se3.h"

namespace skincal {

struct NamedPose {
    ModuleId id;
    Isometry3d T_body_module = Isometry3d::Identity();
};

struct BodyComparison {
    std::size_t compared = 0;  ///< modules that both have
    Isometry3d T_truth_body = Isometry3d::Identity();
    double positionRms = 0;  ///< m
    double positionMax = 0;
    double rotationRms = 0;  ///< rad
    double rotationMax = 0;
    ModuleId worst;  ///< module with the largest position error
};

/// Differences of module poses after the rigid alignment (no scale) that fits the positions best. With fewer than
/// three modules, or all on a line, the rotations join in to fix the alignment.
/// Fails with TooFewPoints where no module is in both.
/// Ref: Umeyama, PAMI 13, 1991.
[[nodiscard]] tl::expected<BodyComparison, CalibrationError> compareBodies(const std::vector<NamedPose>& body,
                                                                           const std::vector<NamedPose>& truth);

}  // namespace skincal
