#include "core/skin/patches.h"

#include <algorithm>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/filtered_graph.hpp>
#include <limits>
#include <stdexcept>
#include <tuple>

namespace skincal {
namespace {

constexpr std::size_t kUnseen = std::numeric_limits<std::size_t>::max();

struct IsAdjacent {
    const SkinGraph::Graph* graph = nullptr;
    const std::vector<LinkVerdict>* verdicts = nullptr;
    template <class Edge>
    bool operator()(const Edge& edge) const {
        return (*verdicts)[(*graph)[edge].link].kind == LinkKind::Adjacent;
    }
};

struct Neighbour {
    std::size_t module;
    std::size_t link;
    int port;  ///< of the module whose neighbour it is
};

using Neighbours = std::vector<std::vector<Neighbour>>;

/// By rising id of the neighbour, then port, so that the tree does not depend on the order of the links.
Neighbours adjacentNeighbours(const Skin& skin, const SkinGraph& graph, const std::vector<LinkVerdict>& verdicts) {
    Neighbours neighbours(skin.modules.size());
    for (std::size_t l = 0; l < verdicts.size(); ++l) {
        if (verdicts[l].kind != LinkKind::Adjacent)
            continue;
        const GraphLink& link = graph.links()[l];
        neighbours[link.a].push_back({link.b, l, link.a_port});
        neighbours[link.b].push_back({link.a, l, link.b_port});
    }
    for (auto& list : neighbours) {
        std::sort(list.begin(), list.end(), [&](const Neighbour& x, const Neighbour& y) {
            return std::pair(skin.modules[x.module].id, x.port) < std::pair(skin.modules[y.module].id, y.port);
        });
    }
    return neighbours;
}

void growTree(const Skin& skin, const Neighbours& neighbours, std::vector<bool>& seen, Patch& patch) {
    std::vector<std::size_t> layer{patch.origin};
    seen[patch.origin] = true;
    while (!layer.empty()) {
        // Parents in order of id: the first that reaches a child is the one with the smallest id.
        std::sort(layer.begin(), layer.end(),
                  [&](std::size_t x, std::size_t y) { return skin.modules[x].id < skin.modules[y].id; });
        std::vector<std::size_t> next;
        for (const std::size_t parent : layer) {
            for (const Neighbour& n : neighbours[parent]) {
                if (seen[n.module])
                    continue;
                seen[n.module] = true;
                patch.tree.push_back({parent, n.module, n.link});
                next.push_back(n.module);
            }
        }
        layer = std::move(next);
    }
}

AdjacencyLists listsOf(const Patch& patch, const Neighbours& neighbours, std::vector<std::size_t>& localOf) {
    for (std::size_t i = 0; i < patch.modules.size(); ++i)
        localOf[patch.modules[i]] = i;
    AdjacencyLists lists;
    lists.first.push_back(0);
    for (const std::size_t module : patch.modules) {
        for (const Neighbour& n : neighbours[module])
            lists.neighbour.push_back(localOf[n.module]);
        lists.first.push_back(lists.neighbour.size());
    }
    return lists;
}

}  // namespace

std::size_t mostCentralNode(const AdjacencyLists& graph) {
    if (graph.first.size() < 2)
        throw std::logic_error("mostCentralNode of an empty graph");
    const std::size_t size = graph.first.size() - 1;
    std::vector<std::size_t> order(size);
    std::vector<std::size_t> mark(size, kUnseen);

    // Visits nodes layer by layer; returns the sum of distances, or kUnseen once it must exceed `best`.
    std::size_t round = 0;
    const auto sumFrom = [&](std::size_t source, std::size_t best) {
        const std::size_t me = round++;
        order[0] = source;
        mark[source] = me;
        std::size_t head = 0;
        std::size_t tail = 1;
        std::size_t sum = 0;
        for (std::size_t distance = 1; head < tail; ++distance) {
            const std::size_t layerEnd = tail;
            for (; head < layerEnd; ++head) {
                for (std::size_t k = graph.first[order[head]]; k < graph.first[order[head] + 1]; ++k) {
                    const std::size_t next = graph.neighbour[k];
                    if (mark[next] != me) {
                        mark[next] = me;
                        order[tail++] = next;
                    }
                }
            }
            sum += distance * (tail - layerEnd);
            // All that is left is at least one step farther.
            if (sum + (distance + 1) * (size - tail) > best)
                return kUnseen;
        }
        return sum;
    };

    // A node in the middle first, so that the bound bites from the start: half-way along the longest path found by
    // searching twice for the farthest node.
    (void)sumFrom(0, kUnseen);
    const std::size_t farthest = order[size - 1];
    (void)sumFrom(farthest, kUnseen);
    std::size_t best = sumFrom(order[size / 2], kUnseen);
    std::size_t bestNode = kUnseen;
    for (std::size_t node = 0; node < size; ++node) {
        const std::size_t sum = sumFrom(node, best);
        if (sum < best || (sum == best && bestNode == kUnseen)) {
            best = sum;
            bestNode = node;
        }
    }
    return bestNode;
}

std::vector<Patch> findPatches(const Skin& skin, const SkinGraph& graph, const std::vector<LinkVerdict>& verdicts) {
    if (verdicts.size() != graph.links().size())
        throw std::logic_error("findPatches: verdicts and graph differ in size");
    if (skin.modules.empty())
        return {};
    const boost::filtered_graph adjacent(graph.graph(), IsAdjacent{&graph.graph(), &verdicts});
    std::vector<std::size_t> component(skin.modules.size());
    const std::size_t count = boost::connected_components(adjacent, component.data());

    std::vector<Patch> patches(count);
    std::vector<std::size_t> byId(skin.modules.size());
    for (std::size_t i = 0; i < byId.size(); ++i)
        byId[i] = i;
    std::sort(byId.begin(), byId.end(),
              [&](std::size_t x, std::size_t y) { return skin.modules[x].id < skin.modules[y].id; });
    for (const std::size_t module : byId)
        patches[component[module]].modules.push_back(module);
    std::sort(patches.begin(), patches.end(), [&](const Patch& x, const Patch& y) {
        return skin.modules[x.modules.front()].id < skin.modules[y.modules.front()].id;
    });

    const Neighbours neighbours = adjacentNeighbours(skin, graph, verdicts);
    std::vector<std::size_t> localOf(skin.modules.size(), 0);
    std::vector<bool> seen(skin.modules.size(), false);
    for (std::size_t k = 0; k < count; ++k) {
        patches[k].id = PatchId(static_cast<std::uint32_t>(k));
        patches[k].origin = patches[k].modules[mostCentralNode(listsOf(patches[k], neighbours, localOf))];
        growTree(skin, neighbours, seen, patches[k]);
    }
    return patches;
}

}  // namespace skincal
