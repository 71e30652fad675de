#include "core/estimation/pose_graph.h"

#include <Eigen/Sparse>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/kruskal_min_spanning_tree.hpp>
#include <cmath>
#include <queue>
#include <stdexcept>

namespace skincal {
namespace {

using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                                    boost::property<boost::edge_index_t, std::size_t>>;

Graph makeGraph(std::size_t nodes, const std::vector<PoseEdge>& edges) {
    Graph graph(nodes);
    for (std::size_t e = 0; e < edges.size(); ++e)
        boost::add_edge(edges[e].from, edges[e].to, e, graph);
    return graph;
}

double variance(const PoseEdge& edge, double lever) {
    return std::pow(edge.sigmaRotation * lever, 2) + std::pow(edge.sigmaTranslation, 2);
}

/// One weighted step: increments x_n with x_from - x_to = -residual on every edge, x_root = 0.
class LaplacianStep {
  public:
    LaplacianStep(const std::vector<PoseEdge>& edges, const std::vector<std::optional<Isometry3d>>& poses,
                  std::size_t root)
        : edges_(edges), column_(poses.size(), -1) {
        for (std::size_t n = 0; n < poses.size(); ++n) {
            if (poses[n] && n != root)
                column_[n] = unknowns_++;
        }
    }

    [[nodiscard]] Eigen::MatrixXd solve(const std::vector<Vector3d>& residuals, const std::vector<double>& weights,
                                        std::size_t nodes) const {
        std::vector<Eigen::Triplet<double>> triplets;
        Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns_, 3);
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const double w = weights[e];
            if (w <= 0)
                continue;
            const Eigen::Index i = column_[edges_[e].from];
            const Eigen::Index k = column_[edges_[e].to];
            if (i >= 0) {
                triplets.emplace_back(i, i, w);
                right.row(i) -= w * residuals[e].transpose();
            }
            if (k >= 0) {
                triplets.emplace_back(k, k, w);
                right.row(k) += w * residuals[e].transpose();
            }
            if (i >= 0 && k >= 0) {
                triplets.emplace_back(i, k, -w);
                triplets.emplace_back(k, i, -w);
            }
        }
        Eigen::SparseMatrix<double> laplacian(unknowns_, unknowns_);
        laplacian.setFromTriplets(triplets.begin(), triplets.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(laplacian);
        Eigen::MatrixXd increments = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(nodes), 3);
        if (unknowns_ == 0 || solver.info() != Eigen::Success)
            return increments;
        const Eigen::MatrixXd x = solver.solve(right);
        for (std::size_t n = 0; n < nodes; ++n) {
            if (column_[n] >= 0)
                increments.row(static_cast<Eigen::Index>(n)) = x.row(column_[n]);
        }
        return increments;
    }

  private:
    const std::vector<PoseEdge>& edges_;
    std::vector<Eigen::Index> column_;
    Eigen::Index unknowns_ = 0;
};

double cauchyWeight(double residual, double sigma, double loss) {
    const double r = residual / (sigma * loss);
    return 1.0 / (sigma * sigma * (1.0 + r * r));
}

}  // namespace

std::vector<std::optional<Isometry3d>> spanningTreePoses(std::size_t nodes, const std::vector<PoseEdge>& edges,
                                                         std::size_t root, double lever) {
    if (root >= nodes)
        throw std::logic_error("spanningTreePoses: the root is not a node");
    const Graph graph = makeGraph(nodes, edges);
    std::vector<double> weights(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e)
        weights[e] = variance(edges[e], lever);
    const auto index = boost::get(boost::edge_index, graph);
    std::vector<boost::graph_traits<Graph>::edge_descriptor> chosen;
    boost::kruskal_minimum_spanning_tree(graph, std::back_inserter(chosen),
                                         boost::weight_map(boost::make_iterator_property_map(weights.begin(), index)));

    Graph tree(nodes);
    for (const auto& edge : chosen)
        boost::add_edge(boost::source(edge, graph), boost::target(edge, graph), index[edge], tree);
    std::vector<std::optional<Isometry3d>> poses(nodes);
    poses[root] = Isometry3d::Identity();
    std::queue<std::size_t> queue({root});
    while (!queue.empty()) {
        const std::size_t n = queue.front();
        queue.pop();
        for (const auto& edge : boost::make_iterator_range(boost::out_edges(n, tree))) {
            const PoseEdge& measured = edges[boost::get(boost::edge_index, tree, edge)];
            const std::size_t other = boost::target(edge, tree);
            if (poses[other])
                continue;
            poses[other] = *poses[n] * (measured.from == n ? measured.T_from_to : measured.T_from_to.inverse());
            queue.push(other);
        }
    }
    return poses;
}

std::vector<std::optional<Isometry3d>> averagePoses(const std::vector<PoseEdge>& allEdges,
                                                    std::vector<std::optional<Isometry3d>> poses, std::size_t root,
                                                    const PoseAveragingOptions& options) {
    if (!options.validate())
        throw std::logic_error("PoseAveragingOptions out of range");
    std::vector<PoseEdge> edges;
    for (const PoseEdge& edge : allEdges) {
        if (poses[edge.from] && poses[edge.to])
            edges.push_back(edge);
    }
    const LaplacianStep step(edges, poses, root);
    std::vector<Vector3d> residuals(edges.size());
    std::vector<double> weights(edges.size());

    for (int iteration = 0; iteration < options.iterations; ++iteration) {
        for (std::size_t e = 0; e < edges.size(); ++e) {
            residuals[e] = so3Log(poses[edges[e].from]->linear() * edges[e].T_from_to.linear() *
                                  poses[edges[e].to]->linear().transpose());
            weights[e] = cauchyWeight(residuals[e].norm(), edges[e].sigmaRotation, options.loss);
        }
        const Eigen::MatrixXd increments = step.solve(residuals, weights, poses.size());
        for (std::size_t n = 0; n < poses.size(); ++n) {
            if (poses[n])
                poses[n]->linear() =
                    so3Exp(increments.row(static_cast<Eigen::Index>(n)).transpose()) * poses[n]->linear();
        }
        if (increments.size() == 0 || increments.cwiseAbs().maxCoeff() < options.tolerance_rad)
            break;
    }
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
        for (std::size_t e = 0; e < edges.size(); ++e) {
            residuals[e] = poses[edges[e].from]->translation() +
                           poses[edges[e].from]->linear() * edges[e].T_from_to.translation() -
                           poses[edges[e].to]->translation();
            weights[e] = cauchyWeight(residuals[e].norm(), edges[e].sigmaTranslation, options.loss);
        }
        const Eigen::MatrixXd increments = step.solve(residuals, weights, poses.size());
        for (std::size_t n = 0; n < poses.size(); ++n) {
            if (poses[n])
                poses[n]->translation() += increments.row(static_cast<Eigen::Index>(n)).transpose();
        }
        if (increments.size() == 0 || increments.cwiseAbs().maxCoeff() < 1e-9)
            break;
    }
    return poses;
}

std::vector<std::size_t> connectedParts(std::size_t nodes, const std::vector<PoseEdge>& edges) {
    const Graph graph = makeGraph(nodes, edges);
    std::vector<std::size_t> part(nodes);
    if (nodes > 0)
        boost::connected_components(graph, part.data());
    return part;
}

}  // namespace skincal
