#pragma once

#include <vector>

#include "core/geometry/random.h"
#include "core/skin/cable_detection.h"
#include "core/skin/patches.h"

namespace skincal {

/// A skin that lies flat, and where each of its modules really is.
struct FlatSkin {
    Skin skin;
    std::vector<Isometry3d> T_r_u;
};

/// A random connected piece of the tiling that a template makes, every touching pair of ports linked once. Ids are
/// random with gaps, and so is the order of the modules.
[[nodiscard]] FlatSkin growFlatSkin(Random& random, const ModuleTemplate& type, std::size_t modules);

/// A skin whose modules have so many ports that any graph can be wired with them; edges are pairs of positions.
[[nodiscard]] Skin wire(const std::vector<unsigned>& ids,
                        const std::vector<std::pair<std::size_t, std::size_t>>& edges);

/// Ids from a range ten times as long as their number, in random order.
[[nodiscard]] std::vector<unsigned> randomIds(Random& random, std::size_t count);

/// The same skin as another network scan might tell it: modules and links in another order, ends swapped, some links
/// reported from both sides.
[[nodiscard]] Skin retold(Random& random, const Skin& skin);

[[nodiscard]] CableEvidence noEvidence(const SkinGraph& graph);
/// True relative rotations, each off by up to `error` (rad) about a random axis.
[[nodiscard]] CableEvidence rotationEvidence(const SkinGraph& graph, const std::vector<Isometry3d>& T_r_u,
                                             Random& random, double error = 0);

/// Patches of a skin about which nothing was measured: every link joins neighbours.
[[nodiscard]] std::vector<Patch> patchesOf(const Skin& skin);

}  // namespace skincal
