#include "ui/scene3d/colour_map.h"

#include <algorithm>
#include <cmath>

namespace skincal {
namespace {

/// Nine evenly spaced colours of viridis (Smith, van der Walt).
constexpr std::array<Rgb, 9> kViridis{{{68, 1, 84},
                                       {71, 45, 123},
                                       {59, 82, 139},
                                       {44, 114, 142},
                                       {33, 144, 140},
                                       {39, 173, 129},
                                       {93, 200, 99},
                                       {170, 220, 50},
                                       {253, 231, 37}}};

}  // namespace

Rgb mixed(const Rgb& a, const Rgb& b, double share) {
    Rgb result{};
    for (std::size_t i = 0; i < 3; ++i)
        result.at(i) = static_cast<std::uint8_t>(std::lround((1 - share) * a.at(i) + share * b.at(i)));
    return result;
}

Rgb toRgb(const std::array<double, 3>& colour) {
    return {static_cast<std::uint8_t>(std::lround(255 * colour[0])),
            static_cast<std::uint8_t>(std::lround(255 * colour[1])),
            static_cast<std::uint8_t>(std::lround(255 * colour[2]))};
}

Rgb valueColour(double value, bool dark) {
    constexpr double kCut = 0.1;
    const double v = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0;
    const double at = (kCut * (dark ? 1 : 0) + (1 - kCut) * v) * (kViridis.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
    return mixed(kViridis.at(below), kViridis.at(below + 1), at - static_cast<double>(below));
}

Rgb unknownColour(bool dark) {
    return dark ? Rgb{92, 96, 104} : Rgb{186, 190, 197};
}

}  // namespace skincal
