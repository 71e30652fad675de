#include "ui/presenters/model_overlay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/random.h"
#include "core/simulation/scenario.h"

namespace skincal {
namespace {

/// A sheet of modules before a camera, each found where it is but for noise; and what is hidden of it.
struct Sheet {
    BodyModel body;
    CameraModel camera = simulatedWebcam();

    explicit Sheet(std::uint64_t seed) {
        Random random(seed, "sheet");
        body.templates.push_back(paperHexagon());
        BodyView view;
        view.name = "view0";
        // Seen from 0.6 m above, a little aside.
        Matrix3d R;
        R << 1, 0, 0, 0, -1, 0, 0, 0, -1;
        view.T_body_camera = makeIsometry(so3Exp(0.1 * random.normal3()) * R, Vector3d(0.02, 0.03, 0.6));
        for (std::uint32_t i = 0; i < 12; ++i) {
            add(i + 1, {0.03 * (i % 4) - 0.05, 0.03 * (i / 4) - 0.03, 0}, Matrix3d::Identity());
            const Vector3d led = *body.modules.back().T_body_module * body.templates[0].led;
            const Vector2d residual(random.normal(), random.normal());
            view.observations.push_back({ModuleId(i + 1),
                                         *camera.project(view.T_body_camera->inverse() * led) + residual,
                                         residual,
                                         ObservationVerdict::Used,
                                         {}});
        }
        body.views.push_back(view);
    }
    void add(std::uint32_t id, const Vector3d& at, const Matrix3d& R) {
        BodyModule module;
        module.id = ModuleId(id);
        module.type = body.templates[0].name;
        module.patch = PatchId(0);
        module.T_body_module = makeIsometry(R, at);
        body.modules.push_back(module);
    }
    [[nodiscard]] ModelOverlay overlay() const { return overlayOf(body, body.views[0], camera); }
};

const OverlayModule* find(const ModelOverlay& overlay, std::uint32_t id) {
    for (const OverlayModule& module : overlay.modules) {
        if (module.module == ModuleId(id))
            return &module;
    }
    return nullptr;
}

TEST(ModelOverlay, PutsModulesWhereTheCameraSeesThemAndTellsHowFarSpotsAreOff) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Sheet sheet(seed);
        const ModelOverlay overlay = sheet.overlay();
        ASSERT_EQ(overlay.modules.size(), 12U);
        double squares = 0;
        double worst = 0;
        for (const OverlayModule& module : overlay.modules) {
            EXPECT_EQ(module.sight, OverlayModule::Sight::Open);
            ASSERT_TRUE(module.found && module.residual);
            EXPECT_LT((*module.found - *module.residual - module.led).norm(), 1e-9);
            EXPECT_EQ(module.outline.size(), sheet.body.templates[0].outline.size());
            squares += module.residual->squaredNorm();
            worst = std::max(worst, module.residual->norm());
        }
        EXPECT_NEAR(*overlay.rms_px, std::sqrt(squares / 12), 1e-12);
        EXPECT_EQ(overlay.worst_px, worst);
        EXPECT_EQ(find(overlay, overlay.worst.value)->residual->norm(), worst);
        EXPECT_EQ(overlay.counted, 12U);
    }
}

TEST(ModelOverlay, TellsWhatTheCameraCanNotSee) {
    Sheet sheet(1);
    sheet.add(50, {0, 0.1, 0}, so3Exp(Vector3d(180 * kDegree, 0, 0)));
    sheet.add(51, sheet.body.modules[5].T_body_module->translation() - Vector3d(0, 0, 0.02), Matrix3d::Identity());
    sheet.add(52, {2, 0, 0}, Matrix3d::Identity());
    sheet.add(53, {0, 0, 2}, Matrix3d::Identity());
    const ModelOverlay overlay = sheet.overlay();
    ASSERT_NE(find(overlay, 50), nullptr);
    EXPECT_EQ(find(overlay, 50)->sight, OverlayModule::Sight::TurnedAway);
    ASSERT_NE(find(overlay, 51), nullptr);
    EXPECT_EQ(find(overlay, 51)->sight, OverlayModule::Sight::Behind);
    EXPECT_EQ(find(overlay, 52), nullptr) << "out of the picture";
    EXPECT_EQ(find(overlay, 53), nullptr) << "behind the camera";
    EXPECT_EQ(overlay.missed, 0U);
}

TEST(ModelOverlay, WhatIsSetAsideHasNoSay) {
    Sheet sheet(2);
    const ModuleId worst = sheet.overlay().worst;
    for (BodyObservation& observation : sheet.body.views[0].observations) {
        if (observation.module == worst)
            observation.verdict = ObservationVerdict::Rejected;
    }
    const ModelOverlay overlay = sheet.overlay();
    EXPECT_EQ(overlay.setAside, 1U);
    EXPECT_NE(overlay.worst, worst);
    EXPECT_FALSE(find(overlay, worst.value)->counts);
    sheet.body.views[0].observations.clear();
    EXPECT_EQ(sheet.overlay().missed, 12U);
    EXPECT_FALSE(sheet.overlay().rms_px);
    sheet.body.views[0].T_body_camera.reset();
    EXPECT_TRUE(sheet.overlay().modules.empty());
}

TEST(ModelOverlay, ResidualsAreDrawnLongEnoughToBeSeenInARoundNumber) {
    Sheet sheet(3);
    for (const double size : {1e-4, 0.01, 0.3, 2.0, 50.0}) {
        for (BodyObservation& observation : sheet.body.views[0].observations)
            observation.residual = size * Vector2d::UnitX();
        const double scale = residualScale(sheet.overlay(), 30);
        EXPECT_LE(scale, 200);
        EXPECT_GE(scale, 1);
        EXPECT_TRUE(scale == 1 || scale * size <= 30 + 1e-9);
        EXPECT_TRUE(scale == 200 || scale * size > 30 / 2.6) << size;
    }
}

}  // namespace
}  // namespace skincal
