#pragma once

#include "core/estimation/body_model.h"
#include "core/geometry/random.h"

namespace skincal::test {

/// A body with something in every field.
inline BodyModel randomBody(std::uint64_t seed) {
    Random random(seed, "random body");
    const auto pose = [&] { return makeIsometry(random.rotation(), random.normal3()); };
    BodyModel body;
    body.generator = {"skincal", "1.2.3", "sturdy", {{"method", "sturdy"}}, {{"gravity.csv", "ab12"}}};
    body.body_frame = "patch:0";
    body.templates = {paperHexagon(), triangleTemplate()};
    for (std::uint32_t i = 0; i < 6; ++i) {
        BodyModule m;
        m.id = ModuleId(10 + i);
        m.type = i % 2 == 0 ? "hex" : "triangle";
        m.patch = PatchId(i / 4);
        m.status = i == 5 ? "not seen, \"hidden\" & <lost>" : "placed";
        m.T_patch_module = pose();
        if (i != 5)
            m.T_body_module = pose();
        if (i == 0)
            m.covariance = Matrix6d::Random();
        if (i == 1)
            m.accelerometer = AccelerometerCalibration{random.normal3(), random.normal3()};
        body.modules.push_back(m);
    }
    body.patches.push_back({PatchId(0), ModuleId(10), {ModuleId(10), ModuleId(11)}, pose(), {"view0"}, "placed"});
    body.patches.push_back(
        {PatchId(1), ModuleId(14), {ModuleId(14)}, std::nullopt, {}, "not seen with a placed patch"});
    body.links.push_back({{ModuleId(10), 0, ModuleId(11), 1, std::nullopt}, LinkKind::Adjacent, "fits", 0.001});
    body.links.push_back({{ModuleId(11), 2, ModuleId(12), 3, std::nullopt}, LinkKind::Cable, "twist", std::nullopt});
    BodyView view{"view0", pose(), 0.25, {}, "placed"};
    view.observations.push_back({ModuleId(10), Vector2d(1, 2), Vector2d(0.1, -0.1), ObservationVerdict::Used, ""});
    view.observations.push_back({ModuleId(11), std::nullopt, std::nullopt, ObservationVerdict::Ambiguous, "two spots"});
    body.views.push_back(view);
    body.quality = {
        5, 6, 0.1, 0.001, 0.002, 0.03, {{"pixel noise factor", 1.5}}, {"a warning"}, {"a view"}, Trust::Usable};
    return body;
}

}  // namespace skincal::test
