#include "core/study/scan_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/geometry/random.h"
#include "core/simulation/renderer.h"

namespace skincal {
namespace {

constexpr std::size_t kPatch = 50;

/// A patch whose modules hardly see the camera: it faces what is below it in the picture.
void turnToMirror(PatchPlan& patch) {
    patch.T_r_s = makeIsometry(Eigen::AngleAxisd(95 * kDegree, Vector3d::UnitX()).toRotationMatrix(),
                               {patch.offset.x(), patch.offset.y(), 0});
    patch.offset.setZero();
}

void disturb(Scenario& scenario, const ScanCase& what) {
    DisturbanceOptions& disturbances = scenario.disturbances;
    switch (what.disturbance) {
        case Disturbance::None:
        case Disturbance::Crowding:
            break;
        case Disturbance::Ambient:
            scenario.pictures.background = what.strength;
            break;
        case Disturbance::Reflection:
            disturbances.reflection = what.strength;
            break;
        case Disturbance::Hidden:
            disturbances.reflection = what.strength;
            disturbances.occluder = true;
            turnToMirror(scenario.patches.back());
            break;
        case Disturbance::Screen:
            disturbances.screen = what.strength;
            break;
        case Disturbance::Mains50:
            disturbances.flicker = what.strength;
            break;
        case Disturbance::Mains60:
            disturbances.flicker = what.strength;
            disturbances.flickerHz = 120;
            break;
        case Disturbance::Sun:
            disturbances.sun = what.strength;
            break;
        case Disturbance::Person:
            disturbances.person = what.strength > 0;
            break;
        case Disturbance::Exposure:
            disturbances.exposureStep = what.strength;
            break;
        case Disturbance::Bump:
            disturbances.bump_px = what.strength;
            break;
        case Disturbance::Focus:
            scenario.pictures.blur_px = what.strength;
            break;
    }
}

ModuleTemplate shrunk(ModuleTemplate type, double scale) {
    for (Vector2d& corner : type.outline)
        corner *= scale;
    type.led *= scale;
    for (Vector3d& port : type.ports)
        port *= scale;
    if (type.accelerometer)
        *type.accelerometer *= scale;
    for (SensorSite& site : type.sensors)
        site.position *= scale;
    return type;
}

/// As many patches as the modules need, side by side where the camera sees them.
/// @param widest  m between modules
void layPatches(Scenario& scenario, const ScanCase& what, double widest) {
    const double metresPerPixel = what.distance / scenario.camera.fx;
    const double width = 0.86 * scenario.camera.width * metresPerPixel;
    const double height = 0.86 * scenario.camera.height * metresPerPixel;
    const std::size_t patches = (what.modules + kPatch - 1) / kPatch;
    const auto columns =
        static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(patches) * width / height) - 1e-9));
    const std::size_t rows = (patches + columns - 1) / columns;
    const ModuleTemplate hexagon = paperHexagon();
    constexpr double kPitch = 27.785e-3;
    // A round patch of n hexagons is about 1.1 sqrt(n) pitches wide; one more keeps patches apart.
    const double wide = 1.1 * std::sqrt(static_cast<double>(std::min(what.modules, kPatch))) + 1;
    double pitch =
        std::min({kPitch, width / static_cast<double>(columns) / wide, height / static_cast<double>(rows) / wide});
    pitch = std::min(pitch, widest);
    scenario.templates = {shrunk(hexagon, pitch / kPitch)};
    scenario.play.position *= pitch / kPitch;
    std::size_t left = what.modules;
    for (std::size_t k = 0; k < patches; ++k) {
        PatchPlan plan;
        plan.surface = SurfaceKind::FreeForm;
        plan.radius = 0.06 * pitch / kPitch;
        plan.modules = std::min(left, (what.modules + patches - 1) / patches);
        left -= plan.modules;
        const double step = wide * pitch;
        plan.offset = {(static_cast<double>(k % columns) - 0.5 * static_cast<double>(columns - 1)) * step,
                       (static_cast<double>(k / columns) - 0.5 * static_cast<double>(rows - 1)) * step};
        scenario.patches.push_back(plan);
    }
}

Isometry3d cameraAbove(double distance, std::uint64_t seed) {
    Random random(seed, "scan study");
    const Vector3d axis(0.0, 0.0, 1.0);
    const Vector3d aside =
        so3Exp(12 * kDegree * random.uniform() * Vector3d(random.normal(), random.normal(), 0).normalized()) * axis;
    // Looking down on the skin, x of the picture along x of the skin.
    Matrix3d R;
    R.col(2) = -aside;
    R.col(0) = (Vector3d::UnitX() - Vector3d::UnitX().dot(aside) * aside).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    return makeIsometry(R, distance * aside);
}

World laidOut(const ScanCase& what, std::uint64_t seed, double widest) {
    Scenario scenario;
    scenario.name = "scan-study";
    scenario.camera = simulatedWebcam();
    layPatches(scenario, what, widest);
    // Who scans from near by turns the exposure down, until few LEDs are clipped.
    constexpr double kBright = 0.6;
    scenario.pictures.ledPeak *= std::min(1.0, std::pow(what.distance / kBright, 2));
    scenario.views.count = 0;
    disturb(scenario, what);
    World world = buildWorld(scenario, seed);
    const Isometry3d T_r_v = cameraAbove(what.distance, seed);
    world.T_r_v = {T_r_v, T_r_v};
    return world;
}

/// From any LED that the camera sees to the nearest other; nothing where it sees no two.
std::optional<double> spacing_px(const World& world) {
    std::vector<Vector2d> pixels;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        if (const auto pixel = visiblePixel(world, world.T_r_v[kScanView], kScanView, u, visibilityOfLight()))
            pixels.push_back(*pixel);
    }
    std::optional<double> nearest;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double apart = (pixels[i] - pixels[j]).norm();
            nearest = std::min(nearest.value_or(apart), apart);
        }
    }
    return nearest;
}

}  // namespace

World scanWorld(const ScanCase& what, std::uint64_t seed) {
    if (what.disturbance != Disturbance::Crowding)
        return laidOut(what, seed, std::numeric_limits<double>::max());
    // LEDs sit off the middles of boards that are turned against each other: nearer than the boards.
    const double widest = what.strength * what.distance / simulatedWebcam().fx;
    World world = laidOut(what, seed, widest);
    const std::optional<double> spacing = spacing_px(world);
    return spacing ? laidOut(what, seed, widest * what.strength / *spacing) : world;
}

}  // namespace skincal
