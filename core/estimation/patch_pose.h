#pragma once

#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "core/geometry/error.h"
#include "core/geometry/se3.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// One LED of a patch with the pixel at which it was seen.
struct LedCorrespondence {
    Vector3d led_o = Vector3d::Zero();      ///< in the patch's frame, m
    Vector3d normal_o = Vector3d::UnitZ();  ///< out of the skin there: an LED is seen from its front only
    Vector2d pixel = Vector2d::Zero();
    double sigma_px = 0.1;
    bool isAlternative = false;  ///< another pixel of the LED right before it: at most one of them shows it
};

struct PaperPoseOptions {
    int iterations = 100;  ///< of RANSAC
    double reprojectionError_px = 8.0;
    int minLeds = 6;  ///< N
    int minInliers = 6;
    double confidence = 0.99;  ///< at which RANSAC stops early; OpenCV's default, the paper says nothing

    [[nodiscard]] bool validate() const {
        return iterations > 0 && reprojectionError_px > 0 && minLeds >= 4 && minInliers >= 4 && confidence > 0 &&
               confidence < 1;
    }
};

struct PatchPose {
    Isometry3d T_v_o = Isometry3d::Identity();
    std::vector<bool> inliers;  ///< per correspondence
    double rms_px = 0;          ///< over the inliers
    /// Mean of min(|residual|, limit)^2 over all LEDs, px^2; the paper's has only the inliers' in it.
    double cost = 0;
    /// Rotation vector (left, camera frame) then translation, rad and m; the paper's method gives none.
    Matrix6d covariance = Matrix6d::Identity();

    [[nodiscard]] std::size_t inlierCount() const;
};

/// The paper's pose of a patch (eq. 14): OpenCV's solvePnPRansac with EPnP and its constants. At least 6 LEDs.
/// Weak on flat patches: EPnP as OpenCV has it can be off by hundreds of mm there.
/// Fails with TooFewPoints or NoConsensus.
[[nodiscard]] tl::expected<PatchPose, CalibrationError> estimatePatchPosePaper(std::span<const LedCorrespondence> leds,
                                                                               const CameraModel& camera,
                                                                               const PaperPoseOptions& options = {});

struct PatchPoseOptions {
    int minInliers = 4;
    double minInlierShare = 0.5;
    /// How far a LED may lie from where the patch's shape says, m: shapes from gravity alone are that uncertain.
    double shapeSigma = 0.7e-3;
    double maxResidualSigmas = 4.0;          ///< inlier limit, in sigmas of shape and detection together
    double maxResidual_px = 12.0;            ///< never beyond this
    int maxSamples = 400;                    ///< of three LEDs each; all triples where there are no more
    double distinctAngle_rad = 8 * kDegree;  ///< candidates nearer than this are one
    /// LEDs whose distances from a line are less than this many shape sigmas (rms) have no pose.
    double minWidthSigmas = 3.0;
    double maxCostRatio = 9.0;  ///< candidates worse than the best by more than this are dropped
    int maxCandidates = 2;

    [[nodiscard]] bool validate() const;
};

/// Every pose that explains the image of a patch about equally well, best first: one for a bent patch, two for a flat
/// one (its normal mirrored about the line of sight). Which of them is true is for the rest of the data to decide.
/// Works on planes: minimal solutions from three LEDs (P3P), consensus with outliers, refined on the inliers, and the
/// mirrored pose tried for each. Of an LED's alternative pixels the nearest counts; shares and costs are those of LEDs.
/// Deterministic.
/// Fails with TooFewPoints, DegeneratePoints (LEDs on a line) or NoConsensus.
/// Ref: Fischler and Bolles 1981 (RANSAC); Ke and Roumeliotis, CVPR 2017 (AP3P); Collins and Bartoli, IJCV 2014 (the
/// two poses of a plane).
[[nodiscard]] tl::expected<std::vector<PatchPose>, CalibrationError> estimatePatchPoses(
    std::span<const LedCorrespondence> leds, const CameraModel& camera, const PatchPoseOptions& options = {});

}  // namespace skincal
