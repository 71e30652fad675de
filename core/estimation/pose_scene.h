#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "core/estimation/patch_pose.h"

namespace skincal {

/// Correspondences of a patch in normalised image coordinates: lens distortion is dealt with once, by our own model.
struct PoseScene {
    std::vector<LedCorrespondence> leds;
    std::vector<Vector2d> normalised;
    double focal = 1;

    PoseScene(std::span<const LedCorrespondence> correspondences, const CameraModel& camera);

    [[nodiscard]] std::size_t size() const { return leds.size(); }
    /// Of LEDs, each with all its alternatives counted once.
    [[nodiscard]] std::size_t ledCount() const;
    /// Residual in px (of an undistorted picture with the same focal length); infinite behind the camera.
    [[nodiscard]] double residual(const Isometry3d& T_v_o, std::size_t i) const;
};

/// Inliers, rms and cost of a pose; of an LED's alternatives the nearest counts.
void score(const PoseScene& scene, const PatchPoseOptions& options, PatchPose& pose);

/// Levenberg-Marquardt on the inliers, which are chosen anew after every few steps; gives the covariance, too.
void refine(const PoseScene& scene, const PatchPoseOptions& options, PatchPose& pose);

/// Seen from behind, a patch would hide its own LEDs.
[[nodiscard]] bool facesCamera(const PoseScene& scene, const PatchPose& pose);

[[nodiscard]] cv::Point3d toCv(const Vector3d& p);
[[nodiscard]] Isometry3d toPose(const cv::Mat& rvec, const cv::Mat& tvec);

}  // namespace skincal
