#include "core/estimation/pose_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skincal {
namespace {

double inlierLimit(const PoseScene& scene, const Isometry3d& T_v_o, std::size_t i, const PatchPoseOptions& options) {
    const double depth = std::max(1e-3, (T_v_o * scene.leds[i].led_o).z());
    const double shape_px = options.shapeSigma * scene.focal / depth;
    return std::min(options.maxResidual_px,
                    options.maxResidualSigmas * std::hypot(shape_px, scene.leds[i].sigma_px) + 0.5);
}

/// Normal equations of the inliers' pixels about a pose, left perturbation: p_v + w x p_v + dt (about the camera).
void linearise(const PoseScene& scene, const PatchPose& pose, double shapeSigma, Matrix6d& H, Vector6d& g) {
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

}  // namespace

PoseScene::PoseScene(std::span<const LedCorrespondence> correspondences, const CameraModel& camera)
    : leds(correspondences.begin(), correspondences.end()), focal(0.5 * (camera.fx + camera.fy)) {
    for (const LedCorrespondence& led : leds)
        normalised.push_back(camera.unproject(led.pixel));
}

std::size_t PoseScene::ledCount() const {
    return static_cast<std::size_t>(
        std::count_if(leds.begin(), leds.end(), [](const LedCorrespondence& led) { return !led.isAlternative; }));
}

double PoseScene::residual(const Isometry3d& T_v_o, std::size_t i) const {
    const Vector3d p = T_v_o * leds[i].led_o;
    if (p.z() < 1e-3)
        return std::numeric_limits<double>::infinity();
    return focal * (p.head<2>() / p.z() - normalised[i]).norm();
}

void score(const PoseScene& scene, const PatchPoseOptions& options, PatchPose& pose) {
    pose.inliers.assign(scene.size(), false);
    double cost = 0;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < scene.size();) {
        std::size_t nearest = i;
        double r = scene.residual(pose.T_v_o, i);
        for (++i; i < scene.size() && scene.leds[i].isAlternative; ++i) {
            const double other = scene.residual(pose.T_v_o, i);
            if (other < r) {
                r = other;
                nearest = i;
            }
        }
        const double limit = inlierLimit(scene, pose.T_v_o, nearest, options);
        cost += std::min(r * r, limit * limit);
        if (r < limit) {
            pose.inliers[nearest] = true;
            sum += r * r;
            ++count;
        }
    }
    pose.cost = cost / static_cast<double>(scene.ledCount());
    pose.rms_px = count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

bool facesCamera(const PoseScene& scene, const PatchPose& pose) {
    double facing = 0;
    for (std::size_t i = 0; i < scene.size(); ++i) {
        if (pose.inliers[i])
            facing -=
                (pose.T_v_o.linear() * scene.leds[i].normal_o).dot((pose.T_v_o * scene.leds[i].led_o).normalized());
    }
    return facing > 0;
}

void refine(const PoseScene& scene, const PatchPoseOptions& options, PatchPose& pose) {
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

cv::Point3d toCv(const Vector3d& p) {
    return {p.x(), p.y(), p.z()};
}

Isometry3d toPose(const cv::Mat& rvec, const cv::Mat& tvec) {
    const Vector3d w(rvec.at<double>(0), rvec.at<double>(1), rvec.at<double>(2));
    return makeIsometry(so3Exp(w), Vector3d(tvec.at<double>(0), tvec.at<double>(1), tvec.at<double>(2)));
}

}  // namespace skincal
