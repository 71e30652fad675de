#include "core/rig/held_camera.h"

#include "core/rig/glide.h"

namespace skincal {

void HeldCamera::move(const Isometry3d& T_r_v, Time now) {
    from_ = pose(now);
    to_ = T_r_v;
    begin_ = now;
    end_ = now + kMove;
}

void HeldCamera::jump(const Isometry3d& T_r_v, Time now) {
    from_ = to_ = T_r_v;
    begin_ = end_ = now;
}

Isometry3d HeldCamera::pose(Time time) const {
    using Seconds = std::chrono::duration<double>;
    if (time >= end_)
        return to_;
    const double way = glideAt(Seconds(time - begin_).count(), Seconds(kMove).count()).way;
    const Vector3d turn = so3Log(from_.linear().transpose() * to_.linear());
    return makeIsometry(from_.linear() * so3Exp(way * turn), (1 - way) * from_.translation() + way * to_.translation());
}

}  // namespace skincal
