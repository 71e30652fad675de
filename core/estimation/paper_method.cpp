#include "core/estimation/paper_method.h"

#include <algorithm>
#include <stdexcept>

#include "core/estimation/body_assembly.h"
#include "core/estimation/missing_data.h"
#include "core/estimation/patch_sightings.h"

namespace skincal {
namespace {

struct PosedPatch {
    std::size_t view = 0;
    std::size_t patch = 0;
    PatchPose pose;
};

/// eq. 15 and 16, until a whole round attaches nothing.
void chainViews(const std::vector<PosedPatch>& posed, std::size_t views, BodyEstimate& estimate) {
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t v = 0; v < views; ++v) {
            const PosedPatch* known = nullptr;
            bool any = false;
            for (const PosedPatch& p : posed) {
                any = any || p.view == v;
                if (p.view == v && estimate.T_r_o[p.patch] &&
                    (known == nullptr || p.pose.inlierCount() > known->pose.inlierCount()))
                    known = &p;
            }
            const bool nothingYet =
                std::none_of(estimate.T_r_v.begin(), estimate.T_r_v.end(), [](const auto& T) { return T.has_value(); });
            if (!estimate.T_r_v[v]) {
                if (known != nullptr)
                    estimate.T_r_v[v] = *estimate.T_r_o[known->patch] * known->pose.T_v_o.inverse();
                else if (nothingYet && any)
                    estimate.T_r_v[v] = Isometry3d::Identity();
                else
                    continue;
                changed = true;
            }
            for (const PosedPatch& p : posed) {
                if (p.view == v && !estimate.T_r_o[p.patch]) {
                    estimate.T_r_o[p.patch] = *estimate.T_r_v[v] * p.pose.T_v_o;
                    changed = true;
                }
            }
        }
    }
}

}  // namespace

tl::expected<BodyModel, CalibrationError> calibratePaper(const Measurements& measurements,
                                                         const PaperMethodOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("PaperMethodOptions out of range");
    const Skin& skin = measurements.skin;
    const GravityTable gravity(skin, measurements.gravity);
    const SkinLayout layout = layOutSkin(measurements, gravity, options.layout);

    BodyEstimate estimate;
    estimate.method = "paper";
    for (const Patch& patch : layout.patches)
        estimate.shapes.push_back(chainPatchShape(skin, layout, gravity, patch, options.rotation));

    AdjustmentInput input;
    input.skin = &skin;
    input.camera = &measurements.camera;
    input.gravity = &gravity;
    input.pixels = flattenDetections(measurements);
    input.gravityGroup = layout.patchOf;
    estimate.rejected.assign(input.pixels.size(), false);
    estimate.rejectedReason.resize(input.pixels.size());
    estimate.patchViews.resize(layout.patches.size());

    std::vector<PosedPatch> posed;
    auto evidence = patchEvidence(layout, estimate.shapes, input.pixels);
    const auto sightings = collectSightings(skin, layout, estimate.shapes, input.pixels);
    for (std::size_t i = 0; i < sightings.size(); ++i) {
        const PatchSighting& sighting = sightings[i];
        if (context.isCancelled())
            return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
        context.report(Sentence::saying("patch poses"), static_cast<double>(i) / static_cast<double>(sightings.size()));
        const auto pose = estimatePatchPosePaper(sighting.leds, measurements.camera, options.pose);
        for (std::size_t k = 0; k < sighting.observations.size(); ++k) {
            if (!pose || !pose->inliers[k]) {
                estimate.rejected[sighting.observations[k]] = true;
                estimate.rejectedReason[sighting.observations[k]] =
                    pose ? Sentence::saying("outlier of the patch's pose")
                         : Sentence::saying("no pose of its patch in this view: {}", pose.error().sentence());
            }
        }
        if (!pose && pose.error().code != ErrorCode::TooFewPoints)
            ++evidence[sighting.patch].poseFailures[pose.error().code];
        if (pose) {
            posed.push_back({sighting.view, sighting.patch, *pose});
            estimate.patchViews[sighting.patch].push_back(sighting.view);
        }
    }

    estimate.T_r_o.resize(layout.patches.size());
    estimate.T_r_v.resize(measurements.views.size());
    chainViews(posed, measurements.views.size(), estimate);

    estimate.T_r_u.resize(skin.modules.size());
    estimate.patchStatus.resize(layout.patches.size());
    std::vector<std::size_t> notHeld;
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        const Patch& patch = layout.patches[k];
        if (!estimate.T_r_o[k]) {
            estimate.patchStatus[k] = Sentence::saying("not seen with a placed patch");
            estimate.missing.push_back(whyNotPlaced(skin, patch, evidence[k], options.pose.minInliers, !posed.empty()));
            continue;
        }
        estimate.patchStatus[k] = Sentence::saying("placed");
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            if (!estimate.shapes[k].T_o_u[i])
                notHeld.push_back(patch.modules[i]);
            else
                estimate.T_r_u[patch.modules[i]] = *estimate.T_r_o[k] * *estimate.shapes[k].T_o_u[i];
        }
    }
    if (!notHeld.empty())
        estimate.missing.push_back(whyNotHeld(skin, notHeld));
    for (const auto& T : estimate.T_r_v)
        estimate.viewStatus.emplace_back(T ? Sentence::saying("placed")
                                           : Sentence::saying("shows no placed patch well enough"));
    return assembleBody(measurements, gravity, layout, input, estimate);
}

}  // namespace skincal
