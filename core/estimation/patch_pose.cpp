#include "core/estimation/patch_pose.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

#include "core/estimation/pose_scene.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

/// Principal axes of the LEDs: rms extents in rising order, and the directions.
struct PrincipalAxes {
    Vector3d centre = Vector3d::Zero();
    Vector3d extent = Vector3d::Zero();  ///< m
    Matrix3d axes = Matrix3d::Identity();
};

PrincipalAxes principalAxes(const PoseScene& scene) {
    const auto n = static_cast<double>(scene.size());
    PrincipalAxes result;
    for (const LedCorrespondence& led : scene.leds)
        result.centre += led.led_o / n;
    Matrix3d spread = Matrix3d::Zero();
    for (const LedCorrespondence& led : scene.leds)
        spread += (led.led_o - result.centre) * (led.led_o - result.centre).transpose() / n;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(spread);
    result.extent = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    result.axes = solver.eigenvectors();
    return result;
}

/// The other pose that a flat patch may have: its mean normal mirrored about the line of sight.
PatchPose mirrored(const PrincipalAxes& shape, const PatchPose& pose) {
    const Vector3d normal_v = pose.T_v_o.linear() * shape.axes.col(0);
    const Vector3d centre_v = pose.T_v_o * shape.centre;
    const Vector3d sight = centre_v.normalized();
    const Vector3d mirrored_v = 2 * normal_v.dot(sight) * sight - normal_v;
    const Matrix3d turn = Quaterniond::FromTwoVectors(normal_v, mirrored_v).toRotationMatrix();
    PatchPose other;
    other.T_v_o.linear() = turn * pose.T_v_o.linear();
    other.T_v_o.translation() = centre_v - other.T_v_o.linear() * shape.centre;
    return other;
}

std::vector<std::array<std::size_t, 3>> triples(std::size_t n, int limit) {
    std::vector<std::array<std::size_t, 3>> all;
    if (n * (n - 1) * (n - 2) / 6 <= static_cast<std::size_t>(limit)) {
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = i + 1; j < n; ++j) {
                for (std::size_t k = j + 1; k < n; ++k)
                    all.push_back({i, j, k});
            }
        }
        return all;
    }
    Random random(n, "patch pose triples");
    while (all.size() < static_cast<std::size_t>(limit)) {
        const std::array<std::size_t, 3> t{random.index(n), random.index(n), random.index(n)};
        if (t[0] != t[1] && t[1] != t[2] && t[0] != t[2])
            all.push_back(t);
    }
    return all;
}

/// The poses that three LEDs allow.
std::vector<Isometry3d> minimalPoses(const PoseScene& scene, const std::array<std::size_t, 3>& triple) {
    const auto& [i, j, k] = triple;
    const Vector3d a = scene.leds[j].led_o - scene.leds[i].led_o;
    const Vector3d b = scene.leds[k].led_o - scene.leds[i].led_o;
    const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
    if (a.cross(b).norm() < 0.01 * longest * longest)
        return {};
    std::vector<cv::Point3d> object;
    std::vector<cv::Point2d> image;
    for (const std::size_t index : triple) {
        object.push_back(toCv(scene.leds[index].led_o));
        image.emplace_back(scene.normalised[index].x(), scene.normalised[index].y());
    }
    std::vector<cv::Mat> rvecs;
    std::vector<cv::Mat> tvecs;
    try {
        cv::solveP3P(object, image, cv::Matx33d::eye(), cv::noArray(), rvecs, tvecs, cv::SOLVEPNP_AP3P);
    } catch (const cv::Exception&) {
        return {};  // OpenCV throws where its sample was degenerate
    }
    std::vector<Isometry3d> poses;
    for (std::size_t s = 0; s < rvecs.size(); ++s) {
        const Isometry3d T = toPose(rvecs[s], tvecs[s]);
        if (T.matrix().allFinite() && T.translation().z() > 0)
            poses.push_back(T);
    }
    return poses;
}

/// Whether two poses take different pixels for more than a quarter of the LEDs that both explain.
bool differInPixels(const PoseScene& scene, const PatchPose& a, const PatchPose& b) {
    std::size_t both = 0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < scene.size();) {
        bool inA = false;
        bool inB = false;
        bool same = false;
        const std::size_t first = i;
        for (; i < scene.size() && (i == first || scene.leds[i].isAlternative); ++i) {
            inA = inA || a.inliers[i];
            inB = inB || b.inliers[i];
            same = same || (a.inliers[i] && b.inliers[i]);
        }
        both += inA && inB ? 1 : 0;
        different += inA && inB && !same ? 1 : 0;
    }
    return 4 * different > both;
}

/// Keeps the best of those that are nearer to each other than `distinct`, and take the same pixels.
void keepDistinct(const PoseScene& scene, std::vector<PatchPose>& poses, double distinct, std::size_t limit) {
    std::stable_sort(poses.begin(), poses.end(), [](const auto& x, const auto& y) { return x.cost < y.cost; });
    std::vector<PatchPose> kept;
    for (const PatchPose& pose : poses) {
        const bool known = std::any_of(kept.begin(), kept.end(), [&](const PatchPose& other) {
            return poseDifference(pose.T_v_o, other.T_v_o).angle < distinct && !differInPixels(scene, pose, other);
        });
        if (!known && kept.size() < limit)
            kept.push_back(pose);
    }
    poses = std::move(kept);
}

}  // namespace

std::size_t PatchPose::inlierCount() const {
    return static_cast<std::size_t>(std::count(inliers.begin(), inliers.end(), true));
}

bool PatchPoseOptions::validate() const {
    return minInliers >= 4 && minInlierShare >= 0 && minInlierShare <= 1 && shapeSigma > 0 && maxResidualSigmas > 0 &&
           maxResidual_px > 0 && maxSamples > 0 && minWidthSigmas >= 0 && distinctAngle_rad > 0 && maxCostRatio >= 1 &&
           maxCandidates > 0;
}

tl::expected<std::vector<PatchPose>, CalibrationError> estimatePatchPoses(std::span<const LedCorrespondence> leds,
                                                                          const CameraModel& camera,
                                                                          const PatchPoseOptions& options) {
    if (!options.validate())
        throw std::logic_error("PatchPoseOptions out of range");
    const PoseScene scene(leds, camera);
    if (scene.ledCount() < static_cast<std::size_t>(options.minInliers))
        return tl::unexpected(CalibrationError{
            ErrorCode::TooFewPoints,
            {{"found", static_cast<double>(scene.ledCount())}, {"needed", static_cast<double>(options.minInliers)}}});
    const PrincipalAxes shape = principalAxes(scene);
    if (shape.extent[1] < options.minWidthSigmas * options.shapeSigma)
        return tl::unexpected(CalibrationError{ErrorCode::DegeneratePoints, {}});

    const bool hasAlternatives = scene.ledCount() < scene.size();
    std::vector<PatchPose> poses;
    for (const auto& triple : triples(scene.size(), options.maxSamples)) {
        for (const Isometry3d& T : minimalPoses(scene, triple)) {
            PatchPose pose;
            pose.T_v_o = T;
            score(scene, options, pose);
            // A patch's mirror image is explained from behind, and may be the better seen of the two.
            if (!hasAlternatives || facesCamera(scene, pose))
                poses.push_back(std::move(pose));
        }
    }
    // Minimal poses are rough: several are worth refining before the best are chosen.
    keepDistinct(scene, poses, 0.5 * options.distinctAngle_rad, 12);
    for (PatchPose& pose : poses)
        refine(scene, options, pose);
    const std::size_t refined = poses.size();
    for (std::size_t i = 0; i < refined; ++i) {
        PatchPose other = mirrored(shape, poses[i]);
        refine(scene, options, other);
        poses.push_back(std::move(other));
    }
    const double needed = std::max(static_cast<double>(options.minInliers),
                                   std::ceil(options.minInlierShare * static_cast<double>(scene.ledCount())));
    std::erase_if(poses, [&](const PatchPose& pose) {
        return static_cast<double>(pose.inlierCount()) < needed || !facesCamera(scene, pose) || !isRigid(pose.T_v_o) ||
               !pose.covariance.allFinite();
    });
    keepDistinct(scene, poses, options.distinctAngle_rad, static_cast<std::size_t>(options.maxCandidates));
    if (poses.empty())
        return tl::unexpected(CalibrationError{ErrorCode::NoConsensus, {{"needed", needed}}});
    const double worst = options.maxCostRatio * poses.front().cost + 1.0;
    std::erase_if(poses, [&](const PatchPose& pose) { return pose.cost > worst; });
    return poses;
}

}  // namespace skincal
