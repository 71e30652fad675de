#include "core/simulation/scenario.h"

#include <algorithm>
#include <cmath>

namespace skincal {
namespace {

Scenario base(std::string name, std::string description) {
    Scenario s;
    s.name = std::move(name);
    s.description = std::move(description);
    s.camera = simulatedWebcam();
    return s;
}

PatchPlan onCylinder(double radius, double angle, double along, std::size_t modules) {
    PatchPlan plan;
    plan.surface = SurfaceKind::Cylinder;
    plan.radius = radius;
    plan.offset = {radius * angle, along};
    plan.modules = modules;
    return plan;
}

PatchPlan onSurface(SurfaceKind kind, double x, double y, std::size_t modules) {
    PatchPlan plan;
    plan.surface = kind;
    plan.radius = 0.06;
    plan.offset = {x, y};
    plan.modules = modules;
    return plan;
}

Scenario cylinder() {
    Scenario s = base("cylinder", "four patches round a cylinder of 80 mm radius, joined by cables");
    for (int k = 0; k < 4; ++k)
        s.patches.push_back(onCylinder(0.08, k * 90 * kDegree, 0, 14));
    s.cables = true;
    s.views.count = 16;
    return s;
}

Scenario plane() {
    Scenario s = base("plane", "three flat patches on a table: the hard case for pose estimation");
    for (int k = 0; k < 3; ++k)
        s.patches.push_back(onSurface(SurfaceKind::Plane, 0.16 * (k - 1), 0.02 * k, 12));
    return s;
}

Scenario freeForm() {
    Scenario s = base("freeform", "four patches on a smooth relief");
    for (int k = 0; k < 4; ++k)
        s.patches.push_back(onSurface(SurfaceKind::FreeForm, 0.17 * (k % 2), 0.17 * (k / 2), 19));
    s.views.count = 10;
    return s;
}

Scenario shoeSole() {
    Scenario s = base("shoe-sole", "one patch of 23 modules under a shoe, six in its middle under a business card");
    s.patches.push_back(onSurface(SurfaceKind::Sole, 0, 0, 23));
    s.patches.back().raggedness = 0;
    s.views.count = 4;
    s.views.distance = 0.5;
    s.covered = 6;
    return s;
}

/// Frames of the links of an arm with a UR5's proportions in a static pose, from its Denavit-Hartenberg parameters.
std::vector<Isometry3d> armFrames() {
    struct Dh {
        double a, d, alpha, theta;
    };
    constexpr double kRight = 90 * kDegree;
    const std::vector<Dh> rows{{0, 0.0892, kRight, 20 * kDegree},   {-0.425, 0, 0, -70 * kDegree},
                               {-0.392, 0, 0, 60 * kDegree},        {0, 0.109, kRight, -100 * kDegree},
                               {0, 0.0947, -kRight, -80 * kDegree}, {0, 0.0823, 0, 0}};
    std::vector<Isometry3d> frames;
    Isometry3d T = Isometry3d::Identity();
    for (const Dh& row : rows) {
        T = T * Eigen::AngleAxisd(row.theta, Vector3d::UnitZ()) * Eigen::Translation3d(0, 0, row.d) *
            Eigen::Translation3d(row.a, 0, 0) * Eigen::AngleAxisd(row.alpha, Vector3d::UnitX());
        frames.push_back(T);
    }
    return frames;
}

PatchPlan onArm(const Isometry3d& T_r_link, const Vector3d& middle, const Vector3d& axis, const Vector3d& facing,
                double radius, std::size_t modules) {
    PatchPlan plan;
    plan.surface = SurfaceKind::Cylinder;
    plan.radius = radius;
    plan.modules = modules;
    // The surface's y runs along the link, its z through the middle of the patch towards where cameras stand.
    const Vector3d y = (T_r_link.linear() * axis).normalized();
    const Vector3d z = (facing - facing.dot(y) * y).normalized();
    Matrix3d R;
    R << y.cross(z), y, z;
    plan.T_r_s = makeIsometry(R, T_r_link * middle);
    return plan;
}

Scenario arm(std::string name, std::string description, std::size_t perPatch) {
    Scenario s = base(std::move(name), std::move(description));
    const auto frames = armFrames();
    const Vector3d front(0.3, -1, 0.25);
    s.patches.push_back(onArm(frames[1], {0.32, 0, 0.136}, Vector3d::UnitX(), front, 0.058, perPatch));
    s.patches.push_back(onArm(frames[1], {0.12, 0, 0.136}, Vector3d::UnitX(), front, 0.055, perPatch));
    s.patches.push_back(onArm(frames[2], {0.28, 0, 0.016}, Vector3d::UnitX(), front, 0.048, perPatch));
    s.patches.push_back(onArm(frames[2], {0.08, 0, 0.016}, Vector3d::UnitX(), front, 0.045, perPatch));
    s.patches.push_back(
        onArm(frames[4], {0, 0, 0}, Vector3d::UnitY(), front, 0.040, std::min<std::size_t>(perPatch, 7)));
    s.cables = true;
    s.views.count = 10;
    s.views.distance = 0.75;
    return s;
}

Scenario mixedShapes() {
    Scenario s = base("mixed-shapes", "a patch of hexagons, one of triangles and one of rectangles");
    s.templates = {paperHexagon(), triangleTemplate(), rectangleTemplate()};
    for (std::size_t k = 0; k < 3; ++k) {
        s.patches.push_back(onCylinder(0.12, static_cast<double>(k) * 60 * kDegree, 0, 12));
        s.patches.back().type = k;
    }
    return s;
}

Scenario large() {
    Scenario s = base("thousand", "1,000 modules in twenty patches on a relief of two by two metres");
    for (int k = 0; k < 20; ++k)
        s.patches.push_back(onSurface(SurfaceKind::FreeForm, 0.34 * (k % 5), 0.34 * (k / 5), 50));
    s.views.count = 30;
    s.views.distance = 1.1;
    return s;
}

Scenario withPictures(Scenario s, std::string name, std::string description, ScanKind scan) {
    s.name = std::move(name);
    s.description = std::move(description);
    s.views.scan = scan;
    return s;
}

std::vector<Scenario> makeScenarios() {
    std::vector<Scenario> all{
        arm("demo", "an arm with a patch on each link, 55 modules, scanned in coded pictures", 12),
        arm("arm", "an arm with a patch on each link, 87 modules joined by cables", 20),
        cylinder(),
        plane(),
        freeForm(),
        shoeSole(),
        mixedShapes(),
        large()};
    all.front().views.scan = ScanKind::Coded;
    all.front().views.count = 6;

    Scenario s = freeForm();
    s.name = "outliers";
    s.description = "the free form with cables, one detection in ten false";
    s.cables = true;
    s.views.outliers = 0.1;
    all.push_back(s);

    s = freeForm();
    s.name = "faults";
    s.description = "the free form with cables and a fault of each kind: things moved, shaken, knocked and misreported";
    s.templates.push_back(rectangleTemplate());
    s.cables = true;
    s.views.count = 12;
    s.views.outliers = 0.05;
    s.faults.movedModules = 2;
    s.faults.shakenPoses = 2;
    s.faults.misportedLinks = 2;
    s.faults.bumpedViews = 1;
    s.faults.wrongTemplates = 1;
    all.push_back(s);

    s = arm("moved-joint", "the arm, a patch of which turned by 20 degrees between the gravity poses and the scan", 20);
    s.faults.movedPatches = 1;
    all.push_back(s);

    s = freeForm();
    s.name = "misaligned";
    s.description = "the free form, every accelerometer soldered on askew by half a degree about each axis";
    s.sensors.misalignment = 0.5 * kDegree;
    all.push_back(s);

    s = plane();
    s.name = "parallel-poses";
    s.description = "the plane, all poses turns about gravity: too little to tell how patches are bent";
    s.sensors.parallelPoses = true;
    all.push_back(s);

    Scenario small = base("", "");
    for (int k = 0; k < 2; ++k)
        small.patches.push_back(onSurface(SurfaceKind::FreeForm, 0.15 * k, 0, 7));
    small.views.count = 3;
    small.views.distance = 0.5;
    all.push_back(withPictures(small, "one-at-a-time", "two patches of seven, each LED alone between backgrounds",
                               ScanKind::OneAtATime));
    all.push_back(withPictures(small, "coloured", "two patches of seven, up to seven LEDs at once in native colours",
                               ScanKind::Coloured));
    Scenario coded = withPictures(small, "coded", "two patches of seven, every LED blinking a word", ScanKind::Coded);
    all.push_back(coded);
    coded.name = "reflection";
    coded.description = "coded pictures beside a surface that mirrors the LEDs";
    coded.disturbances.reflection = 0.3;
    all.push_back(coded);
    coded.disturbances = {};
    Scenario mirror = coded;
    mirror.name = "mirror";
    mirror.description =
        "coded pictures of two patches of 19 above a surface that mirrors many of their LEDs half as bright";
    for (PatchPlan& patch : mirror.patches)
        patch.modules = 19;
    mirror.views.distance = 0.6;
    mirror.views.count = 5;
    mirror.disturbances.reflection = 0.4;
    all.push_back(mirror);
    coded.name = "flicker";
    coded.description = "coded pictures under a lamp that flickers with the mains";
    coded.disturbances.flicker = 25;
    all.push_back(coded);
    coded.disturbances = {};
    coded.name = "person";
    coded.description = "coded pictures while somebody walks through";
    coded.disturbances.person = true;
    coded.views.count = 6;
    all.push_back(coded);
    coded.views.count = small.views.count;
    coded.disturbances = {};
    coded.name = "occluder";
    coded.description = "coded pictures with something in front of part of the skin";
    coded.disturbances.occluder = true;
    all.push_back(coded);
    coded.disturbances = {};
    coded.name = "bumped-camera";
    coded.description = "coded pictures, the camera knocked half-way through every second view";
    coded.disturbances.bump_px = 6;
    all.push_back(coded);
    return all;
}

}  // namespace

CameraModel simulatedWebcam() {
    CameraModel camera;
    camera.width = 1280;
    camera.height = 720;
    camera.fx = 1100;
    camera.fy = 1102;
    camera.cx = 641.5;
    camera.cy = 357.8;
    camera.distortion = {-0.10, 0.05, 0.0005, -0.0003, 0.0};
    return camera;
}

const std::vector<Scenario>& builtInScenarios() {
    static const std::vector<Scenario> scenarios = makeScenarios();
    return scenarios;
}

const Scenario* findScenario(std::string_view name) {
    const auto& all = builtInScenarios();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Scenario& s) { return s.name == name; });
    return found == all.end() ? nullptr : &*found;
}

}  // namespace skincal
