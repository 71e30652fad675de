#include "core/rig/held_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/rig/glide.h"

namespace skincal {
namespace {

/// A place as an operator thinks of it.
struct Place {
    double x, y;  ///< 0 where the paper touches the left or upper edge of the picture, 1 the right or lower one
    double size;  ///< root of the share of the picture that the squares take
    double turn_deg, tilt_deg, roll_deg;
};

constexpr std::array<Place, 20> kPlaces{{
    {0.5, 0.5, 0.50, 0, 0, 0},      {0.5, 0.5, 0.48, 30, 0, 0},      {0.5, 0.5, 0.48, -30, 0, 5},
    {0.5, 0.5, 0.48, 0, 30, 0},     {0.5, 0.5, 0.48, 0, -30, -5},    {0.0, 0.0, 0.40, 20, 15, 10},
    {1.0, 0.0, 0.40, -20, 15, -10}, {1.0, 1.0, 0.40, -20, -15, 10},  {0.0, 1.0, 0.40, 20, -15, -10},
    {0.0, 0.5, 0.44, -25, 10, 12},  {1.0, 0.5, 0.44, 25, -10, -12},  {0.5, 0.0, 0.42, 10, -25, 0},
    {0.5, 1.0, 0.42, -10, 25, 0},   {0.5, 0.5, 0.80, 0, 0, 0},       {0.2, 0.5, 0.64, 25, 10, 0},
    {0.8, 0.5, 0.64, -25, -10, 0},  {0.3, 0.3, 0.31, 15, 25, 20},    {0.7, 0.7, 0.31, -15, -25, -20},
    {0.25, 0.15, 0.52, -35, 15, 5}, {0.75, 0.85, 0.52, 35, -15, -5},
}};

constexpr double kMargin_px = 4;

struct Extent {
    Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
    Vector2d high = -low;
};

/// Of the paper's outline in the picture. The lens bends its edges: points along them count, too.
Extent extentOf(const BoardPlan& plan, const CameraModel& camera, const Isometry3d& T_v_m) {
    constexpr int kSteps = 6;
    Extent extent;
    const double w = 0.5 * plan.width() + HeldBoard::kPaper * plan.square;
    const double h = 0.5 * plan.height() + HeldBoard::kPaper * plan.square;
    for (int i = 0; i <= kSteps; ++i) {
        const double t = 2.0 * i / kSteps - 1;
        for (const Vector3d& p :
             {Vector3d(t * w, -h, 0), Vector3d(t * w, h, 0), Vector3d(-w, t * h, 0), Vector3d(w, t * h, 0)}) {
            if (const auto pixel = camera.project(T_v_m * p)) {
                extent.low = extent.low.cwiseMin(*pixel);
                extent.high = extent.high.cwiseMax(*pixel);
            }
        }
    }
    return extent;
}

Isometry3d poseOf(const Place& place, const BoardPlan& plan, const CameraModel& camera) {
    const bool isAcross = (plan.width() < plan.height()) != (camera.width < camera.height);
    const Matrix3d R = so3Exp({0, -place.turn_deg * kDegree, 0}) * so3Exp({place.tilt_deg * kDegree, 0, 0}) *
                       so3Exp({0, 0, (place.roll_deg + (isAcross ? 90 : 0)) * kDegree});
    const Vector2d size(camera.width, camera.height);
    const Vector2d margin = Vector2d::Constant(kMargin_px);
    double depth = std::sqrt(plan.width() * plan.height() * camera.fx * camera.fy / (size.x() * size.y())) / place.size;
    Vector2d middle = 0.5 * size;
    Isometry3d T_v_m = Isometry3d::Identity();
    // Where the paper's edges come to lie follows from pose and lens: a few steps there.
    for (int step = 0; step < 8; ++step) {
        const Vector2d ray = camera.unproject(middle);
        T_v_m = makeIsometry(R, depth * ray.homogeneous());
        const Extent extent = extentOf(plan, camera, T_v_m);
        const Vector2d free = size - 2 * margin - (extent.high - extent.low);
        if (free.minCoeff() < 0) {
            depth *= 1.02 * ((extent.high - extent.low).cwiseQuotient(size - 2 * margin)).maxCoeff();
            continue;
        }
        middle += margin + free.cwiseProduct(Vector2d(place.x, place.y)) - extent.low;
    }
    return T_v_m;
}

}  // namespace

HeldBoard::HeldBoard(const BoardPlan& plan, const CameraModel& camera, Time start) : plan_(plan), start_(start) {
    if (!plan.validate())
        throw std::logic_error("HeldBoard: no board to hold");
    for (const Place& place : kPlaces)
        T_v_m_.push_back(poseOf(place, plan, camera));
}

Isometry3d HeldBoard::pose(Time time) const {
    using Seconds = std::chrono::duration<double>;
    const Time passed = std::max(Time(0), time - start_);
    const Time each = kStill + kMove;
    const auto place = static_cast<std::size_t>(passed / each) % T_v_m_.size();
    const Isometry3d& from = T_v_m_[place];
    const Isometry3d& to = T_v_m_[(place + 1) % T_v_m_.size()];
    const double way = glideAt(Seconds(passed % each - kStill).count(), Seconds(kMove).count()).way;
    const Vector3d turn = so3Log(from.linear().transpose() * to.linear());
    const Isometry3d T_v_m =
        makeIsometry(from.linear() * so3Exp(way * turn), (1 - way) * from.translation() + way * to.translation());
    return T_v_m * makeIsometry(Matrix3d::Identity(), Vector3d(-0.5 * plan_.width(), -0.5 * plan_.height(), 0));
}

bool HeldBoard::isStill(Time time) const {
    return std::max(Time(0), time - start_) % (kStill + kMove) <= kStill;
}

}  // namespace skincal
