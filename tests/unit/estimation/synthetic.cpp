#include "tests/unit/estimation/synthetic.h"

#include <algorithm>
#include <stdexcept>

namespace skincal {
namespace {

constexpr double kPi = 180 * kDegree;

/// Pose of a side of the prism: `step` sides round from the top.
Isometry3d sideOf(const PrismPatch& patch, double halfWidth, int step, double y) {
    if (patch.radius <= 0)
        return makeIsometry(Matrix3d::Identity(), {2 * halfWidth * step, y, 0});
    const double angle = 2 * std::atan(halfWidth / patch.radius) * step;
    const Matrix3d R = Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
    return makeIsometry(R, R * Vector3d(0, 0, patch.radius) + Vector3d(0, y, -patch.radius));
}

void addPatch(PrismPatch patch, std::size_t index, SyntheticWorld& world) {
    Skin& skin = world.measurements.skin;
    const auto first = static_cast<std::uint32_t>(skin.modules.size());
    const std::size_t type = patch.rectangles ? 1 : 0;
    const auto& ports = skin.templates[type].ports;
    if (patch.ring)
        patch.radius = ports[0].x() / std::tan(kPi / patch.columns);
    for (int row = 0; row < patch.rows; ++row) {
        for (int column = 0; column < patch.columns; ++column) {
            // Hexagons touch slantwise: a step along either direction of the grid is one side further round.
            const int step = patch.rectangles ? column : column + row;
            const double y = patch.rectangles ? 2 * ports[1].y() * row : 2 * ports[0].y() * (column - row);
            const auto id = first + static_cast<std::uint32_t>(row * patch.columns + column) + 1;
            skin.modules.push_back({ModuleId(id), type});
            world.T_r_u.push_back(patch.T_r_s * sideOf(patch, ports[0].x(), step, y));
            world.patchOf.push_back(index);
            const int behind = patch.rectangles ? 2 : 3;
            const int opposite = patch.rectangles ? 3 : 2;
            if (column + 1 < patch.columns)
                skin.links.push_back({ModuleId(id), 0, ModuleId(id + 1), behind});
            else if (patch.ring)
                skin.links.push_back(
                    {ModuleId(id), 0, ModuleId(id + 1 - static_cast<unsigned>(patch.columns)), behind});
            if (row + 1 < patch.rows)
                skin.links.push_back({ModuleId(id), 1, ModuleId(id + static_cast<unsigned>(patch.columns)), opposite});
        }
    }
}

void addGravity(Random& random, const SyntheticOptions& options, SyntheticWorld& world) {
    for (int p = 0; p < options.poses; ++p)
        world.up_r.push_back(random.direction());
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const AccelerometerCalibration calibration{random.normal3() * options.bias,
                                                   Vector3d::Ones() + random.normal3() * options.scale};
        world.accelerometers.push_back(calibration);
        for (int p = 0; p < options.poses; ++p) {
            const Vector3d a = world.T_r_u[u].linear().transpose() * world.up_r[static_cast<std::size_t>(p)];
            world.measurements.gravity.push_back({p, world.measurements.skin.modules[u].id,
                                                  calibration.scale.cwiseProduct(a * kStandardGravity) +
                                                      calibration.bias +
                                                      random.normal3() * options.accelerometerNoise});
        }
    }
}

void addViews(Random& random, const SyntheticOptions& options, SyntheticWorld& world) {
    Vector3d centre = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    for (const Isometry3d& T : world.T_r_u) {
        centre += T.translation() / static_cast<double>(world.T_r_u.size());
        normal += T.linear().col(2);
    }
    for (int v = 0; v < options.views; ++v) {
        const Vector3d axis = random.direction().cross(normal).normalized();
        const Vector3d from = so3Exp(axis * random.uniform(0.3, 1) * options.viewTilt) * normal.normalized();
        world.T_r_v.push_back(lookAt(centre + from * options.distance, centre, random.uniform(-kPi, kPi)));
        ViewDetections view = seenFrom(world, world.T_r_v.back());
        view.name = "view" + std::to_string(v);
        for (LedDetection& detection : view.found) {
            detection.sigma_px = options.pixelNoise > 0 ? options.pixelNoise : 0.05;
            const Vector2d noise(random.normal(), random.normal());
            detection.pixel += noise * options.pixelNoise;
            if (random.uniform() < options.outliers) {
                detection.pixel += random.uniform(40, 200) * noise.normalized();
                world.outliers.emplace_back(static_cast<std::size_t>(v), detection.module);
            }
        }
        world.measurements.views.push_back(std::move(view));
    }
}

}  // namespace

CameraModel syntheticCamera(bool distorted) {
    CameraModel camera;
    camera.width = 1280;
    camera.height = 720;
    camera.fx = 905;
    camera.fy = 900;
    camera.cx = 642;
    camera.cy = 357;
    if (distorted)
        camera.distortion = {0.08, -0.15, 0.001, -0.0005, 0.02};
    return camera;
}

Isometry3d lookAt(const Vector3d& position, const Vector3d& target, double roll) {
    Matrix3d R;
    R.col(2) = (target - position).normalized();
    R.col(0) = R.col(2).unitOrthogonal();
    R.col(1) = R.col(2).cross(R.col(0));
    return makeIsometry(R * so3Exp(Vector3d(0, 0, roll)), position);
}

ViewDetections seenFrom(const SyntheticWorld& world, const Isometry3d& T_r_v, const std::vector<bool>& wanted) {
    ViewDetections view;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const Vector3d led_r = world.T_r_u[u] * world.measurements.skin.templateOf(u).led;
        const Vector3d toCamera = (T_r_v.translation() - led_r).normalized();
        if ((!wanted.empty() && !wanted[u]) || world.T_r_u[u].linear().col(2).dot(toCamera) < std::cos(70 * kDegree))
            continue;
        const auto pixel = world.measurements.camera.project(T_r_v.inverse() * led_r);
        if (pixel && world.measurements.camera.contains(*pixel))
            view.found.push_back({world.measurements.skin.modules[u].id, *pixel, 0.05});
    }
    return view;
}

SyntheticWorld makeWorld(Random& random, const SyntheticOptions& options) {
    SyntheticWorld world;
    world.measurements.skin.templates = {paperHexagon(), rectangleTemplate()};
    world.measurements.camera = syntheticCamera(options.distorted);
    for (std::size_t k = 0; k < options.patches.size(); ++k)
        addPatch(options.patches[k], k, world);
    addGravity(random, options, world);
    addViews(random, options, world);
    return world;
}

BodyState SyntheticWorld::state() const {
    BodyState state;
    state.T_r_u.assign(T_r_u.begin(), T_r_u.end());
    state.T_r_v.assign(T_r_v.begin(), T_r_v.end());
    state.accelerometers = accelerometers;
    state.up_r.emplace_back(up_r.begin(), up_r.end());
    return state;
}

AdjustmentInput SyntheticWorld::input(const GravityTable& gravity) const {
    AdjustmentInput input;
    input.skin = &measurements.skin;
    input.camera = &measurements.camera;
    input.gravity = &gravity;
    const auto index = measurements.skin.indexById();
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        for (const LedDetection& detection : measurements.views[v].found)
            input.pixels.push_back({v, index.at(detection.module), detection.pixel, detection.sigma_px});
    }
    for (const Link& link : measurements.skin.links) {
        const std::size_t a = index.at(link.a);
        const std::size_t b = index.at(link.b);
        input.links.push_back({a, b, measurements.skin.templateOf(a).ports[static_cast<std::size_t>(link.a_port)],
                               measurements.skin.templateOf(b).ports[static_cast<std::size_t>(link.b_port)]});
    }
    input.gravityGroup.assign(T_r_u.size(), 0);
    return input;
}

std::vector<LedCorrespondence> patchLeds(std::size_t count, double radius) {
    SyntheticOptions options;
    const auto side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    options.patches = {PrismPatch{side, side, radius}};
    options.poses = 0;
    options.views = 0;
    Random random(1);
    const SyntheticWorld world = makeWorld(random, options);
    std::vector<LedCorrespondence> leds;
    for (std::size_t u = 0; u < count; ++u) {
        const Isometry3d T_o_u = world.T_r_u[0].inverse() * world.T_r_u[u];
        leds.push_back({T_o_u * world.measurements.skin.templateOf(u).led, T_o_u.linear().col(2), {}, 0.05});
    }
    return leds;
}

PoseDifference largestDifference(const std::vector<std::optional<Isometry3d>>& found,
                                 const std::vector<Isometry3d>& truth) {
    if (found.size() != truth.size())
        throw std::logic_error("largestDifference: sizes differ");
    PoseDifference largest;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const PoseDifference d = poseDifference(found[i].value(), truth[i]);
        largest.angle = std::max(largest.angle, d.angle);
        largest.distance = std::max(largest.distance, d.distance);
    }
    return largest;
}

Isometry3d perturbed(Random& random, const Isometry3d& T, double angle, double distance) {
    return makeIsometry(T.linear() * so3Exp(random.direction() * angle),
                        T.translation() + random.direction() * distance);
}

}  // namespace skincal
