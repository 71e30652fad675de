#include "core/rig/held_body.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/random.h"
#include "core/rig/glide.h"

namespace skincal {
namespace {

constexpr double kTremble = 0.5;       // m/s^2 rms per axis
constexpr double kSway = 1 * kDegree;  // at most
constexpr std::size_t kSinesPerAxis = 3;

double secondsOf(HeldBody::Time time) {
    return std::chrono::duration<double>(time).count();
}

}  // namespace

Vector3d BodyForces::at(const Vector3d& p_r) const {
    const Vector3d d = p_r - pivot_r;
    return force_r + twist_r.cross(d) + spin_r.cross(spin_r.cross(d));
}

HeldBody::HeldBody(const Vector3d& up_r, const Vector3d& pivot_r, Time start, std::uint64_t seed)
    : begin_(start - kTurn - kSettle) {
    from_r_ = up_r;
    pivot_r_ = pivot_r;
    Random random(seed, "tremble");
    for (Sine& sine : sines_)
        sine = {random.uniform(4, 12), random.uniform(0, 360 * kDegree)};
}

void HeldBody::turn(const Vector3d& up_r, Time now) {
    trembleBefore_ = trembleAt(now);
    from_r_ = up(now);
    begin_ = now;
    ++turns_;
    const Vector3d axis = from_r_.cross(up_r);
    angle_ = std::atan2(axis.norm(), from_r_.dot(up_r));
    axis_r_ = axis.norm() > 1e-9 ? axis.normalized() : from_r_.unitOrthogonal();
}

Vector3d HeldBody::up(Time time) const {
    const double angle = angle_ * glideAt(secondsOf(time - begin_), secondsOf(kTurn)).way;
    return so3Exp(angle * axis_r_) * from_r_;
}

BodyForces HeldBody::forces(Time time) const {
    const Glide glide = glideAt(secondsOf(time - begin_), secondsOf(kTurn));
    const double tremble = trembleAt(time);
    BodyForces forces;
    forces.pivot_r = pivot_r_;
    Vector3d up_r = up(time);
    if (tremble > 0) {
        up_r = so3Exp(tremble * kSway / kSinesPerAxis * sines(time, sines_.size() / 2)) * up_r;
        forces.force_r = tremble * kTremble / std::sqrt(0.5 * kSinesPerAxis) * sines(time, 0);
    }
    forces.force_r += kStandardGravity * up_r;
    // Where up goes one way in the body, the body goes the other.
    forces.spin_r = -angle_ * glide.speed * axis_r_;
    forces.twist_r = -angle_ * glide.acceleration * axis_r_;
    return forces;
}

double HeldBody::trembleAt(Time time) const {
    if (time < begin_ || time >= restsAt())
        return 0;
    constexpr double kOnset = 0.1;  // s
    if (time < begin_ + kTurn)
        return trembleBefore_ + (1 - trembleBefore_) * std::min(1.0, secondsOf(time - begin_) / kOnset);
    return std::pow(secondsOf(restsAt() - time) / secondsOf(kSettle), 3);
}

Vector3d HeldBody::sines(Time time, std::size_t first) const {
    constexpr double kAnother = 2.4;  // rad: no two turns tremble alike
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < 3 * kSinesPerAxis; ++i) {
        const Sine& sine = sines_.at(first + i);
        const double angle = 360 * kDegree * sine.frequency * secondsOf(time - begin_);
        sum[static_cast<Eigen::Index>(i % 3)] += std::sin(angle + sine.phase + kAnother * turns_);
    }
    return sum;
}

}  // namespace skincal
