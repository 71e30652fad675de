#include <benchmark/benchmark.h>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <chrono>
#include <map>
#include <numeric>
#include <stdexcept>

#include "core/skin/patches.h"

namespace skincal {
namespace {

using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;

/// A lattice of cells with four ports each, as hexagons in their moulds make it: `side` by `side`.
Graph latticeGraph(std::size_t side) {
    Graph graph(side * side);
    for (std::size_t n = 0; n < side * side; ++n) {
        if (n % side + 1 < side)
            boost::add_edge(n, n + 1, graph);
        if (n + side < side * side)
            boost::add_edge(n, n + side, graph);
    }
    return graph;
}

AdjacencyLists listsOf(const Graph& graph) {
    AdjacencyLists lists;
    lists.first.push_back(0);
    for (std::size_t n = 0; n < boost::num_vertices(graph); ++n) {
        for (const auto neighbour : boost::make_iterator_range(boost::adjacent_vertices(n, graph)))
            lists.neighbour.push_back(neighbour);
        lists.first.push_back(lists.neighbour.size());
    }
    return lists;
}

/// What the library alone offers: a full search from every node.
std::size_t centreByFullSearches(const Graph& graph) {
    const std::size_t size = boost::num_vertices(graph);
    std::vector<std::size_t> distance(size);
    std::size_t best = 0;
    std::size_t bestSum = SIZE_MAX;
    for (std::size_t source = 0; source < size; ++source) {
        distance[source] = 0;
        boost::breadth_first_search(
            graph, source,
            boost::visitor(boost::make_bfs_visitor(boost::record_distances(distance.data(), boost::on_tree_edge()))));
        const std::size_t sum = std::accumulate(distance.begin(), distance.end(), std::size_t{0});
        if (sum < bestSum) {
            bestSum = sum;
            best = source;
        }
    }
    return best;
}

/// Seconds of one run of the baseline; measured once per size, as it takes long.
double baselineSeconds(const Graph& graph, std::size_t expected) {
    static std::map<std::size_t, double> known;
    const auto [entry, isNew] = known.emplace(boost::num_vertices(graph), 0.0);
    if (isNew) {
        const auto start = std::chrono::steady_clock::now();
        if (centreByFullSearches(graph) != expected)
            throw std::logic_error("both ways must find the same node");
        entry->second = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    return entry->second;
}

/// Counter "speedup": how many times faster than full searches from every node, in this run.
void mostCentral(benchmark::State& state) {
    const auto side = static_cast<std::size_t>(state.range(0));
    const Graph graph = latticeGraph(side);
    const AdjacencyLists lists = listsOf(graph);
    const double baseline = baselineSeconds(graph, mostCentralNode(lists));
    double own = 0;
    for ([[maybe_unused]] auto iteration : state) {
        const auto start = std::chrono::steady_clock::now();
        benchmark::DoNotOptimize(mostCentralNode(lists));
        own += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    state.counters["nodes"] = static_cast<double>(side * side);
    state.counters["baseline_s"] = baseline;
    state.counters["speedup"] = baseline * static_cast<double>(state.iterations()) / own;
}
// 100, 1,024 and 10,000 nodes.
BENCHMARK(mostCentral)->Arg(10)->Arg(32)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skincal
