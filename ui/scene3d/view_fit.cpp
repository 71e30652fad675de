#include "ui/scene3d/view_fit.h"

#include <vtkCamera.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace skincal {

Spectator bestSpectator(std::span<const Isometry3d> boards, const std::optional<Vector3d>& wanted, bool landscape) {
    Vector3d centre = Vector3d::Zero();
    for (const Isometry3d& board : boards)
        centre += board.translation() / static_cast<double>(boards.size());
    Vector3d from = Vector3d::Zero();
    Matrix3d spread = Matrix3d::Zero();
    for (const Isometry3d& board : boards) {
        from += board.linear().col(2);
        const Vector3d d = board.translation() - centre;
        spread += d * d.transpose();
    }
    from = from.norm() > 1e-6 ? Vector3d(from.normalized()) : Vector3d::UnitZ();
    Vector3d up = wanted.value_or(Vector3d::UnitY());
    if (std::abs(up.dot(from)) > 0.95)
        up = from.unitOrthogonal();
    const Vector3d side = up.cross(from).normalized();
    from = (from + 0.25 * side + 0.2 * up).normalized();

    const Matrix3d across = Matrix3d::Identity() - from * from.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(across * spread * across);
    const Vector3d& extent = axes.eigenvalues();
    constexpr double kLonger = 1.3;  // squared ratio of the sides from which a body has a direction
    if (extent[2] > kLonger * extent[1]) {
        const Vector3d along = axes.eigenvectors().col(2);
        const Vector3d turned = landscape ? from.cross(along) : along;
        up = turned.dot(up) < 0 ? Vector3d(-turned) : turned;
    }
    return {from, (up - up.dot(from) * from).normalized()};
}

namespace {

constexpr double kAngle_deg = 30;

}  // namespace

double fitCamera(vtkCamera& camera, const Spectator& spectator, std::span<const Vector3d> points,
                 const Vector3d& centre, const Margins& margins, double aspect) {
    const Vector3d& z = spectator.from;
    const Vector3d x = spectator.up.cross(z).normalized();
    const Vector3d y = z.cross(x);

    // A point is in the picture where x - c <= (d - z) right and c - x <= (d - z) left, with the spectator at c, d:
    // d right + c >= max(x + z right) and d left - c >= max(z left - x); the same for top and bottom.
    const double half = std::tan(0.5 * kAngle_deg * kDegree);
    struct Side {
        double more = 0, less = 0;  // tangents of the angles that are free on either side of the axis
        double a = -1e300, b = -1e300;
    };
    std::array<Side, 2> sides{Side{half * aspect * (1 - 2 * margins.right), half * aspect * (1 - 2 * margins.left)},
                              Side{half * (1 - 2 * margins.top), half * (1 - 2 * margins.bottom)}};
    const auto include = [&](const Vector3d& p) {
        const Vector3d q(p.dot(x), p.dot(y), p.dot(z));
        for (int i = 0; i < 2; ++i) {
            Side& s = sides.at(static_cast<std::size_t>(i));
            s.a = std::max(s.a, q[i] + q.z() * s.more);
            s.b = std::max(s.b, q.z() * s.less - q[i]);
        }
    };
    for (const Vector3d& p : points)
        include(p);
    if (points.empty())
        include(Vector3d::Zero());
    double distance = -1e300;
    for (const Side& s : sides)
        distance = std::max(distance, (s.a + s.b) / (s.more + s.less));
    Vector3d place(0, 0, distance);
    for (int i = 0; i < 2; ++i) {
        const Side& s = sides.at(static_cast<std::size_t>(i));
        place[i] = 0.5 * ((s.a - distance * s.more) + (distance * s.less - s.b));
    }
    const Vector3d eye = place.x() * x + place.y() * y + place.z() * z;
    const double depth = std::max(0.02, distance - centre.dot(z));
    const Vector3d focus = eye - depth * z;
    camera.SetViewAngle(kAngle_deg);
    camera.SetFocalPoint(focus.x(), focus.y(), focus.z());
    camera.SetPosition(eye.x(), eye.y(), eye.z());
    camera.SetViewUp(spectator.up.x(), spectator.up.y(), spectator.up.z());
    return 2 * depth * half;
}

void fitAbout(vtkCamera& camera, const Spectator& spectator, std::span<const Vector3d> points, const Vector3d& centre,
              const Margins& margins, double aspect) {
    const Vector3d& z = spectator.from;
    const Vector3d x = spectator.up.cross(z).normalized();
    const Vector3d y = z.cross(x);
    const double half = std::tan(0.5 * kAngle_deg * kDegree);
    const double wide = half * aspect * (1 - margins.left - margins.right);
    const double high = half * (1 - margins.top - margins.bottom);
    double distance = 0.02;
    for (const Vector3d& p : points) {
        const Vector3d d = p - centre;
        distance = std::max(distance, d.dot(z) + std::max(std::abs(d.dot(x)) / wide, std::abs(d.dot(y)) / high));
    }
    const Vector3d eye = centre + distance * z;
    camera.SetViewAngle(kAngle_deg);
    camera.SetFocalPoint(centre.x(), centre.y(), centre.z());
    camera.SetPosition(eye.x(), eye.y(), eye.z());
    camera.SetViewUp(spectator.up.x(), spectator.up.y(), spectator.up.z());
    camera.SetWindowCenter(margins.right - margins.left, margins.top - margins.bottom);
}

}  // namespace skincal
