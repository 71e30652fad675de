#pragma once

#include <functional>
#include <map>
#include <vector>

#include "core/simulation/world.h"

namespace skincal {

/// Four patches of nineteen hexagons, joined by cables; triangles and rectangles are known but not there.
[[nodiscard]] Scenario hexagonsOnly();

[[nodiscard]] World faulty(const FaultOptions& faults, std::uint64_t seed, Scenario scenario = hexagonsOnly());

[[nodiscard]] bool contains(const std::vector<std::size_t>& sorted, std::size_t value);

/// Detections by (view, module).
[[nodiscard]] std::map<std::pair<std::size_t, std::size_t>, Vector2d> pixelsOf(const World& world);

/// What may differ, and then must.
using Exempt = std::function<bool(std::size_t, std::size_t)>;
[[nodiscard]] bool nobody(std::size_t, std::size_t);

/// The same to the last bit, but for the exempt (module, pose).
void expectSameGravity(const World& a, const World& b, const Exempt& exempt = nobody);
/// The same to the last bit, but for the exempt (view, module) where either world shows them.
void expectSameDetections(const World& a, const World& b, const Exempt& exempt = nobody);
void expectSameSkin(const World& a, const World& b);
void expectSamePoses(const std::vector<Isometry3d>& a, const std::vector<Isometry3d>& b);

}  // namespace skincal
