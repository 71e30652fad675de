#include "core/study/truth_estimate.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "core/adjustment/solution_review.h"
#include "core/skin/skin_graph.h"

namespace skincal {
namespace {

/// Fewer say nothing beyond the view's own pose: six unknowns.
constexpr std::size_t kMinSightingsOfView = 4;
/// Gravity tells how a patch is turned, so that two sightings are the least that say where it is.
constexpr std::size_t kMinSightingsOfPatch = 2;
constexpr double kSigmaFloor_px = 1e-3;

BodyState stateOf(const KnownTruth& truth) {
    BodyState state;
    state.T_r_u.assign(truth.T_r_u.begin(), truth.T_r_u.end());
    state.T_r_v.assign(truth.T_r_v.begin(), truth.T_r_v.end());
    state.accelerometers.resize(truth.T_r_u.size());
    return state;
}

/// The detections that belong where they are.
std::vector<PixelObservation> trueDetections(const AdjustmentInput& input, const Measurements& measurements,
                                             const KnownTruth& truth) {
    const BodyState state = stateOf(truth);
    std::vector<PixelObservation> kept = flattenDetections(measurements);
    kept.erase(std::remove_if(kept.begin(), kept.end(),
                              [&](const PixelObservation& o) {
                                  const auto r = pixelResidual(input, state, o);
                                  return !r || r->norm() > truth.falseBeyond_px;
                              }),
               kept.end());
    return kept;
}

AdjustmentInput inputOf(const Measurements& measurements, const KnownTruth& truth, const GravityTable& gravity) {
    AdjustmentInput input;
    input.skin = &measurements.skin;
    input.camera = &measurements.camera;
    input.gravity = &gravity;
    input.gravityGroup.assign(measurements.skin.modules.size(), 0);
    input.pixels = trueDetections(input, measurements, truth);
    // Both ends may have reported a link: it counts once.
    const SkinGraph graph = buildSkinGraph(measurements.skin);
    for (const GraphLink& link : graph.links()) {
        if (!truth.isCable[link.reported.front()])
            input.links.push_back({link.a, link.b, measurements.skin.port(link.a, link.a_port),
                                   measurements.skin.port(link.b, link.b_port)});
    }
    return input;
}

AdjustmentOptions weightsOf(const Measurements& measurements, const TrueNoise& noise) {
    double squares = 0;
    for (std::size_t u = 0; u < measurements.skin.modules.size(); ++u)
        squares += std::pow(measurements.skin.templateOf(u).portRadius(), 2);
    const double radiusSquared = squares / static_cast<double>(measurements.skin.modules.size());
    AdjustmentOptions options;
    options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
    options.pixelSigmaFloor_px = kSigmaFloor_px;
    options.pixelSigmaFactor = noise.pixelFactor;
    options.accelerometerSigma = noise.accelerometer;
    options.biasSigma = std::max(1e-3, noise.bias);
    options.scaleSigma = std::max(1e-4, noise.scale);
    // Both ends of a link play. A tilt moves a port along two of the three axes.
    options.linkSigma =
        std::sqrt(2 * (std::pow(noise.playPosition, 2) + std::pow(noise.playTilt, 2) * radiusSquared * 2 / 3));
    return options;
}

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<std::size_t> componentsOf(std::size_t vertices, const Edges& edges) {
    const boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS> graph(edges.begin(), edges.end(),
                                                                                    vertices);
    std::vector<std::size_t> component(vertices);
    boost::connected_components(graph, component.data());
    return component;
}

/// Takes views and patches out of `input` and `state` of which too few sightings are left, until none is.
void dropWhatIsHardlySeen(AdjustmentInput& input, BodyState& state, const std::vector<std::size_t>& patchOf) {
    for (bool changed = true; changed;) {
        std::vector<std::size_t> ofView(state.T_r_v.size(), 0);
        std::vector<std::size_t> ofPatch(state.T_r_u.size(), 0);
        for (const PixelObservation& o : input.pixels) {
            ++ofView[o.view];
            ++ofPatch[patchOf[o.module]];
        }
        for (std::size_t v = 0; v < state.T_r_v.size(); ++v) {
            if (ofView[v] < kMinSightingsOfView)
                state.T_r_v[v].reset();
        }
        for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
            if (ofPatch[patchOf[u]] < kMinSightingsOfPatch)
                state.T_r_u[u].reset();
        }
        const auto gone = std::remove_if(input.pixels.begin(), input.pixels.end(), [&](const PixelObservation& o) {
            return !state.T_r_v[o.view] || !state.T_r_u[o.module];
        });
        changed = gone != input.pixels.end();
        input.pixels.erase(gone, input.pixels.end());
    }
}

/// Leaves the part with most modules of what views and links hold together.
void keepLargestPart(AdjustmentInput& input, BodyState& state, Edges edges) {
    const std::size_t modules = state.T_r_u.size();
    for (const PixelObservation& o : input.pixels)
        edges.emplace_back(o.module, modules + o.view);
    const auto part = componentsOf(modules + state.T_r_v.size(), edges);
    std::vector<std::size_t> size(part.size(), 0);
    for (std::size_t u = 0; u < modules; ++u)
        size[part[u]] += state.T_r_u[u] ? 1U : 0U;
    const auto largest = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    for (std::size_t u = 0; u < modules; ++u) {
        if (part[u] != largest)
            state.T_r_u[u].reset();
    }
    for (std::size_t v = 0; v < state.T_r_v.size(); ++v) {
        if (part[modules + v] != largest)
            state.T_r_v[v].reset();
    }
}

double rmsPixelFactor(const Measurements& measurements, const KnownTruth& truth) {
    const GravityTable gravity(measurements.skin, measurements.gravity);
    const AdjustmentInput input = inputOf(measurements, truth, gravity);
    const BodyState state = stateOf(truth);
    double squares = 0;
    for (const PixelObservation& o : input.pixels)
        squares += pixelResidual(input, state, o)->squaredNorm() / std::pow(std::max(o.sigma_px, kSigmaFloor_px), 2);
    return input.pixels.empty() ? 1 : std::sqrt(squares / (2 * static_cast<double>(input.pixels.size())));
}

void requireConsistent(const Measurements& measurements, const KnownTruth& truth) {
    if (truth.T_r_u.size() != measurements.skin.modules.size() || truth.T_r_v.size() != measurements.views.size() ||
        truth.isCable.size() != measurements.skin.links.size())
        throw std::logic_error("KnownTruth is not that of these measurements");
}

}  // namespace

KnownTruth knownTruth(const World& world) {
    const Scenario& s = world.scenario;
    KnownTruth truth{world.T_r_u, world.T_r_v, world.isCable, {}, 6 * s.views.pixelNoise};
    truth.noise.accelerometer = s.sensors.noise;
    truth.noise.bias = s.sensors.bias;
    truth.noise.scale = s.sensors.scale;
    truth.noise.playPosition = s.play.position;
    truth.noise.playTilt = s.play.tilt;
    return truth;
}

KnownTruth knownTruth(const Truth& truth, const Measurements& measurements, const TrueNoise& noise) {
    std::unordered_map<ModuleId, const TrueModule*> real;
    for (const TrueModule& module : truth.modules)
        real[module.id] = &module;
    const auto of = [&](ModuleId id) -> const TrueModule& {
        const auto found = real.find(id);
        if (found == real.end())
            throw std::logic_error("knownTruth: a module without truth");
        return *found->second;
    };
    KnownTruth known;
    for (const SkinModule& module : measurements.skin.modules)
        known.T_r_u.push_back(of(module.id).T_body_module);
    for (const TrueView& view : truth.views)
        known.T_r_v.push_back(view.T_body_camera);
    for (const Link& link : measurements.skin.links)
        known.isCable.push_back(of(link.a).patch != of(link.b).patch);
    requireConsistent(measurements, known);
    known.noise = noise;
    known.noise.pixelFactor = rmsPixelFactor(measurements, known);
    return known;
}

tl::expected<TruthEstimate, CalibrationError> estimateFromTruth(const Measurements& measurements,
                                                                const KnownTruth& truth, const RunContext& context) {
    requireConsistent(measurements, truth);
    const GravityTable gravity(measurements.skin, measurements.gravity);
    AdjustmentInput input = inputOf(measurements, truth, gravity);
    BodyState state = stateOf(truth);
    Edges links;
    for (const PortPair& link : input.links)
        links.emplace_back(link.a, link.b);
    dropWhatIsHardlySeen(input, state, componentsOf(state.T_r_u.size(), links));
    keepLargestPart(input, state, links);
    const auto root = std::find_if(state.T_r_v.begin(), state.T_r_v.end(), [](const auto& T) { return T.has_value(); });
    if (root == state.T_r_v.end())
        return tl::unexpected(CalibrationError{ErrorCode::TooFewPoints, {}});

    const Gauge gauge{{static_cast<std::size_t>(root - state.T_r_v.begin())}, {}};
    const AdjustmentOptions weights = weightsOf(measurements, truth.noise);
    auto result = adjustBody(input, std::move(state), gauge, weights, context);
    if (!result)
        return tl::unexpected(result.error());
    auto review = reviewSolution(input, result->state, gauge, weights);
    if (!review)
        return tl::unexpected(review.error());
    TruthEstimate estimate{std::move(result->state), std::move(review->covariances)};
    for (std::size_t u = 0; u < estimate.covariances.size(); ++u) {
        auto& C = estimate.covariances[u];
        if (C && std::sqrt(C->diagonal().tail<3>().maxCoeff()) < measurements.skin.templateOf(u).portRadius())
            continue;
        C.reset();
        estimate.state.T_r_u[u].reset();
    }
    return estimate;
}

}  // namespace skincal
