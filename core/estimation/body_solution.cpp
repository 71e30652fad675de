#include "core/estimation/body_solution.h"

#include <algorithm>
#include <set>

#include "core/estimation/advice_basis.h"
#include "core/estimation/missing_data.h"
#include "core/estimation/module_support.h"
#include "core/estimation/observability.h"
#include "core/estimation/one_sided_patches.h"

namespace skincal {
namespace {

bool isNamed(const BodyEstimate& estimate, Finding::Kind kind, ModuleId id) {
    return std::any_of(estimate.findings.begin(), estimate.findings.end(), [&](const Finding& f) {
        return f.kind == kind && std::count(f.modules.begin(), f.modules.end(), id) > 0;
    });
}

/// Patches whose gravity is their own; those that moved as a whole have been named.
void reportOwnGravity(BodySolution& solution) {
    BodyEstimate& estimate = solution.estimate;
    // Gravity was read, and no patch can use it: poses that are too alike make shapes up.
    const auto& held = solution.gravityFrame.R_g_o;
    const bool isAnyHeld = std::any_of(held.begin(), held.end(), [](const auto& R) { return R.has_value(); });
    for (std::size_t k = 0; solution.input.gravity->poseCount() > 0 && k < solution.layout.patches.size(); ++k) {
        const Patch& patch = solution.layout.patches[k];
        if (solution.gravityFrame.R_g_o[k] || !solution.body.T_r_o[k] || patch.modules.size() < 2)
            continue;
        estimate.trustAtMost = isAnyHeld ? Trust::Usable : Trust::NotToBeTrusted;
        if (!isNamed(estimate, Finding::Kind::MovedPatch, solution.input.skin->modules[patch.modules.front()].id))
            estimate.warnings.push_back(
                Sentence::saying("patch {}: gravity disagrees with the other patches or is too alike in all poses; its "
                                 "rotation rests on the camera alone",
                                 patch.id.value));
    }
}

void reportNoisyAccelerometers(BodySolution& solution) {
    BodyEstimate& estimate = solution.estimate;
    for (const NoisyAccelerometer& noisy : solution.shapes.noisy) {
        const ModuleId id = solution.input.skin->modules[noisy.module].id;
        if (!isNamed(estimate, Finding::Kind::NoisyAccelerometer, id))
            estimate.warnings.push_back(
                Sentence::saying("module {}: its accelerometer is off by {:.2f} m/s² rms, the others by {:.2f}",
                                 id.value, noisy.sigma, solution.shapes.accelerometerSigma));
    }
}

void reportMissing(BodySolution& solution, const Measurements& measurements, const BodyState& state,
                   const PatchPoseOptions& pose) {
    BodyEstimate& estimate = solution.estimate;
    const Skin& skin = measurements.skin;
    std::vector<ModuleId> takenOut;
    for (std::size_t u = 0; u < estimate.moduleTrouble.size(); ++u) {
        if (!estimate.moduleTrouble[u].empty())
            takenOut.push_back(skin.modules[u].id);
    }
    if (!takenOut.empty())
        estimate.missing.push_back(
            takenOut.size() == 1
                ? Sentence::saying(
                      "{} has no pose: it does not fit the rest, see what disagrees; mend or rewire it, or scan "
                      "again",
                      listed(takenOut))
                : Sentence::saying(
                      "{} have no pose: they do not fit the rest, see what disagrees; mend or rewire them, or "
                      "scan again",
                      listed(takenOut)));
    const bool anyPlaced =
        std::any_of(state.T_r_u.begin(), state.T_r_u.end(), [](const auto& T) { return T.has_value(); });
    for (std::size_t k = 0; k < solution.layout.patches.size(); ++k) {
        const Patch& patch = solution.layout.patches[k];
        if (solution.body.T_r_o[k]) {
            estimate.patchStatus[k] = Sentence::saying("placed");
            continue;
        }
        estimate.patchStatus[k] = solution.evidence[k].mostDetected > 0 && solution.evidence[k].mostUsable == 0
                                      ? Sentence::saying("gravity does not tell its shape")
                                      : Sentence::saying("not seen with a placed patch");
        estimate.missing.push_back(whyNotPlaced(skin, patch, solution.evidence[k], pose.minInliers, anyPlaced));
    }
    for (std::size_t v = 0; v < solution.body.T_r_v.size(); ++v) {
        estimate.viewStatus[v] = solution.body.T_r_v[v]
                                     ? Sentence::saying("placed")
                                     : Sentence::saying("shows no placed patch well enough, or could be in two places");
        if (!solution.body.T_r_v[v] && anyPlaced)
            estimate.warnings.push_back(
                Sentence::saying("view {} is not used: it {}", measurements.views[v].name, estimate.viewStatus[v]));
    }
    if (!estimate.undecidedViews.empty()) {
        estimate.trustAtMost = Trust::Usable;
        estimate.warnings.push_back(
            estimate.undecidedViews.size() == 1
                ? Sentence::saying("1 view shows a flat patch alone and could be in two places: the likelier was taken")
                : Sentence::saying(
                      "{} views show a flat patch alone and could be in two places: the likelier was taken",
                      estimate.undecidedViews.size()));
    }
    reportOwnGravity(solution);
    for (const Finding& finding : estimate.findings)
        estimate.warnings.push_back(finding.text);
    reportNoisyAccelerometers(solution);
}
/// The views whose pictures have a say in where each patch lies.
void listPatchViews(BodySolution& solution, const BodyState& state) {
    std::vector<std::set<std::size_t>> views(solution.layout.patches.size());
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        const PixelObservation& o = solution.input.pixels[i];
        if (!solution.estimate.rejected[i] && state.T_r_v[o.view] && state.T_r_u[o.module])
            views[solution.layout.patchOf[o.module]].insert(o.view);
    }
    for (const auto& of : views)
        solution.estimate.patchViews.emplace_back(of.begin(), of.end());
}

/// Nothing in the data would contradict a wrong distance of a patch that is seen from one side.
void reportOneSided(BodySolution& solution, const BodyState& state) {
    const OneSidedPatches oneSided =
        oneSidedPatches(solution.layout, usedMeasurements(solution).pixels, state, ShortfallOptions{}.viewAngle);
    if (oneSided.patches.empty())
        return;
    solution.estimate.trustAtMost = std::max(solution.estimate.trustAtMost, Trust::Usable);
    solution.estimate.warnings.push_back(oneSided.text);
}

/// A patch's frame is its origin's: it has none where nothing holds the origin.
void placePatchFrames(BodySolution& solution, const BodyState& state) {
    for (std::size_t k = 0; k < solution.layout.patches.size(); ++k) {
        const Patch& patch = solution.layout.patches[k];
        solution.estimate.T_r_o[k] = state.T_r_u[patch.origin];
        const bool anyPlaced = std::any_of(patch.modules.begin(), patch.modules.end(),
                                           [&](std::size_t u) { return state.T_r_u[u].has_value(); });
        if (!anyPlaced && solution.body.T_r_o[k])
            solution.estimate.patchStatus[k] = Sentence::saying("none of its modules is placed");
        if (!solution.estimate.T_r_o[k])
            continue;
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            if (state.T_r_u[patch.modules[i]])
                solution.shapes.shapes[k].T_o_u[i] =
                    solution.estimate.T_r_o[k]->inverse() * *state.T_r_u[patch.modules[i]];
        }
    }
}

}  // namespace

bool BodySolution::anyViewPlaced() const {
    return std::any_of(solved.T_r_v.begin(), solved.T_r_v.end(), [](const auto& T) { return T.has_value(); });
}

void anchorAtFirstView(BodySolution& solution) {
    BodyState& state = solution.solved;
    const auto root = std::find_if(state.T_r_v.begin(), state.T_r_v.end(), [](const auto& T) { return T.has_value(); });
    if (root == state.T_r_v.end())
        return;
    solution.gauge.views = {static_cast<std::size_t>(root - state.T_r_v.begin())};
    const Isometry3d T_v_r = (*root)->inverse();
    for (auto* poses : {&state.T_r_v, &state.T_r_u}) {
        for (auto& T : *poses) {
            if (T)
                T = T_v_r * *T;
        }
    }
    for (ViewAlternative& alternative : solution.alternatives)
        alternative.T_r_v = T_v_r * alternative.T_r_v;
    state.up_r.clear();
}

void rejectFarDetections(BodySolution& solution, double sigmas) {
    BodyEstimate& estimate = solution.estimate;
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        const PixelObservation& o = solution.input.pixels[i];
        const auto r = pixelResidual(solution.input, solution.solved, o);
        const double sigma = solution.input.sigmaOf(o, solution.weights);
        const bool far = r && r->norm() > sigmas * sigma;
        if (r && !far)
            estimate.setAside[i].clear();
        estimate.rejected[i] = far || !estimate.setAside[i].empty();
        estimate.rejectedReason[i] = estimate.setAside[i];
        if (far && estimate.setAside[i].empty())
            estimate.rejectedReason[i] =
                Sentence::saying("{:.1f} px from where the body has it, {:.0f} sigma", r->norm(), r->norm() / sigma);
    }
}

tl::expected<int, CalibrationError> adjustSolution(BodySolution& solution, const AdjustmentInput& input,
                                                   const RunContext& context) {
    auto result = adjustBody(input, solution.solved, solution.gauge, solution.weights, context);
    if (!result)
        return tl::unexpected(result.error());
    solution.solved = std::move(result->state);
    return result->summary.iterations;
}

AdjustmentInput usedMeasurements(const BodySolution& solution) {
    AdjustmentInput used = solution.input;
    used.pixels.clear();
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        if (!solution.estimate.rejected[i])
            used.pixels.push_back(solution.input.pixels[i]);
    }
    return used;
}

std::vector<std::optional<double>> linkGaps(const BodySolution& solution, std::vector<std::optional<double>> before) {
    const auto& links = solution.layout.graph.links();
    const Skin& skin = *solution.input.skin;
    before.resize(links.size());
    for (std::size_t l = 0; l < links.size(); ++l) {
        const GraphLink& link = links[l];
        const auto& T_r_a = solution.solved.T_r_u[link.a];
        const auto& T_r_b = solution.solved.T_r_u[link.b];
        if (T_r_a && T_r_b)
            before[l] = (*T_r_a * skin.port(link.a, link.a_port) - *T_r_b * skin.port(link.b, link.b_port)).norm();
    }
    return before;
}

void dropWhatNothingHolds(BodySolution& solution) {
    BodyState& state = solution.solved;
    const AdjustmentInput used = usedMeasurements(solution);
    std::vector<bool> measured = solution.shapes.assumedFlat;
    measured.flip();
    const std::vector<bool> held = heldModules(used, state, measured);
    for (std::size_t u = 0; u < held.size(); ++u) {
        if (held[u] || !state.T_r_u[u])
            continue;
        state.T_r_u[u].reset();
        solution.estimate.notHeld.push_back(u);
    }
    for (std::size_t k = 0; k < solution.layout.patches.size(); ++k) {
        const Patch& patch = solution.layout.patches[k];
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            if (!held[patch.modules[i]] && solution.shapes.assumedFlat[patch.modules[i]])
                solution.shapes.shapes[k].T_o_u[i].reset();
        }
    }
}

BodyModel describeSolution(BodySolution solution, const PatchPoseOptions& pose) {
    const Measurements& measurements = *solution.measurements;
    BodyState& state = solution.solved;
    dropWhatNothingHolds(solution);
    if (!solution.estimate.notHeld.empty())
        solution.estimate.missing.push_back(whyNotHeld(measurements.skin, solution.estimate.notHeld));
    reportMissing(solution, measurements, state, pose);
    reportOneSided(solution, state);
    listPatchViews(solution, state);
    placePatchFrames(solution, state);
    solution.estimate.shapes = solution.shapes.shapes;
    solution.estimate.T_r_u = state.T_r_u;
    solution.estimate.T_r_v = state.T_r_v;
    solution.estimate.accelerometers = state.accelerometers;
    return assembleBody(measurements, *solution.input.gravity, solution.layout, solution.input, solution.estimate);
}

}  // namespace skincal
