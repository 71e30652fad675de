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

constexpr std::array<Rgb, 11> kBlueYellowRed{{{49, 54, 149},
                                              {69, 117, 180},
                                              {116, 173, 209},
                                              {171, 217, 233},
                                              {224, 243, 248},
                                              {255, 255, 191},
                                              {254, 224, 144},
                                              {253, 174, 97},
                                              {244, 109, 67},
                                              {215, 48, 39},
                                              {165, 0, 38}}};

/// @param at  0 to 1
template <std::size_t N>
Rgb between(const std::array<Rgb, N>& colours, double at) {
    const double place = at * (N - 1);
    const auto below = std::min(static_cast<std::size_t>(place), N - 2);
    return mixed(colours.at(below), colours.at(below + 1), place - static_cast<double>(below));
}

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
    return between(kViridis, kCut * (dark ? 1 : 0) + (1 - kCut) * v);
}

Rgb divergingColour(double value) {
    return between(kBlueYellowRed, std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.5);
}

Rgb unknownColour(bool dark) {
    return dark ? Rgb{92, 96, 104} : Rgb{186, 190, 197};
}

}  // namespace skincal
