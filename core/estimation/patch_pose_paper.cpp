#include <opencv2/calib3d.hpp>
#include <stdexcept>

#include "core/estimation/pose_scene.h"

namespace skincal {

tl::expected<PatchPose, CalibrationError> estimatePatchPosePaper(std::span<const LedCorrespondence> leds,
                                                                 const CameraModel& camera,
                                                                 const PaperPoseOptions& options) {
    if (!options.validate())
        throw std::logic_error("PaperPoseOptions out of range");
    if (leds.size() < static_cast<std::size_t>(options.minLeds))
        return tl::unexpected(CalibrationError{
            ErrorCode::TooFewPoints,
            {{"found", static_cast<double>(leds.size())}, {"needed", static_cast<double>(options.minLeds)}}});
    const PoseScene scene(leds, camera);
    std::vector<cv::Point3d> object;
    std::vector<cv::Point2d> image;
    for (std::size_t i = 0; i < leds.size(); ++i) {
        object.push_back(toCv(leds[i].led_o));
        image.emplace_back(scene.normalised[i].x() * scene.focal, scene.normalised[i].y() * scene.focal);
    }
    const cv::Matx33d K(scene.focal, 0, 0, 0, scene.focal, 0, 0, 0, 1);
    cv::Mat rvec;
    cv::Mat tvec;
    std::vector<int> inliers;
    bool ok = false;
    try {
        ok = cv::solvePnPRansac(object, image, K, cv::noArray(), rvec, tvec, false, options.iterations,
                                static_cast<float>(options.reprojectionError_px), options.confidence, inliers,
                                cv::SOLVEPNP_EPNP);
    } catch (const cv::Exception&) {
        ok = false;  // OpenCV throws where its sample was degenerate
    }
    if (!ok || static_cast<int>(inliers.size()) < options.minInliers)
        return tl::unexpected(CalibrationError{
            ErrorCode::NoConsensus,
            {{"inliers", static_cast<double>(inliers.size())}, {"needed", static_cast<double>(options.minInliers)}}});
    PatchPose pose;
    pose.T_v_o = toPose(rvec, tvec);
    if (!isRigid(pose.T_v_o))
        return tl::unexpected(CalibrationError{ErrorCode::NoConsensus, {}});
    pose.inliers.assign(leds.size(), false);
    double sum = 0;
    for (const int i : inliers) {
        pose.inliers[static_cast<std::size_t>(i)] = true;
        const double r = scene.residual(pose.T_v_o, static_cast<std::size_t>(i));
        sum += r * r;
    }
    pose.rms_px = std::sqrt(sum / static_cast<double>(inliers.size()));
    pose.cost = pose.rms_px * pose.rms_px;
    return pose;
}

}  // namespace skincal
