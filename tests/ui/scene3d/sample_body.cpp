#include "tests/ui/scene3d/sample_body.h"

#include <cmath>

namespace skincal {
namespace {

constexpr double kPitch = 0.027785;

/// Looking at `target` from `eye`, the picture's upper edge towards `up`.
Isometry3d cameraAt(const Vector3d& eye, const Vector3d& target, const Vector3d& up) {
    Matrix3d R;
    const Vector3d z = (target - eye).normalized();
    const Vector3d x = z.cross(up).normalized();
    R << x, z.cross(x), z;
    return makeIsometry(R, eye);
}

BodyModule moduleAt(std::uint32_t id, std::uint32_t patch, const Isometry3d& T_o_u, const Isometry3d& T_r_o) {
    BodyModule module;
    module.id = ModuleId(id);
    module.type = paperHexagon().name;
    module.patch = PatchId(patch);
    module.T_patch_module = T_o_u;
    module.T_body_module = T_r_o * T_o_u;
    const double sigma = 0.1e-3 * (1 + 0.25 * id);
    Vector6d variances;
    variances << 1e-6, 1e-6, 1e-6, sigma * sigma, sigma * sigma, 9 * sigma * sigma;
    module.covariance = variances.asDiagonal();
    module.status = Sentence::saying("placed");
    module.seen = true;
    return module;
}

}  // namespace

BodyModel sampleBody() {
    BodyModel body;
    body.templates.push_back(paperHexagon());
    const Isometry3d T_r_flat = makeIsometry(so3Exp(Vector3d(0, 0, 0.1)), Vector3d(-0.05, 0, 0));
    BodyPatch flat{PatchId(0), ModuleId(1), {}, T_r_flat, {"front", "left"}, Sentence::saying("placed")};
    for (std::uint32_t k = 0; k < 7; ++k) {
        const double angle = (60.0 * k + 30) * kDegree;
        const Vector3d place =
            k == 0 ? Vector3d(0, 0, 0) : Vector3d(kPitch * Vector3d(std::cos(angle), std::sin(angle), 0));
        body.modules.push_back(moduleAt(k + 1, 0, makeIsometry(Matrix3d::Identity(), place), T_r_flat));
        flat.modules.emplace_back(k + 1);
    }
    body.patches.push_back(flat);

    constexpr double kRadius = 0.05;
    const Isometry3d T_r_strip = makeIsometry(so3Exp(Vector3d(0, 0.3, 0)), Vector3d(0.07, 0.01, 0));
    BodyPatch strip{PatchId(1), ModuleId(11), {}, T_r_strip, {"left"}, Sentence::saying("placed")};
    for (std::uint32_t k = 0; k < 6; ++k) {
        const double angle = (k - 2.5) * kPitch / kRadius;
        const Matrix3d R = so3Exp(Vector3d(-angle, 0, 0));
        const Vector3d place(0, kRadius * std::sin(angle), kRadius * (std::cos(angle) - 1));
        body.modules.push_back(moduleAt(k + 11, 1, makeIsometry(R, place), T_r_strip));
        strip.modules.emplace_back(k + 11);
    }
    body.patches.push_back(strip);

    BodyView front{"front", cameraAt({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0}), 0.1, {}, Sentence::saying("placed")};
    BodyView left{"left", cameraAt({-0.3, 0.1, 0.4}, {0, 0, 0}, {0, 1, 0}), 0.1, {}, Sentence::saying("placed")};
    for (const BodyModule& module : body.modules) {
        BodyObservation observation;
        observation.module = module.id;
        observation.pixel = Vector2d(100, 100);
        observation.residual = Vector2d(0.02 * module.id.value, 0);
        left.observations.push_back(observation);
        if (*module.patch == PatchId(0))
            front.observations.push_back(observation);
    }
    body.views = {front, left};
    body.quality.modulesPlaced = body.quality.modulesTotal = body.modules.size();
    return body;
}

BodyModel sampleBodyWithoutPictures() {
    BodyModel body = sampleBody();
    body.views.clear();
    for (BodyPatch& patch : body.patches) {
        patch.T_body_patch.reset();
        patch.views.clear();
    }
    for (BodyModule& module : body.modules) {
        module.T_body_module.reset();
        module.covariance.reset();
        module.seen = false;
    }
    body.quality.modulesPlaced = 0;
    return body;
}

BodyModel sheetOf(std::size_t modules) {
    BodyModel body;
    body.templates.push_back(paperHexagon());
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(modules))));
    BodyPatch patch{PatchId(0), ModuleId(1), {}, Isometry3d::Identity(), {}, Sentence::saying("placed")};
    for (std::size_t i = 0; i < modules; ++i) {
        const std::size_t row = i / columns;
        const Vector3d place(kPitch * (static_cast<double>(i % columns) + (row % 2 == 0 ? 0 : 0.5)),
                             kPitch * 0.866 * static_cast<double>(row), 0);
        body.modules.push_back(moduleAt(static_cast<std::uint32_t>(i + 1), 0, makeIsometry(Matrix3d::Identity(), place),
                                        Isometry3d::Identity()));
        patch.modules.emplace_back(static_cast<std::uint32_t>(i + 1));
    }
    body.patches.push_back(patch);
    return body;
}

}  // namespace skincal
