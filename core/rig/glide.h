#pragma once

namespace skincal {

/// A way from 0 to 1 as a hand goes it: at rest at both ends and with as little jerk as possible.
///   x(s) = 10 s^3 - 15 s^4 + 6 s^5,  s = time / duration, 0 before and 1 after
/// Ref: Flash and Hogan, Journal of Neuroscience 5, 1985.
struct Glide {
    double way = 0;           ///< 0 to 1
    double speed = 0;         ///< 1/s
    double acceleration = 0;  ///< 1/s^2
};

/// @param time      s since it began, may be negative
/// @param duration  s, positive
[[nodiscard]] inline Glide glideAt(double time, double duration) {
    const double s = time / duration;
    if (s <= 0)
        return {};
    if (s >= 1)
        return {1, 0, 0};
    return {s * s * s * (10 + s * (-15 + 6 * s)), 30 * s * s * (1 - s) * (1 - s) / duration,
            60 * s * (1 - s) * (1 - 2 * s) / (duration * duration)};
}

}  // namespace skincal
