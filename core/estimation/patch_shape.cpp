#include "core/estimation/patch_shape.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

struct TreePorts {
    Vector3d parent;
    Vector3d child;
};

TreePorts portsOf(const Skin& skin, const SkinLayout& layout, const TreeEdge& edge) {
    const GraphLink& link = layout.graph.links()[edge.link];
    const bool forward = link.a == edge.parent;
    const int parentPort = forward ? link.a_port : link.b_port;
    const int childPort = forward ? link.b_port : link.a_port;
    return {skin.port(edge.parent, parentPort), skin.port(edge.child, childPort)};
}

/// The module that the most poses were measured of, if they tell a rotation.
std::optional<std::size_t> gravityReference(const GravityTable& gravity, const Patch& patch) {
    std::size_t best = patch.modules.front();
    for (const std::size_t u : patch.modules) {
        if (gravity.of(u).size() > gravity.of(best).size())
            best = u;
    }
    return relativeRotation(gravity, best, best) ? std::optional(best) : std::nullopt;
}

/// A starting shape: rotations straight from the reference's readings where both have the poses, else from those of the
/// neighbour nearer to the origin; the flat assumption where an accelerometer is silent.
void startShape(const Skin& skin, const SkinLayout& layout, const GravityTable& gravity, const Patch& patch,
                BodyState& state, std::vector<bool>& assumedFlat) {
    const auto reference = gravityReference(gravity, patch);
    // In a frame that is turned as the reference is, with the origin in the middle.
    auto& T_x_u = state.T_r_u;
    const auto direct = [&](std::size_t u) -> tl::expected<RelativeRotation, CalibrationError> {
        if (!reference)
            return tl::unexpected(CalibrationError{ErrorCode::TooFewPoses, {}});
        return relativeRotation(gravity, *reference, u);
    };
    const auto fromOrigin = direct(patch.origin);
    T_x_u[patch.origin] = makeIsometry(fromOrigin ? fromOrigin->R_c_n : Matrix3d::Identity(), Vector3d::Zero());
    assumedFlat[patch.origin] = !fromOrigin;
    for (const TreeEdge& edge : patch.tree) {
        const Isometry3d& T_x_p = *T_x_u[edge.parent];
        const TreePorts ports = portsOf(skin, layout, edge);
        Matrix3d R_x_c;
        if (const auto straight = direct(edge.child)) {
            R_x_c = straight->R_c_n;
        } else if (const auto local = relativeRotation(gravity, edge.parent, edge.child)) {
            R_x_c = T_x_p.linear() * local->R_c_n;
            assumedFlat[edge.child] = assumedFlat[edge.parent];
        } else {
            R_x_c = T_x_p.linear() * flatNeighbourRotation(ports.parent, ports.child);
            assumedFlat[edge.child] = true;
        }
        T_x_u[edge.child] = makeIsometry(R_x_c, T_x_p * ports.parent - R_x_c * ports.child);
    }
    const Isometry3d T_o_x = T_x_u[patch.origin]->inverse();
    for (const std::size_t u : patch.modules)
        T_x_u[u] = T_o_x * *T_x_u[u];
}

struct ShapeNoise {
    double sigma = 0;
    std::vector<NoisyAccelerometer> noisy;
};

/// Noise of the bulk from the median residual, and the modules that stick out.
ShapeNoise shapeNoise(const SkinLayout& layout, const AdjustmentInput& input, const BodyState& state) {
    ShapeNoise noise;
    std::vector<double> sizes;
    std::vector<double> meanSquare(state.T_r_u.size(), 0);
    std::size_t unknowns = 0;
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
        const auto residuals = gravityResiduals(input, state, u);
        for (const Vector3d& r : residuals) {
            for (const double component : r)
                sizes.push_back(std::abs(component));
            meanSquare[u] += r.squaredNorm() / (3.0 * static_cast<double>(residuals.size()));
        }
        unknowns += residuals.empty() ? 0 : 9;
    }
    for (std::size_t k = 0; k < layout.patches.size(); ++k)
        unknowns += 2 * static_cast<std::size_t>(std::count_if(state.up_r[k].begin(), state.up_r[k].end(),
                                                               [](const auto& up) { return up.has_value(); }));
    if (sizes.size() <= unknowns)
        return noise;
    const double freedom = static_cast<double>(sizes.size() - unknowns) / static_cast<double>(sizes.size());
    // Of a normal distribution, half lies within 0.6745 sigma.
    noise.sigma = median(std::move(sizes)) / 0.6745 / std::sqrt(freedom);
    constexpr double kSticksOut = 4;
    for (std::size_t u = 0; u < meanSquare.size(); ++u) {
        const double own = std::sqrt(meanSquare[u] / freedom);
        if (own > kSticksOut * noise.sigma)
            noise.noisy.push_back({u, own});
    }
    // Where many stick out, it is not their accelerometers.
    if (10 * noise.noisy.size() > meanSquare.size() + 10)
        noise.noisy.clear();
    return noise;
}

/// All patches at once: nothing joins them, and each keeps its origin.
tl::expected<BodyState, CalibrationError> solvePatches(const SkinLayout& layout, const AdjustmentInput& input,
                                                       const BodyState& start, const AdjustmentOptions& options,
                                                       const RunContext& context) {
    Gauge origins;
    for (const Patch& patch : layout.patches)
        origins.modules.push_back(patch.origin);
    auto result = adjustBody(input, start, origins, options, context);
    if (result)
        return std::move(result->state);
    if (result.error().code == ErrorCode::Cancelled)
        return tl::unexpected(result.error());
    BodyState same = start;  // nothing measured takes part
    estimateUpDirections(input, same);
    return same;
}

}  // namespace

std::vector<PortPair> adjacentPorts(const Skin& skin, const SkinLayout& layout) {
    std::vector<PortPair> pairs;
    for (std::size_t l = 0; l < layout.verdicts.size(); ++l) {
        const GraphLink& link = layout.graph.links()[l];
        if (layout.verdicts[l].kind != LinkKind::Adjacent)
            continue;
        pairs.push_back({link.a, link.b, skin.port(link.a, link.a_port), skin.port(link.b, link.b_port), l});
    }
    return pairs;
}

PatchShape chainPatchShape(const Skin& skin, const SkinLayout& layout, const GravityTable& gravity, const Patch& patch,
                           const RelativeRotationOptions& options) {
    std::unordered_map<std::size_t, Isometry3d> T_o_u;
    T_o_u.emplace(patch.origin, Isometry3d::Identity());
    for (const TreeEdge& edge : patch.tree) {
        const auto parent = T_o_u.find(edge.parent);
        const auto rotation = relativeRotation(gravity, edge.parent, edge.child, options);
        if (parent == T_o_u.end() || !rotation)
            continue;
        const TreePorts ports = portsOf(skin, layout, edge);
        T_o_u.emplace(edge.child,
                      parent->second * makeIsometry(rotation->R_c_n, ports.parent - rotation->R_c_n * ports.child));
    }
    PatchShape shape;
    for (const std::size_t u : patch.modules) {
        const auto found = T_o_u.find(u);
        shape.T_o_u.push_back(found == T_o_u.end() ? std::nullopt : std::optional(found->second));
    }
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
    PatchShapesResult result;
    result.assumedFlat.assign(skin.modules.size(), false);
    for (const Patch& patch : layout.patches)
        startShape(skin, layout, gravity, patch, start, result.assumedFlat);

    context.report(Sentence::saying("reconstructing patches"), 0);
    auto state = solvePatches(layout, input, start, options, context);
    if (!state)
        return tl::unexpected(state.error());
    const double sigma = shapeNoise(layout, input, *state).sigma;
    // Once more with the noise that the residuals show, where it is not what was assumed.
    if (sigma > 0 && (sigma > 1.3 * options.accelerometerSigma || sigma < options.accelerometerSigma / 1.3)) {
        options.accelerometerSigma = std::clamp(sigma, 1e-3, 2.0);
        context.report(Sentence::saying("reconstructing patches"), 0.5);
        state = solvePatches(layout, input, *state, options, context);
        if (!state)
            return tl::unexpected(state.error());
    }
    const ShapeNoise noise = shapeNoise(layout, input, *state);
    result.accelerometerSigma = noise.sigma;
    result.noisy = noise.noisy;
    result.accelerometers = state->accelerometers;
    result.up_o = state->up_r;
    for (const Patch& patch : layout.patches) {
        PatchShape shape;
        for (const std::size_t u : patch.modules)
            shape.T_o_u.push_back(state->T_r_u[u]);
        result.shapes.push_back(std::move(shape));
    }
    return result;
}

}  // namespace skincal
