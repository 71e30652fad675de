#pragma once

#include "core/estimation/body_model.h"
#include "core/geometry/random.h"

namespace skincal::test {

/// A body with something in every field.
inline BodyModel randomBody(std::uint64_t seed) {
    Random random(seed, "random body");
    const auto pose = [&] { return makeIsometry(random.rotation(), random.normal3()); };
    BodyModel body;
    body.generator = {"skincal", "1.2.3", "joint", {{"method", "joint"}}, {{"gravity.csv", "ab12"}}};
    body.body_frame = "patch:0";
    body.templates = {paperHexagon(), triangleTemplate()};
    for (std::uint32_t i = 0; i < 6; ++i) {
        BodyModule m;
        m.id = ModuleId(10 + i);
        m.type = i % 2 == 0 ? "hex" : "triangle";
        m.patch = PatchId(i / 4);
        m.status = i == 5 ? Sentence::verbatim("not seen, \"hidden\" & <lost>") : Sentence::saying("placed");
        m.T_patch_module = pose();
        if (i != 5)
            m.T_body_module = pose();
        if (i == 0)
            m.covariance = Matrix6d::Random();
        if (i == 1)
            m.accelerometer = AccelerometerCalibration{random.normal3(), random.normal3(), 0.01 * random.normal3()};
        if (i == 2)
            m.accelerometer = AccelerometerCalibration{random.normal3(), random.normal3()};
        m.seen = i == 0;  // as the view's observations below
        body.modules.push_back(m);
    }
    body.patches.push_back(
        {PatchId(0), ModuleId(10), {ModuleId(10), ModuleId(11)}, pose(), {"view0"}, Sentence::saying("placed")});
    body.patches.push_back({PatchId(1),
                            ModuleId(14),
                            {ModuleId(14)},
                            std::nullopt,
                            {},
                            Sentence::verbatim("not seen with a placed patch")});
    body.links.push_back(
        {{ModuleId(10), 0, ModuleId(11), 1, std::nullopt}, LinkKind::Adjacent, Sentence::verbatim("fits"), 0.001});
    body.links.push_back(
        {{ModuleId(11), 2, ModuleId(12), 3, std::nullopt}, LinkKind::Cable, Sentence::verbatim("twist"), std::nullopt});
    BodyView view{"view0", pose(), 0.25, {}, Sentence::saying("placed")};
    view.observations.push_back({ModuleId(10), Vector2d(1, 2), Vector2d(0.1, -0.1), ObservationVerdict::Used, {}});
    view.observations.push_back(
        {ModuleId(11), std::nullopt, std::nullopt, ObservationVerdict::Ambiguous, Sentence::verbatim("two spots")});
    body.views.push_back(view);
    BodyQuality& quality = body.quality;
    quality.modulesPlaced = 5;
    quality.modulesTotal = 6;
    quality.residual_rms_px = 0.1;
    quality.link_mismatch_rms = 0.001;
    quality.link_mismatch_max = 0.002;
    quality.gravity_residual_rms = 0.03;
    quality.condition = {{"pixel noise factor", 1.5}};
    quality.warnings = {Sentence::verbatim("a warning")};
    quality.missing = {Sentence::verbatim("a view")};
    quality.findings = {
        {Finding::Kind::WrongLink, {ModuleId(10), ModuleId(11)}, {}, {}, Sentence::verbatim("ports that do not meet")},
        {Finding::Kind::BumpedView, {ModuleId(10)}, "view0", {}, Sentence::verbatim("by 3 mm")},
        {Finding::Kind::ShakenPose, {}, {}, 7, Sentence::verbatim("it did not rest")}};
    quality.stages = {{"initial estimate", random.uniform(0, 1), 0}, {"joint adjustment", random.uniform(0, 1), 12}};
    quality.trust = Trust::Usable;
    return body;
}

}  // namespace skincal::test
