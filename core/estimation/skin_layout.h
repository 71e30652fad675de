#pragma once

#include <optional>
#include <vector>

#include "core/estimation/gravity_table.h"
#include "core/estimation/measurements.h"
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
    /// In fewer views than this the distance of two spots proves nothing: one of them may be a reflection.
    int minSeparationViews = 2;
};

/// How far apart in the pictures the two LEDs of a link are, in units of the median distance over the links next to
/// it (a pitch, foreshortened alike); the median over views. Nothing where too few views show both.
[[nodiscard]] std::vector<std::optional<double>> linkSeparations(const Measurements& measurements,
                                                                 const SkinGraph& graph, int minViews);

/// Graph, cables by all evidence there is, patches with their origins (METHOD.md, section 2, steps 1 and 2).
[[nodiscard]] SkinLayout layOutSkin(const Measurements& measurements, const GravityTable& gravity,
                                    const LayoutOptions& options = {});

}  // namespace skincal
