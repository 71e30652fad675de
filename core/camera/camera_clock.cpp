#include "core/camera/camera_clock.h"

#include <algorithm>
#include <cmath>

namespace skincal {

CameraClock::Stamp CameraClock::stamp(std::optional<Time> camera, Time arrival) {
    if (!camera) {
        camera_.reset();
        return {arrival - lead_, next_++};
    }
    // The same time again is not a clock that was set: it keeps its place, and is refused as repeated.
    if (!camera_ || *camera < *camera_) {
        offset_ = arrival - *camera;
    } else {
        const Time passed = *camera - *camera_;
        const auto drift = Time(std::llround(static_cast<double>(passed.count()) * kMaxDrift));
        offset_ = std::min(offset_ + drift, arrival - *camera);
        if (period_ > Time{}) {
            const auto periods =
                std::llround(static_cast<double>(passed.count()) / static_cast<double>(period_.count()));
            next_ += static_cast<std::uint64_t>(std::max(periods - 1, 0LL));
        }
    }
    camera_ = camera;
    return {*camera + offset_ - lead_, next_++};
}

}  // namespace skincal
