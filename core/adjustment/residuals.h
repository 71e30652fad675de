#pragma once

/// The measurement equations, each once, as Ceres cost functors (automatic derivatives). Every residual is divided by
/// its standard deviation, so that half the sum of squares is the negative log likelihood up to a constant.
/// Poses are blocks of a unit quaternion (Eigen order x y z w, rotation into the body frame) and a translation (m).

#include <ceres/rotation.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/geometry/se3.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// Pixel of module u's LED in view v:  z = project(T_r_v^-1 * T_r_u * led) + noise.
struct LedPixelResidual {
    const CameraModel* camera;
    Vector2d pixel;
    Vector3d led_u;
    double weight;  ///< 1 / sigma, 1/px

    template <class T>
    bool operator()(const T* q_r_u, const T* t_r_u, const T* q_r_v, const T* t_r_v, T* residual) const {
        using Vector3 = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Eigen::Quaternion<T>> R_r_u(q_r_u);
        const Eigen::Map<const Eigen::Quaternion<T>> R_r_v(q_r_v);
        const Vector3 p_r = R_r_u * led_u.cast<T>() + Eigen::Map<const Vector3>(t_r_u);
        const Vector3 p_v = R_r_v.conjugate() * (p_r - Eigen::Map<const Vector3>(t_r_v));
        // A point at or behind the camera has no pixel: the step that led there is refused.
        if (p_v.z() < T(1e-3))
            return false;
        const Eigen::Matrix<T, 2, 1> predicted = projectPoint<T>(*camera, p_v);
        residual[0] = weight * (predicted.x() - pixel.x());
        residual[1] = weight * (predicted.y() - pixel.y());
        return true;
    }
};

/// Accelerometer of module u at rest in pose p:  a = scale * (M g R_r_u^T up_r_p) + bias + noise, axis by axis. M turns
/// by the rotation vector `misalignment`; where there is none the chip sits square on its board.
struct GravityResidual {
    Vector3d acceleration;
    double gravity;  ///< |g|, m/s^2
    double weight;   ///< 1 / sigma, s^2/m

    template <class T>
    bool operator()(const T* q_r_u, const T* up_r, const T* bias, const T* scale, T* residual) const {
        using Vector3 = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Eigen::Quaternion<T>> R_r_u(q_r_u);
        const Vector3 a_u = R_r_u.conjugate() * (Eigen::Map<const Vector3>(up_r) * T(gravity));
        for (int i = 0; i < 3; ++i)
            residual[i] = weight * (scale[i] * a_u[i] + bias[i] - acceleration[i]);
        return true;
    }
    template <class T>
    bool operator()(const T* q_r_u, const T* up_r, const T* bias, const T* scale, const T* misalignment,
                    T* residual) const {
        using Vector3 = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Eigen::Quaternion<T>> R_r_u(q_r_u);
        const Vector3 a_u = R_r_u.conjugate() * (Eigen::Map<const Vector3>(up_r) * T(gravity));
        Vector3 a_c;
        ceres::AngleAxisRotatePoint(misalignment, a_u.data(), a_c.data());
        for (int i = 0; i < 3; ++i)
            residual[i] = weight * (scale[i] * a_c[i] + bias[i] - acceleration[i]);
        return true;
    }
};

/// Link points of neighbours coincide:  T_r_a p_a = T_r_b p_b + play (paper, eq. 2).
struct LinkResidual {
    Vector3d port_a;
    Vector3d port_b;
    double weight;  ///< 1 / sigma, 1/m

    template <class T>
    bool operator()(const T* q_r_a, const T* t_r_a, const T* q_r_b, const T* t_r_b, T* residual) const {
        using Vector3 = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Eigen::Quaternion<T>> R_r_a(q_r_a);
        const Eigen::Map<const Eigen::Quaternion<T>> R_r_b(q_r_b);
        const Vector3 gap = R_r_a * port_a.cast<T>() + Eigen::Map<const Vector3>(t_r_a) - R_r_b * port_b.cast<T>() -
                            Eigen::Map<const Vector3>(t_r_b);
        for (int i = 0; i < 3; ++i)
            residual[i] = weight * gap[i];
        return true;
    }
};

/// Three numbers near an expected value: the prior on an accelerometer's bias, scale or misalignment.
struct PriorResidual {
    Vector3d expected;
    double weight;

    template <class T>
    bool operator()(const T* value, T* residual) const {
        for (int i = 0; i < 3; ++i)
            residual[i] = weight * (value[i] - expected[i]);
        return true;
    }
};

}  // namespace skincal
