#pragma once

#include <optional>
#include <vector>

#include "core/skin/cable_detection.h"
#include "core/skin/skin_graph.h"

namespace skincal {

/// A step of the calculation path from an origin to a module (paper, Algorithm 1).
struct TreeEdge {
    std::size_t parent = 0;  ///< module, nearer to the origin
    std::size_t child = 0;
    std::size_t link = 0;  ///< position in SkinGraph::links()
};

/// A closely connected set of modules: physical and network neighbours.
struct Patch {
    PatchId id;
    std::size_t origin = 0;            ///< module index
    std::vector<std::size_t> modules;  ///< module indexes, by rising id
    std::vector<TreeEdge> tree;        ///< breadth first from the origin, one edge per other module
};

/// Patches = connected components over the links that join neighbours, numbered from 0 by the smallest module id.
/// Path lengths count links: each adds one estimated rotation, hence one error. Trees are shortest paths; among equals
/// the parent with the smaller id, so that the result depends on ids and links alone, not on their order.
[[nodiscard]] std::vector<Patch> findPatches(const Skin& skin, const SkinGraph& graph,
                                             const std::vector<LinkVerdict>& verdicts);

/// Neighbours of each node of one connected graph, nodes 0 … size-1.
struct AdjacencyLists {
    std::vector<std::size_t> first;      ///< size + 1 entries
    std::vector<std::size_t> neighbour;  ///< of node n: first[n] … first[n+1]-1
};

/// The node with the smallest sum of path lengths to all others; the first of equals. Exact: breadth-first search from
/// every node, given up as soon as the part that is known and a lower bound for the rest exceed the best sum so far.
/// Memory grows linearly with the graph.
[[nodiscard]] std::size_t mostCentralNode(const AdjacencyLists& graph);

}  // namespace skincal
