#include "core/estimation/body_assembly.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

double rootMean(double squares, std::size_t count) {
    return std::sqrt(squares / static_cast<double>(count));
}

void addModules(const Measurements& m, const GravityTable& gravity, const SkinLayout& layout,
                const BodyEstimate& estimate, BodyModel& body) {
    body.modules.resize(m.skin.modules.size());
    for (std::size_t u = 0; u < body.modules.size(); ++u) {
        BodyModule& module = body.modules[u];
        module.id = m.skin.modules[u].id;
        module.type = m.skin.templateOf(u).name;
        module.T_body_module = estimate.T_r_u[u];
        if (!estimate.covariances.empty() && module.T_body_module)
            module.covariance = estimate.covariances[u];
        if (!estimate.accelerometers.empty() && !gravity.of(u).empty())
            module.accelerometer = estimate.accelerometers[u];
    }
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        const Patch& patch = layout.patches[k];
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            BodyModule& module = body.modules[patch.modules[i]];
            module.patch = patch.id;
            module.T_patch_module = estimate.shapes[k].T_o_u[i];
            if (!estimate.moduleTrouble.empty() && !estimate.moduleTrouble[patch.modules[i]].empty())
                module.status = estimate.moduleTrouble[patch.modules[i]];
            else if (module.T_body_module)
                module.status = Sentence::saying("placed");
            else if (!estimate.shapes[k].T_o_u[i])
                module.status = Sentence::saying("orientation unknown: no usable gravity readings");
            else
                module.status = estimate.patchStatus[k];
        }
    }
}

void addPatches(const Measurements& m, const SkinLayout& layout, const BodyEstimate& estimate, BodyModel& body) {
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        BodyPatch patch;
        patch.id = layout.patches[k].id;
        patch.origin = m.skin.modules[layout.patches[k].origin].id;
        for (const std::size_t u : layout.patches[k].modules)
            patch.modules.push_back(m.skin.modules[u].id);
        patch.T_body_patch = estimate.T_r_o[k];
        patch.status = estimate.patchStatus[k];
        for (const std::size_t v : estimate.patchViews[k])
            patch.views.push_back(m.views[v].name);
        body.patches.push_back(std::move(patch));
    }
}

void addLinks(const Measurements& m, const SkinLayout& layout, const BodyEstimate& estimate, BodyModel& body) {
    double squares = 0;
    double largest = 0;
    std::size_t count = 0;
    for (std::size_t l = 0; l < layout.verdicts.size(); ++l) {
        const GraphLink& link = layout.graph.links()[l];
        BodyLink out;
        out.link = {m.skin.modules[link.a].id, link.a_port, m.skin.modules[link.b].id, link.b_port, link.decided};
        out.kind = layout.verdicts[l].kind;
        const bool trouble = !estimate.linkTrouble.empty() && !estimate.linkTrouble[l].empty();
        out.reason = trouble ? estimate.linkTrouble[l] : layout.verdicts[l].explanation;
        const auto& T_r_a = estimate.T_r_u[link.a];
        const auto& T_r_b = estimate.T_r_u[link.b];
        if (T_r_a && T_r_b) {
            const Vector3d a = *T_r_a * m.skin.port(link.a, link.a_port);
            const Vector3d b = *T_r_b * m.skin.port(link.b, link.b_port);
            out.distance = (a - b).norm();
            if (out.kind == LinkKind::Adjacent && !trouble) {
                squares += *out.distance * *out.distance;
                largest = std::max(largest, *out.distance);
                ++count;
            }
        }
        body.links.push_back(std::move(out));
    }
    if (count > 0) {
        body.quality.link_mismatch_rms = rootMean(squares, count);
        body.quality.link_mismatch_max = largest;
    }
}

void addViews(const Measurements& m, const AdjustmentInput& input, const BodyState& state, const BodyEstimate& estimate,
              BodyModel& body) {
    double allSquares = 0;
    std::size_t allCount = 0;
    std::vector<double> squares(m.views.size(), 0);
    std::vector<std::size_t> counts(m.views.size(), 0);
    for (std::size_t v = 0; v < m.views.size(); ++v) {
        BodyView view;
        view.name = m.views[v].name;
        view.T_body_camera = estimate.T_r_v[v];
        view.status = estimate.viewStatus[v];
        body.views.push_back(std::move(view));
    }
    std::map<std::pair<std::size_t, ModuleId>, const SpotVerdict*> spots;
    for (const SpotVerdict& verdict : estimate.spots)
        spots[{verdict.view, m.skin.modules[verdict.module].id}] = &verdict;
    const auto spotOf = [&](std::size_t view, ModuleId id) {
        const auto found = spots.find({view, id});
        return found == spots.end() ? nullptr : found->second;
    };
    for (std::size_t i = 0; i < input.pixels.size(); ++i) {
        const PixelObservation& o = input.pixels[i];
        BodyObservation out;
        out.module = m.skin.modules[o.module].id;
        out.pixel = o.pixel;
        out.residual = pixelResidual(input, state, o);
        if (estimate.rejected[i]) {
            out.verdict = ObservationVerdict::Rejected;
            out.reason = estimate.rejectedReason[i];
        } else if (!out.residual) {
            out.verdict = ObservationVerdict::Rejected;
            out.reason = !estimate.T_r_v[o.view]     ? Sentence::saying("its view has no pose")
                         : !estimate.T_r_u[o.module] ? Sentence::saying("its module has no pose")
                                                     : Sentence::saying("its module lies behind the camera");
        } else {
            if (const SpotVerdict* spot = spotOf(o.view, out.module))
                out.reason = spot->reason;
            body.modules[o.module].seen = true;
            squares[o.view] += out.residual->squaredNorm();
            ++counts[o.view];
        }
        body.views[o.view].observations.push_back(std::move(out));
    }
    for (std::size_t v = 0; v < m.views.size(); ++v) {
        for (const Undetected& missed : m.views[v].undetected) {
            const auto verdict = missed.verdict == DetectionVerdict::Ambiguous ? ObservationVerdict::Ambiguous
                                                                               : ObservationVerdict::NotFound;
            const SpotVerdict* spot = spotOf(v, missed.module);
            if (spot != nullptr && spot->pixel)
                continue;  // its detection is there
            body.views[v].observations.push_back(
                {missed.module, std::nullopt, std::nullopt, verdict, spot != nullptr ? spot->reason : missed.reason});
        }
        if (counts[v] > 0)
            body.views[v].residual_rms_px = rootMean(squares[v], counts[v]);
        allSquares += squares[v];
        allCount += counts[v];
    }
    if (allCount > 0)
        body.quality.residual_rms_px = rootMean(allSquares, allCount);
}

void addGravityResidual(const AdjustmentInput& input, BodyState state, BodyModel& body) {
    estimateUpDirections(input, state);
    std::vector<double> lengths;
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
        for (const GravityTable::Entry& entry : input.gravity->of(u))
            lengths.push_back(entry.acceleration.norm());
        for (const Vector3d& r : gravityResiduals(input, state, u)) {
            squares += r.squaredNorm();
            count += 3;
        }
    }
    if (count > 0)
        body.quality.gravity_residual_rms = rootMean(squares, count);
    if (lengths.empty())
        return;
    const double typical = median(std::move(lengths));
    if (typical < kStandardGravity / 2 || typical > kStandardGravity * 2) {
        body.quality.trust = Trust::NotToBeTrusted;
        body.quality.warnings.push_back(
            Sentence::saying("gravity readings are {:.3g} m/s² long, gravity is {:.2f}: their unit is not m/s²",
                             typical, kStandardGravity));
    }
}

// Residuals beyond which a result is merely usable, and not even that: px, m, m/s^2, rms.
constexpr double kPixelGood = 1;
constexpr double kPixelUsable = 5;
constexpr double kLinkGood = 1.5e-3;
constexpr double kLinkUsable = 5e-3;
constexpr double kGravityGood = 0.15;
constexpr double kGravityUsable = 0.5;

/// What the covariances say, m and rad per axis; nothing without covariances.
struct Uncertainty {
    double position = 0;                ///< rms over the modules
    double rotation = 0;                ///< likewise
    const BodyModule* worst = nullptr;  ///< whose position is known least
    double worstPosition = 0;
};
std::optional<Uncertainty> uncertaintyOf(const BodyModel& body) {
    Uncertainty found;
    double position = 0;
    double rotation = 0;
    std::size_t count = 0;
    for (const BodyModule& module : body.modules) {
        if (!module.covariance)
            continue;
        const double square = module.covariance->bottomRightCorner<3, 3>().trace() / 3;
        rotation += module.covariance->topLeftCorner<3, 3>().trace() / 3;
        position += square;
        ++count;
        if (std::sqrt(square) > found.worstPosition) {
            found.worst = &module;
            found.worstPosition = std::sqrt(square);
        }
    }
    if (count == 0)
        return std::nullopt;
    found.position = rootMean(position, count);
    found.rotation = rootMean(rotation, count);
    return found;
}

/// Standard deviations per axis beyond which a result is merely usable, and not even that.
struct UncertaintyLimit {
    double position;  ///< m, rms over the modules
    double rotation;  ///< rad, likewise
};
constexpr UncertaintyLimit kUncertaintyGood{3e-3, 3 * kDegree};
constexpr UncertaintyLimit kUncertaintyUsable{10e-3, 10 * kDegree};
/// The same of any one module's position, m: one that is worse leaves a result usable however good the others are.
constexpr double kWorstGood = 5e-3;

/// The verdict that the uncertainty allows; says so where it is not good.
Trust judgeUncertainty(BodyQuality& quality, const Uncertainty& found) {
    quality.condition["position sigma"] = found.position;
    quality.condition["rotation sigma"] = found.rotation;
    const auto within = [&](const UncertaintyLimit& limit) {
        return found.position <= limit.position && found.rotation <= limit.rotation;
    };
    if (!within(kUncertaintyGood))
        quality.warnings.push_back(Sentence::saying(
            "what was measured fixes modules to {:.1f} mm and {:.1f}° only: add gravity poses and views",
            found.position * 1e3, found.rotation / kDegree));
    else if (found.worstPosition > kWorstGood)
        quality.warnings.push_back(
            found.worst->seen
                ? Sentence::saying(
                      "what was measured fixes module {} to {:.1f} mm only: show it in a view from another side",
                      found.worst->id.value, found.worstPosition * 1e3)
                : Sentence::saying("what was measured fixes module {} to {:.1f} mm only: show it in a view",
                                   found.worst->id.value, found.worstPosition * 1e3));
    else
        return Trust::Good;
    return within(kUncertaintyUsable) ? Trust::Usable : Trust::NotToBeTrusted;
}

void judge(BodyModel& body, Trust trustAtMost) {
    BodyQuality& quality = body.quality;
    if (const auto uncertainty = uncertaintyOf(body))
        trustAtMost = std::max(trustAtMost, judgeUncertainty(quality, *uncertainty));
    quality.modulesTotal = body.modules.size();
    quality.modulesPlaced = static_cast<std::size_t>(std::count_if(
        body.modules.begin(), body.modules.end(), [](const BodyModule& m) { return m.T_body_module.has_value(); }));
    std::size_t used = 0;
    std::size_t rejected = 0;
    for (const BodyView& view : body.views) {
        for (const BodyObservation& o : view.observations) {
            used += o.verdict == ObservationVerdict::Used ? 1 : 0;
            rejected += o.verdict == ObservationVerdict::Rejected ? 1 : 0;
        }
    }
    if (rejected > 0)
        quality.warnings.push_back(Sentence::saying("{} of {} detections rejected", rejected, used + rejected));
    const double residual = quality.residual_rms_px.value_or(0);
    const double gap = quality.link_mismatch_rms.value_or(0);
    const double gravity = quality.gravity_residual_rms.value_or(0);
    if (gravity > kGravityUsable)
        quality.warnings.push_back(Sentence::saying(
            "gravity readings are off by {:.2f} m/s² rms: the body shook in its poses, or a joint moved", gravity));
    const Trust before = std::max(quality.trust, trustAtMost);
    if (quality.modulesPlaced == 0 || residual > kPixelUsable || gap > kLinkUsable || gravity > kGravityUsable ||
        2 * rejected > used)
        quality.trust = Trust::NotToBeTrusted;
    else if (quality.modulesPlaced < quality.modulesTotal || residual > kPixelGood || gap > kLinkGood ||
             gravity > kGravityGood || rejected * 4 > used)
        quality.trust = Trust::Usable;
    else
        quality.trust = Trust::Good;
    quality.trust = std::max(quality.trust, before);
}

}  // namespace

BodyModel assembleBody(const Measurements& measurements, const GravityTable& gravity, const SkinLayout& layout,
                       const AdjustmentInput& input, const BodyEstimate& estimate) {
    BodyModel body;
    body.generator.method = estimate.method;
    body.body_frame = estimate.bodyFrame;
    body.templates = measurements.skin.templates;
    body.quality.condition = estimate.condition;
    body.quality.warnings = estimate.warnings;
    body.quality.missing = estimate.missing;
    body.quality.findings = estimate.findings;
    body.quality.stages = estimate.stages;

    BodyState state;
    state.T_r_u = estimate.T_r_u;
    state.T_r_v = estimate.T_r_v;
    state.accelerometers = estimate.accelerometers;
    state.accelerometers.resize(state.T_r_u.size());
    addModules(measurements, gravity, layout, estimate, body);
    addPatches(measurements, layout, estimate, body);
    addLinks(measurements, layout, estimate, body);
    addViews(measurements, input, state, estimate, body);
    addGravityResidual(input, state, body);
    judge(body, estimate.trustAtMost);
    return body;
}

}  // namespace skincal
