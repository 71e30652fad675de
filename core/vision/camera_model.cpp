#include "core/vision/camera_model.h"

#include <array>
#include <cmath>

namespace skincal {
namespace {

struct DistortionName {
    DistortionModel model;
    std::string_view text;
    std::size_t coefficients;
};

constexpr std::array<DistortionName, 3> kDistortions{{
    {DistortionModel::PlumbBob, "plumb_bob", 5},
    {DistortionModel::RationalPolynomial, "rational_polynomial", 8},
    {DistortionModel::Equidistant, "equidistant", 4},
}};

const DistortionName& entry(DistortionModel model) {
    return kDistortions.at(static_cast<std::size_t>(model));
}

}  // namespace

std::string_view name(DistortionModel model) {
    return entry(model).text;
}

std::size_t coefficientCount(DistortionModel model) {
    return entry(model).coefficients;
}

std::optional<DistortionModel> distortionModelFromName(std::string_view text) {
    for (const DistortionName& known : kDistortions) {
        if (known.text == text)
            return known.model;
    }
    return std::nullopt;
}

std::optional<Vector2d> CameraModel::project(const Vector3d& p_v) const {
    if (!(p_v.z() > 1e-3))
        return std::nullopt;
    return projectPoint<double>(*this, p_v);
}

Vector2d CameraModel::unproject(const Vector2d& pixel) const {
    Vector2d target((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
    if (distortion.empty())
        return target;
    Vector2d p = target;
    if (distortionModel == DistortionModel::Equidistant) {
        // Near 90 degrees tan() runs away from Newton; the angle itself is a far better start.
        const double r = target.norm();
        if (r > 1e-12)
            p = target * (std::tan(std::min(r, 1.5)) / r);
    }
    // Gauss-Newton with halved steps where a full one would not help: strong distortion folds back outside the picture.
    double error = (distort<double>(*this, p) - target).norm();
    for (int iteration = 0; iteration < 50 && error > 1e-13; ++iteration) {
        constexpr double kStep = 1e-7;
        Eigen::Matrix2d J;
        for (int i = 0; i < 2; ++i) {
            const Vector2d d = kStep * Vector2d::Unit(i);
            J.col(i) = (distort<double>(*this, p + d) - distort<double>(*this, p - d)) / (2 * kStep);
        }
        const Vector2d step = J.fullPivLu().solve(target - distort<double>(*this, p));
        if (!step.allFinite())
            break;
        double share = 1;
        for (; share > 1e-4; share *= 0.5) {
            const double next = (distort<double>(*this, p + share * step) - target).norm();
            if (next < error) {
                p += share * step;
                error = next;
                break;
            }
        }
        if (share <= 1e-4)
            break;
    }
    return p;
}

bool CameraModel::contains(const Vector2d& pixel) const {
    return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < width - 0.5 && pixel.y() < height - 0.5;
}

cv::Matx33d CameraModel::matrix() const {
    return {fx, 0, cx, 0, fy, cy, 0, 0, 1};
}

}  // namespace skincal
