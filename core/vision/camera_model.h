#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

/// Names and coefficient orders of ROS camera_info.
enum class DistortionModel {
    PlumbBob,            ///< k1 k2 p1 p2 k3
    RationalPolynomial,  ///< k1 k2 p1 p2 k3 k4 k5 k6
    Equidistant,         ///< k1 k2 k3 k4
};

[[nodiscard]] std::string_view name(DistortionModel model);
[[nodiscard]] std::optional<DistortionModel> distortionModelFromName(std::string_view text);
[[nodiscard]] std::size_t coefficientCount(DistortionModel model);

/// A calibrated pinhole camera with lens distortion. Camera frame: x right, y down, z forward; pixel (0, 0) is the
/// centre of the top-left pixel.
///   x' = X/Z, y' = Y/Z;  (x'', y'') = distort(x', y');  u = fx x'' + cx, v = fy y'' + cy
struct CameraModel {
    int width = 0;
    int height = 0;
    double fx = 0;
    double fy = 0;
    double cx = 0;
    double cy = 0;
    DistortionModel distortionModel = DistortionModel::PlumbBob;
    std::vector<double> distortion;  ///< coefficientCount(distortionModel) numbers; empty means none

    /// Pixel of a point in the camera frame, or nothing where it lies behind the camera (z <= 1 mm).
    [[nodiscard]] std::optional<Vector2d> project(const Vector3d& p_v) const;
    /// Normalised image coordinates (x', y') of a raw pixel: Newton on the distortion model, 1e-12.
    [[nodiscard]] Vector2d unproject(const Vector2d& pixel) const;
    [[nodiscard]] bool contains(const Vector2d& pixel) const;
    /// Camera matrix as OpenCV wants it.
    [[nodiscard]] cv::Matx33d matrix() const;
};

/// Distorts normalised coordinates; templated so that automatic derivatives pass through.
template <class T>
Eigen::Matrix<T, 2, 1> distort(const CameraModel& camera, const Eigen::Matrix<T, 2, 1>& p);

/// Pixel of p_v, with derivatives; the caller sees to z > 0.
template <class T>
Eigen::Matrix<T, 2, 1> projectPoint(const CameraModel& camera, const Eigen::Matrix<T, 3, 1>& p_v) {
    const Eigen::Matrix<T, 2, 1> normalised(p_v.x() / p_v.z(), p_v.y() / p_v.z());
    const Eigen::Matrix<T, 2, 1> d = distort<T>(camera, normalised);
    return {camera.fx * d.x() + camera.cx, camera.fy * d.y() + camera.cy};
}

template <class T>
Eigen::Matrix<T, 2, 1> distort(const CameraModel& camera, const Eigen::Matrix<T, 2, 1>& p) {
    using std::atan;
    using std::sqrt;
    const auto& k = camera.distortion;
    if (k.empty())
        return p;
    const T x = p.x();
    const T y = p.y();
    const T r2 = x * x + y * y;
    if (camera.distortionModel == DistortionModel::Equidistant) {
        if (r2 < T(1e-16))
            return p;
        const T r = sqrt(r2);
        const T a = atan(r);
        const T a2 = a * a;
        const T scale = a * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3])))) / r;
        return {x * scale, y * scale};
    }
    T radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    if (camera.distortionModel == DistortionModel::RationalPolynomial)
        radial /= 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
    return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
            y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

}  // namespace skincal
