#pragma once

#include <utility>
#include <vector>

#include "core/geometry/random.h"
#include "core/skin/cable_detection.h"
#include "core/skin/patches.h"

namespace skincal {

/// A skin whose shape is known.
struct KnownSkin {
    Skin skin;
    std::vector<Isometry3d> T_s_u;  ///< per module, in a frame of the skin's own
};

template <class T>
void shuffle(Random& random, std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i)
        std::swap(values[i - 1], values[random.index(i)]);
}

/// A random connected piece of the tiling that a template makes, every touching pair of ports linked once. Ids are
/// random with gaps, and so is the order of the modules.
[[nodiscard]] KnownSkin growFlatSkin(Random& random, const ModuleTemplate& type, std::size_t modules);

/// A skin whose modules have so many ports that any graph can be wired with them; edges are pairs of positions.
[[nodiscard]] Skin wire(const std::vector<unsigned>& ids,
                        const std::vector<std::pair<std::size_t, std::size_t>>& edges);

/// Ids from a range ten times as long as their number, in random order.
[[nodiscard]] std::vector<unsigned> randomIds(Random& random, std::size_t count);

/// The same skin as another network scan might tell it: modules and links in another order, ends swapped, some links
/// reported from both sides.
[[nodiscard]] Skin retold(Random& random, const Skin& skin);

/// Links on the shortest way between all pairs, by Floyd and Warshall; a million where there is none.
[[nodiscard]] std::vector<std::vector<int>> allDistances(std::size_t size,
                                                         const std::vector<std::pair<std::size_t, std::size_t>>& edges);

/// Nothing measured about any link.
[[nodiscard]] CableEvidence noEvidence(const SkinGraph& graph);
/// True relative rotations, each off by up to `error` (rad) about a random axis.
[[nodiscard]] CableEvidence rotationEvidence(const SkinGraph& graph, const std::vector<Isometry3d>& T_r_u,
                                             Random& random, double error = 0);

/// Patches of a skin about which nothing was measured: every link joins neighbours.
[[nodiscard]] std::vector<Patch> patchesOf(const Skin& skin);

}  // namespace skincal
