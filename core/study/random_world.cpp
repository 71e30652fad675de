#include "core/study/random_world.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/geometry/random.h"

namespace skincal {
namespace {

enum class Body { Plane, Cylinder, Relief, Arm };
constexpr std::array<const char*, 4> kBodyNames{"plane", "cylinder", "relief", "arm"};

double logUniform(Random& random, double low, double high) {
    return std::exp(random.uniform(std::log(low), std::log(high)));
}

SurfaceKind surfaceOf(Body body) {
    switch (body) {
        case Body::Plane:
            return SurfaceKind::Plane;
        case Body::Relief:
            return SurfaceKind::FreeForm;
        default:
            return SurfaceKind::Cylinder;
    }
}

PatchPlan drawPatch(Body body, int k, int patches, double radius, Random& random) {
    PatchPlan plan;
    plan.surface = surfaceOf(body);
    plan.radius = radius;
    plan.modules = 6 + random.index(18);
    plan.raggedness = random.uniform(0, 0.6);
    // Drawn whether or not the body has a use for it: leaving it out would shift all later draws.
    const double spread = random.uniform(0.10, 0.18);
    if (body == Body::Cylinder) {
        constexpr double kQuarterTurn = 1.57;
        plan.offset = {k * kQuarterTurn * radius, 0};
        return plan;
    }
    plan.offset = {(k - (patches - 1) / 2.0) * spread, random.uniform(-0.05, 0.05)};
    if (body == Body::Arm) {
        plan.radius = 0.05;
        plan.offset = Vector2d::Zero();
        const Vector3d shift = 0.05 * random.normal3();
        const Vector3d turn = 0.7 * random.normal3();
        plan.T_r_s = makeIsometry(so3Exp(turn), Vector3d(k * 0.2, 0, 0) + shift);
    }
    return plan;
}

}  // namespace

World randomWorld(std::uint64_t seed) {
    // The order of the draws is part of the contract: another one makes other worlds of the same seeds.
    Random random(seed, "stress");
    const auto body = static_cast<Body>(seed % 4);
    Scenario s;
    s.name = "random";
    s.camera = simulatedWebcam();
    const int patches = 2 + static_cast<int>(random.index(4));
    const double radius = body == Body::Cylinder ? random.uniform(0.05, 0.12) : 0.06;
    for (int k = 0; k < patches; ++k)
        s.patches.push_back(drawPatch(body, k, patches, radius, random));
    s.cables = random.uniform() < 0.5;
    s.sensors.poses = 6 + static_cast<int>(random.index(12));
    s.sensors.bias = random.uniform(0, 0.5);
    s.sensors.scale = random.uniform(0, 0.02);
    s.sensors.noise = logUniform(random, 0.01, 0.1);
    s.play.position = logUniform(random, 0.1e-3, 0.6e-3);
    s.play.tilt = random.uniform(0, 0.02);
    s.views.count = 4 + static_cast<int>(random.index(12));
    s.views.distance = random.uniform(0.5, 1.2);
    s.views.pixelNoise = logUniform(random, 0.01, 0.3);
    s.views.outliers = random.uniform() < 0.5 ? 0 : random.uniform(0, 0.2);
    s.description = fmt::format("{}, {} patches{}, {} views at {:.2f} m, {:.3f} px, {:.0f} % false",
                                kBodyNames.at(static_cast<std::size_t>(body)), patches, s.cables ? ", cables" : "",
                                s.views.count, s.views.distance, s.views.pixelNoise, 100 * s.views.outliers);
    return buildWorld(s, seed);
}

}  // namespace skincal
