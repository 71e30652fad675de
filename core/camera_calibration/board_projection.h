#pragma once

#include <ceres/rotation.h>

#include <array>
#include <opencv2/core/types.hpp>

#include "core/vision/camera_model.h"

namespace skincal {

/// fx, fy, cx, cy and up to eight coefficients in the model's order; what the model lacks stays 0.
inline constexpr int kIntrinsics = 12;
using Intrinsics = std::array<double, kIntrinsics>;

[[nodiscard]] inline Intrinsics intrinsicsOf(const CameraModel& camera) {
    Intrinsics result{camera.fx, camera.fy, camera.cx, camera.cy};
    std::copy(camera.distortion.begin(), camera.distortion.end(), result.begin() + 4);
    return result;
}

[[nodiscard]] inline CameraModel modelOf(const Intrinsics& values, DistortionModel model, cv::Size size) {
    const auto begin = values.begin() + 4;
    return {size.width, size.height,
            values[0],  values[1],
            values[2],  values[3],
            model,      std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(coefficientCount(model)))};
}

/// Predicted minus measured pixel of a board's corner, with derivatives for the intrinsics too: distort() of
/// camera_model.h holds these fixed. Equations as there.
class CornerResidual {
  public:
    CornerResidual(DistortionModel model, const Vector3d& p_b, const Vector2d& pixel)
        : model_(model), p_b_(p_b), pixel_(pixel) {}

    template <class T>
    bool operator()(const T* k, const T* pose, T* residual) const {
        using std::atan;
        using std::sqrt;
        const T p_b[3] = {T(p_b_.x()), T(p_b_.y()), T(p_b_.z())};
        T p[3];
        ceres::AngleAxisRotatePoint(pose, p_b, p);
        for (int i = 0; i < 3; ++i)
            p[i] += pose[3 + i];
        // A step that takes a corner behind the camera is refused.
        if (!(p[2] > 1e-6))
            return false;
        const T x = p[0] / p[2];
        const T y = p[1] / p[2];
        const T r2 = x * x + y * y;
        const T* c = k + 4;
        T u = x;
        T v = y;
        if (model_ == DistortionModel::Equidistant) {
            if (r2 > 1e-16) {
                const T r = sqrt(r2);
                const T a = atan(r);
                const T a2 = a * a;
                const T scale = a * (1.0 + a2 * (c[0] + a2 * (c[1] + a2 * (c[2] + a2 * c[3])))) / r;
                u = x * scale;
                v = y * scale;
            }
        } else {
            const T radial =
                (1.0 + r2 * (c[0] + r2 * (c[1] + r2 * c[4]))) / (1.0 + r2 * (c[5] + r2 * (c[6] + r2 * c[7])));
            u = x * radial + 2.0 * c[2] * x * y + c[3] * (r2 + 2.0 * x * x);
            v = y * radial + c[2] * (r2 + 2.0 * y * y) + 2.0 * c[3] * x * y;
        }
        residual[0] = k[0] * u + k[2] - pixel_.x();
        residual[1] = k[1] * v + k[3] - pixel_.y();
        return true;
    }

  private:
    DistortionModel model_;
    Vector3d p_b_;
    Vector2d pixel_;
};

}  // namespace skincal
