#include "core/estimation/patch_shape.h"

#include <cmath>

namespace skincal {
namespace {

std::size_t adjacentLinkCount(const SkinLayout& layout, std::size_t module) {
    std::size_t count = 0;
    for (std::size_t l = 0; l < layout.verdicts.size(); ++l) {
        const GraphLink& link = layout.graph.links()[l];
        if (layout.verdicts[l].kind == LinkKind::Adjacent && (link.a == module || link.b == module))
            ++count;
    }
    return count;
}

struct TreePorts {
    Vector3d parent;
    Vector3d child;
};

TreePorts portsOf(const Skin& skin, const SkinLayout& layout, const TreeEdge& edge) {
    const GraphLink& link = layout.graph.links()[edge.link];
    const bool forward = link.a == edge.parent;
    const int parentPort = forward ? link.a_port : link.b_port;
    const int childPort = forward ? link.b_port : link.a_port;
    return {skin.templateOf(edge.parent).ports[static_cast<std::size_t>(parentPort)],
            skin.templateOf(edge.child).ports[static_cast<std::size_t>(childPort)]};
}

/// A starting shape: rotations straight from the origin's readings where both have the poses, else along the tree;
/// the flat assumption where an accelerometer is silent.
void startShape(const Skin& skin, const SkinLayout& layout, const GravityTable& gravity, const Patch& patch,
                BodyState& state) {
    state.T_r_u[patch.origin] = Isometry3d::Identity();
    for (const TreeEdge& edge : patch.tree) {
        if (!state.T_r_u[edge.parent])
            continue;
        const Isometry3d& T_o_p = *state.T_r_u[edge.parent];
        const TreePorts ports = portsOf(skin, layout, edge);
        Matrix3d R_o_c;
        if (const auto direct = gravity.relativeRotation(patch.origin, edge.child)) {
            R_o_c = direct->R_c_n;
        } else if (const auto local = gravity.relativeRotation(edge.parent, edge.child)) {
            R_o_c = T_o_p.linear() * local->R_c_n;
        } else if (adjacentLinkCount(layout, edge.child) >= 2) {
            R_o_c = T_o_p.linear() * flatNeighbourRotation(ports.parent, ports.child);
        } else {
            continue;
        }
        state.T_r_u[edge.child] = makeIsometry(R_o_c, T_o_p * ports.parent - R_o_c * ports.child);
    }
}

/// Residuals of the calibrated readings about the state's up directions: sum of squares and how many.
void addGravityResiduals(const AdjustmentInput& input, const BodyState& state, double& squares, std::size_t& count) {
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
        if (!state.T_r_u[u])
            continue;
        const AccelerometerCalibration& c = state.accelerometers[u];
        for (const GravityTable::Entry& entry : input.gravity->of(u)) {
            const auto& up = state.up_r[input.gravityGroup[u]][entry.pose];
            if (!up)
                continue;
            const Vector3d a = kStandardGravity * (state.T_r_u[u]->linear().transpose() * *up);
            squares += (entry.acceleration - c.bias - c.scale.cwiseProduct(a)).squaredNorm();
            count += 3;
        }
    }
}

struct SolvedPatches {
    BodyState state;  ///< each patch in its own origin's frame
    double sigma = 0;
};

tl::expected<SolvedPatches, CalibrationError> solvePatches(const SkinLayout& layout, const AdjustmentInput& whole,
                                                           const BodyState& start, const AdjustmentOptions& options,
                                                           const RunContext& context) {
    SolvedPatches solved{start, 0};
    solved.state.up_r.assign(layout.patches.size(), std::vector<std::optional<Vector3d>>(whole.gravity->poseCount()));
    double squares = 0;
    std::size_t readings = 0;
    std::size_t unknowns = 0;
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        const Patch& patch = layout.patches[k];
        context.report("reconstructing patches", static_cast<double>(k) / static_cast<double>(layout.patches.size()));
        BodyState own = start;
        own.T_r_u.assign(own.T_r_u.size(), std::nullopt);
        for (const std::size_t u : patch.modules)
            own.T_r_u[u] = start.T_r_u[u];
        const auto result = adjustBody(whole, own, std::nullopt, patch.origin, options, context);
        if (!result && result.error().code == ErrorCode::Cancelled)
            return tl::unexpected(result.error());
        if (!result)
            continue;  // a lone module without readings: it stays where it is
        for (const std::size_t u : patch.modules) {
            solved.state.T_r_u[u] = result->state.T_r_u[u];
            solved.state.accelerometers[u] = result->state.accelerometers[u];
        }
        solved.state.up_r[k] = result->state.up_r[k];
        const std::size_t before = readings;
        addGravityResiduals(whole, result->state, squares, readings);
        if (readings > before)
            unknowns += 9 * patch.modules.size() + 2 * whole.gravity->poseCount();
    }
    if (readings > unknowns)
        solved.sigma = std::sqrt(squares / static_cast<double>(readings - unknowns));
    return solved;
}

}  // namespace

std::vector<PortPair> adjacentPorts(const Skin& skin, const SkinLayout& layout) {
    std::vector<PortPair> pairs;
    for (std::size_t l = 0; l < layout.verdicts.size(); ++l) {
        const GraphLink& link = layout.graph.links()[l];
        if (layout.verdicts[l].kind != LinkKind::Adjacent)
            continue;
        pairs.push_back({link.a, link.b, skin.templateOf(link.a).ports[static_cast<std::size_t>(link.a_port)],
                         skin.templateOf(link.b).ports[static_cast<std::size_t>(link.b_port)]});
    }
    return pairs;
}

PatchShape chainPatchShape(const Skin& skin, const SkinLayout& layout, const GravityTable& gravity, const Patch& patch,
                           const RelativeRotationOptions& options) {
    std::vector<std::optional<Isometry3d>> T_o_u(skin.modules.size());
    T_o_u[patch.origin] = Isometry3d::Identity();
    for (const TreeEdge& edge : patch.tree) {
        const auto rotation = gravity.relativeRotation(edge.parent, edge.child, options);
        if (!T_o_u[edge.parent] || !rotation)
            continue;
        const TreePorts ports = portsOf(skin, layout, edge);
        T_o_u[edge.child] =
            *T_o_u[edge.parent] * makeIsometry(rotation->R_c_n, ports.parent - rotation->R_c_n * ports.child);
    }
    PatchShape shape;
    for (const std::size_t u : patch.modules)
        shape.T_o_u.push_back(T_o_u[u]);
    return shape;
}

tl::expected<PatchShapesResult, CalibrationError> estimatePatchShapes(const Skin& skin, const SkinLayout& layout,
                                                                      const GravityTable& gravity,
                                                                      AdjustmentOptions options,
                                                                      const RunContext& context) {
    AdjustmentInput input;
    input.skin = &skin;
    input.gravity = &gravity;
    input.links = adjacentPorts(skin, layout);
    input.gravityGroup = layout.patchOf;

    BodyState start;
    start.T_r_u.resize(skin.modules.size());
    start.accelerometers.resize(skin.modules.size());
    for (const Patch& patch : layout.patches)
        startShape(skin, layout, gravity, patch, start);

    auto solved = solvePatches(layout, input, start, options, context);
    if (!solved)
        return tl::unexpected(solved.error());
    // Once more with the noise that the residuals show, where it is not what was assumed.
    if (solved->sigma > 0 &&
        (solved->sigma > 1.3 * options.accelerometerSigma || solved->sigma < options.accelerometerSigma / 1.3)) {
        options.accelerometerSigma = std::clamp(solved->sigma, 1e-3, 2.0);
        solved = solvePatches(layout, input, solved->state, options, context);
        if (!solved)
            return tl::unexpected(solved.error());
    }

    PatchShapesResult result;
    result.accelerometers = solved->state.accelerometers;
    result.up_o = solved->state.up_r;
    result.accelerometerSigma = solved->sigma;
    for (const Patch& patch : layout.patches) {
        PatchShape shape;
        for (const std::size_t u : patch.modules)
            shape.T_o_u.push_back(solved->state.T_r_u[u]);
        result.shapes.push_back(std::move(shape));
    }
    return result;
}

}  // namespace skincal
