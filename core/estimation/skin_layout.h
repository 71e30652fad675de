#pragma once

#include <optional>
#include <vector>

#include "core/adjustment/gravity_table.h"
#include "core/adjustment/measurements.h"
#include "core/estimation/edge_rotation.h"
#include "core/geometry/sentence.h"
#include "core/skin/cable_detection.h"
#include "core/skin/patches.h"
#include "core/skin/skin_graph.h"

namespace skincal {

/// The skin sorted out: which links join neighbours, and the patches these make.
struct SkinLayout {
    SkinGraph graph;
    std::vector<LinkVerdict> verdicts;  ///< per link of the graph
    std::vector<Patch> patches;
    std::vector<std::size_t> patchOf;  ///< per module: index into patches
};

struct LayoutOptions {
    CableOptions cables;
    RelativeRotationOptions rotation;
    /// In fewer views than this the distance of two spots proves nothing: one of them may be a reflection. One view is
    /// enough where both lie as they should beside other neighbours.
    int minSeparationViews = 2;

    [[nodiscard]] bool validate() const;
};

/// What earlier solutions of the same measurements taught; empty before the first.
struct SolutionHistory {
    /// Per link of the graph: how far apart its ports came out where it was taken for a neighbour, m.
    std::vector<std::optional<double>> gaps;
    /// Per link of the graph: how everything else contradicts it; empty where nothing does.
    std::vector<Sentence> refuted;
    /// Modules whose patches moved against the others since gravity was read: its directions are not theirs.
    std::vector<std::size_t> movedPatchesOf;
};

/// How far apart in the pictures the two LEDs of a link are: times the distance that they would have as neighbours, at
/// the scale (px/m, foreshortened alike) of the links round about. The lower quartile over views: a false detection at
/// either end sets neighbours apart, hardly ever puts the ends of a cable together. Nothing where fewer than `minViews`
/// show both; one that shows both as they should lie beside other neighbours counts as two.
/// @param R_a_b  relative rotation of each link's modules from gravity; taken to lie flat where it could not be
/// measured.
[[nodiscard]] std::vector<std::optional<double>> linkSeparations(const Measurements& measurements,
                                                                 const SkinGraph& graph,
                                                                 const std::vector<std::optional<Matrix3d>>& R_a_b,
                                                                 double tooLong, int minViews);

/// Graph, cables by all evidence there is, patches with their origins (paper, Algorithm 1).
[[nodiscard]] SkinLayout layOutSkin(const Measurements& measurements, const GravityTable& gravity,
                                    const LayoutOptions& options = {}, const SolutionHistory& history = {});

}  // namespace skincal
