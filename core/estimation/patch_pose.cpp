#include "core/estimation/patch_pose.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <stdexcept>

#include "core/geometry/random.h"

namespace skincal {
namespace {

cv::Point3d toCv(const Vector3d& p) {
    return {p.x(), p.y(), p.z()};
}

Isometry3d toPose(const cv::Mat& rvec, const cv::Mat& tvec) {
    const Vector3d w(rvec.at<double>(0), rvec.at<double>(1), rvec.at<double>(2));
    return makeIsometry(so3Exp(w), Vector3d(tvec.at<double>(0), tvec.at<double>(1), tvec.at<double>(2)));
}

/// The correspondences in normalised image coordinates: lens distortion is dealt with once, by our own model.
struct Scene {
    std::vector<LedCorrespondence> leds;
    std::vector<Vector2d> normalised;
    double focal = 1;

    [[nodiscard]] std::size_t size() const { return leds.size(); }

    /// Residual in px (of an undistorted picture with the same focal length); infinite behind the camera.
    [[nodiscard]] double residual(const Isometry3d& T_v_o, std::size_t i) const {
        const Vector3d p = T_v_o * leds[i].led_o;
        if (p.z() < 1e-3)
            return std::numeric_limits<double>::infinity();
        return focal * (p.head<2>() / p.z() - normalised[i]).norm();
    }
};

Scene makeScene(std::span<const LedCorrespondence> leds, const CameraModel& camera) {
    Scene scene;
    scene.leds.assign(leds.begin(), leds.end());
    scene.focal = 0.5 * (camera.fx + camera.fy);
    for (const LedCorrespondence& led : leds)
        scene.normalised.push_back(camera.unproject(led.pixel));
    return scene;
}

double inlierLimit(const Scene& scene, const Isometry3d& T_v_o, std::size_t i, const PatchPoseOptions& options) {
    const double depth = std::max(1e-3, (T_v_o * scene.leds[i].led_o).z());
    const double shape_px = options.shapeSigma * scene.focal / depth;
    return std::min(options.maxResidual_px,
                    options.maxResidualSigmas * std::hypot(shape_px, scene.leds[i].sigma_px) + 0.5);
}

void score(const Scene& scene, const PatchPoseOptions& options, PatchPose& pose) {
    pose.inliers.assign(scene.size(), false);
    double cost = 0;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        const double limit = inlierLimit(scene, pose.T_v_o, i, options);
        const double r = scene.residual(pose.T_v_o, i);
        cost += std::min(r * r, limit * limit);
        if (r < limit) {
            pose.inliers[i] = true;
            sum += r * r;
            ++count;
        }
    }
    pose.cost = cost / static_cast<double>(scene.size());
    pose.rms_px = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

/// Seen from behind, a patch would hide its own LEDs.
bool facesCamera(const Scene& scene, const PatchPose& pose) {
    double facing = 0;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        if (pose.inliers[i])
            facing -=
                (pose.T_v_o.linear() * scene.leds[i].normal_o).dot((pose.T_v_o * scene.leds[i].led_o).normalized());
    }
    return facing > 0;
}

/// Normal equations of the inliers' pixels about a pose, left perturbation: p_v + w x p_v + dt (about the camera).
void linearise(const Scene& scene, const PatchPose& pose, double shapeSigma, Matrix6d& H, Vector6d& g) {
    H.setZero();
    g.setZero();
    for (std::size_t i = 0; i < scene.size(); ++i) {
        if (!pose.inliers[i])
            continue;
        const Vector3d p = pose.T_v_o * scene.leds[i].led_o;
        if (p.z() < 1e-3)
            continue;
        Eigen::Matrix<double, 2, 3> P;
        P << 1 / p.z(), 0, -p.x() / (p.z() * p.z()), 0, 1 / p.z(), -p.y() / (p.z() * p.z());
        Eigen::Matrix<double, 2, 6> J;
        J.leftCols<3>() = -P * skew(p);
        J.rightCols<3>() = P;
        const Vector2d r = p.head<2>() / p.z() - scene.normalised[i];
        const double sigma = std::hypot(scene.leds[i].sigma_px / scene.focal, shapeSigma / p.z());
        H += J.transpose() * J / (sigma * sigma);
        g += J.transpose() * r / (sigma * sigma);
    }
}

/// Levenberg-Marquardt on the inliers, which are chosen anew after every few steps.
void refine(const Scene& scene, const PatchPoseOptions& options, PatchPose& pose) {
    score(scene, options, pose);
    double lambda = 1e-4;
    for (int step = 0; step < 30; ++step) {
        Matrix6d H;
        Vector6d g;
        linearise(scene, pose, options.shapeSigma, H, g);
        Matrix6d damped = H;
        damped.diagonal() += lambda * H.diagonal() + Vector6d::Constant(1e-12);
        const Vector6d d = -damped.ldlt().solve(g);
        constexpr double kNothing = 1e-9;  // rad and m: another step would find no less
        if (!d.allFinite() || d.norm() < kNothing)
            break;
        PatchPose next;
        const Matrix3d dR = so3Exp(d.head<3>());
        next.T_v_o = makeIsometry(dR * pose.T_v_o.linear(), dR * pose.T_v_o.translation() + d.tail<3>());
        score(scene, options, next);
        if (next.cost <= pose.cost) {
            const bool done = pose.cost - next.cost < 1e-10 * (1 + pose.cost);
            pose = next;
            lambda = std::max(1e-9, lambda * 0.2);
            if (done)
                break;
        } else {
            lambda *= 10;
            if (lambda > 1e6)
                break;
        }
    }
    Matrix6d H;
    Vector6d g;
    linearise(scene, pose, options.shapeSigma, H, g);
    pose.covariance = (H + 1e-6 * Matrix6d::Identity()).inverse();
}

/// Principal axes of the LEDs: rms extents in rising order, and the directions.
struct PrincipalAxes {
    Vector3d centre = Vector3d::Zero();
    Vector3d extent = Vector3d::Zero();  ///< m
    Matrix3d axes = Matrix3d::Identity();
};

PrincipalAxes principalAxes(const Scene& scene) {
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
std::vector<Isometry3d> minimalPoses(const Scene& scene, const std::array<std::size_t, 3>& triple) {
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

/// Keeps the best of those that are nearer to each other than `distinct`.
void keepDistinct(std::vector<PatchPose>& poses, double distinct, std::size_t limit) {
    std::stable_sort(poses.begin(), poses.end(), [](const auto& x, const auto& y) { return x.cost < y.cost; });
    std::vector<PatchPose> kept;
    for (const PatchPose& pose : poses) {
        const bool known = std::any_of(kept.begin(), kept.end(), [&](const PatchPose& other) {
            return poseDifference(pose.T_v_o, other.T_v_o).angle < distinct;
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

tl::expected<PatchPose, CalibrationError> estimatePatchPosePaper(std::span<const LedCorrespondence> leds,
                                                                 const CameraModel& camera,
                                                                 const PaperPoseOptions& options) {
    if (!options.validate())
        throw std::logic_error("PaperPoseOptions out of range");
    if (leds.size() < static_cast<std::size_t>(options.minLeds))
        return tl::unexpected(CalibrationError{
            ErrorCode::TooFewPoints,
            {{"found", static_cast<double>(leds.size())}, {"needed", static_cast<double>(options.minLeds)}}});
    const Scene scene = makeScene(leds, camera);
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

tl::expected<std::vector<PatchPose>, CalibrationError> estimatePatchPoses(std::span<const LedCorrespondence> leds,
                                                                          const CameraModel& camera,
                                                                          const PatchPoseOptions& options) {
    if (!options.validate())
        throw std::logic_error("PatchPoseOptions out of range");
    if (leds.size() < static_cast<std::size_t>(options.minInliers))
        return tl::unexpected(CalibrationError{
            ErrorCode::TooFewPoints,
            {{"found", static_cast<double>(leds.size())}, {"needed", static_cast<double>(options.minInliers)}}});
    const Scene scene = makeScene(leds, camera);
    const PrincipalAxes shape = principalAxes(scene);
    if (shape.extent[1] < options.minWidthSigmas * options.shapeSigma)
        return tl::unexpected(CalibrationError{ErrorCode::DegeneratePoints, {}});

    std::vector<PatchPose> poses;
    for (const auto& triple : triples(scene.size(), options.maxSamples)) {
        for (const Isometry3d& T : minimalPoses(scene, triple)) {
            PatchPose pose;
            pose.T_v_o = T;
            score(scene, options, pose);
            poses.push_back(std::move(pose));
        }
    }
    // Minimal poses are rough: several are worth refining before the best are chosen.
    keepDistinct(poses, 0.5 * options.distinctAngle_rad, 12);
    for (PatchPose& pose : poses)
        refine(scene, options, pose);
    const std::size_t refined = poses.size();
    for (std::size_t i = 0; i < refined; ++i) {
        PatchPose other = mirrored(shape, poses[i]);
        refine(scene, options, other);
        poses.push_back(std::move(other));
    }
    const double needed = std::max(static_cast<double>(options.minInliers),
                                   std::ceil(options.minInlierShare * static_cast<double>(scene.size())));
    std::erase_if(poses, [&](const PatchPose& pose) {
        return static_cast<double>(pose.inlierCount()) < needed || !facesCamera(scene, pose) || !isRigid(pose.T_v_o) ||
               !pose.covariance.allFinite();
    });
    keepDistinct(poses, options.distinctAngle_rad, static_cast<std::size_t>(options.maxCandidates));
    if (poses.empty())
        return tl::unexpected(CalibrationError{ErrorCode::NoConsensus, {{"needed", needed}}});
    const double worst = options.maxCostRatio * poses.front().cost + 1.0;
    std::erase_if(poses, [&](const PatchPose& pose) { return pose.cost > worst; });
    return poses;
}

}  // namespace skincal
