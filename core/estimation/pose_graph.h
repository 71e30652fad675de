#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

/// A measured pose between two nodes (a view and a patch, say).
struct PoseEdge {
    std::size_t from = 0;
    std::size_t to = 0;
    Isometry3d T_from_to = Isometry3d::Identity();
    double sigmaRotation = 0.01;      ///< rad
    double sigmaTranslation = 0.001;  ///< m
};

/// Poses T_r_n of all nodes that edges connect with `root`, along the tree whose edges are the most certain
/// (Kruskal on the variance of an edge: rotation times `lever` plus translation). Nothing for the others.
/// The order of the edges makes no difference as long as no two are equally certain.
/// @param lever  m; how far apart things are that a rotation moves.
[[nodiscard]] std::vector<std::optional<Isometry3d>> spanningTreePoses(std::size_t nodes,
                                                                       const std::vector<PoseEdge>& edges,
                                                                       std::size_t root, double lever = 0.1);

struct PoseAveragingOptions {
    int iterations = 20;
    double tolerance_rad = 1e-7;
    /// Residuals beyond this many sigmas lose weight (Cauchy): one wrong edge must not bend a loop.
    double loss = 3.0;

    [[nodiscard]] bool validate() const { return iterations > 0 && tolerance_rad > 0 && loss > 0; }
};

/// Rotations first, then translations, that agree best with all edges; closes the loops that a tree leaves open.
///   min sum rho(|log(R_r_from R_from_to R_r_to^T)|^2 / s_R^2), then
///   min sum rho(|t_r_from + R_r_from t_from_to - t_r_to|^2 / s_t^2)
/// by iteratively reweighted least squares on a sparse Laplacian; `root` keeps its pose. Nodes without a start have
/// none afterwards, and their edges are left out.
/// Ref: Chatterjee and Govindu, Efficient and robust large-scale rotation averaging, ICCV 2013.
[[nodiscard]] std::vector<std::optional<Isometry3d>> averagePoses(const std::vector<PoseEdge>& edges,
                                                                  std::vector<std::optional<Isometry3d>> start,
                                                                  std::size_t root,
                                                                  const PoseAveragingOptions& options = {});

/// Which connected part each node belongs to, numbered by its smallest node.
[[nodiscard]] std::vector<std::size_t> connectedParts(std::size_t nodes, const std::vector<PoseEdge>& edges);

}  // namespace skincal
