#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace skincal {

/// Planes in which the ground about a spot is darker than the darkest level, 1 each: light on it first has to make up
/// for what is cut off. Only where the ground is brighter in most of them: in a dark room black is no darker than it
/// looks.
/// @param around  per plane, SpotBrightness::around
[[nodiscard]] std::vector<std::uint8_t> blackPlanes(const Eigen::Ref<const Eigen::VectorXf>& around);

/// Planes in which a spot shines as it is read or more, 1 each: its middle is as bright as pixels get, or its ground is
/// black. None of the first where that is nearly always so: then the ground itself is that bright, and what LEDs add to
/// it shows where it is not, to the same share in every plane.
/// @param isFull  per plane, SpotSeries::isFull
[[nodiscard]] std::vector<std::uint8_t> atLeastPlanes(
    const Eigen::Ref<const Eigen::Array<std::uint8_t, Eigen::Dynamic, 1>>& isFull,
    const Eigen::Ref<const Eigen::VectorXf>& around);

}  // namespace skincal
