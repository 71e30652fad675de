// The joint estimate from measurements alone, as a user gets it, on skins that grow while every module is seen by about
// as many views. 100,000 modules take minutes: choose sizes with --benchmark_filter='calibrate/10000'.
//   s_per_module  seconds of calibrateJoint per module
//   ratio         that against 1,000 modules in the same process: 1 where time grows linearly
//   peak_MB       most memory that the process ever held during the run, the simulated world included
//   sightings     detections per module, those of the border's fewer than the others'

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/estimation/joint_method.h"
#include "core/geometry/random.h"
#include "core/simulation/world.h"

namespace {

using namespace skincal;

constexpr std::size_t kPerPatch = 50;
constexpr double kPitch = 0.34;      // m, from patch to patch
constexpr double kDistance = 1.5;    // m, from which a picture shows some fifteen patches
constexpr double kWindowWide = 1.7;  // m, that it shows
constexpr double kWindowHigh = 1.0;

/// Where of `count` places along `length` number i is, the first and the last so far inside that windows do not look
/// far beyond the ends.
double placeAlong(double length, double window, std::size_t i, std::size_t count) {
    const double margin = std::min(0.5 * length, 0.3 * window);
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
    return margin + share * (length - 2 * margin);
}

/// Cameras in rows over the skin, each tilted its own way, so that neighbouring pictures overlap by half.
void placeCameras(World& world, std::size_t views, const Vector2d& size) {
    const double rowsWanted =
        std::sqrt(static_cast<double>(views) * kWindowWide / kWindowHigh * (size.y() + kPitch) / (size.x() + kPitch));
    const auto rows = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(rowsWanted)));
    Random random(world.seed, "benchmark cameras");
    for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t first = row * views / rows;
        const std::size_t count = (row + 1) * views / rows - first;
        for (std::size_t i = 0; i < count; ++i) {
            const Vector3d target(placeAlong(size.x(), kWindowWide, i, count),
                                  placeAlong(size.y(), kWindowHigh, row, rows), 0);
            const Matrix3d facing = Eigen::AngleAxisd(180 * kDegree, Vector3d::UnitX()).toRotationMatrix();
            const Matrix3d R_r_v =
                so3Exp(random.uniform(5, 25) * kDegree * Vector3d(random.normal(), random.normal(), 0).normalized()) *
                facing;
            world.T_r_v.push_back(makeIsometry(R_r_v, target - kDistance * random.uniform(0.9, 1.1) * R_r_v.col(2)));
        }
    }
}

/// Patches of 50 modules on a relief, wired in rows to and fro; one view for each 167 modules, but at least four: from
/// fewer, two patches are hardly ever seen together.
World worldOf(std::size_t modules) {
    Scenario scenario = *findScenario("thousand");
    scenario.patches.clear();
    const std::size_t patches = modules / kPerPatch;
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(patches))));
    for (std::size_t k = 0; k < patches; ++k) {
        const std::size_t row = k / columns;
        const std::size_t along = row % 2 == 0 ? k % columns : columns - 1 - k % columns;
        PatchPlan plan;
        plan.surface = SurfaceKind::FreeForm;
        plan.radius = 0.06;
        plan.offset = kPitch * Vector2d(static_cast<double>(along), static_cast<double>(row));
        plan.modules = kPerPatch;
        scenario.patches.push_back(plan);
    }
    scenario.cables = true;
    scenario.views.count = 0;
    World world = buildWorld(scenario, 1);
    const auto views = std::max<std::size_t>(4, (6 * modules + 500) / 1000);
    placeCameras(world, views,
                 kPitch * Vector2d(static_cast<double>(columns - 1), static_cast<double>((patches - 1) / columns)));
    return world;
}

/// A field of /proc/self/status in MB; 0 where there is no such file.
double statusOf(const std::string& field) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with(field + ":"))
            return std::stod(line.substr(field.size() + 1)) / 1024;
    }
    return 0;
}

void forgetPeak() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
}

struct Run {
    double seconds = 0;
    BodyModel body;
};

Run run(const Measurements& measurements) {
    const auto start = std::chrono::steady_clock::now();
    auto body = calibrateJoint(measurements);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!body)
        throw std::logic_error("the joint estimate failed");
    return {seconds, std::move(*body)};
}

Measurements measurementsOf(std::size_t modules) {
    const World world = worldOf(modules);
    return {world.skin, simulateGravity(world), world.scenario.camera, simulateDetections(world)};
}

/// Seconds per module at 1,000 modules, measured once: by the benchmark of that size or beforehand.
std::optional<double> referencePerModule;
constexpr std::size_t kReference = 1000;

void calibrate(benchmark::State& state) {
    const auto modules = static_cast<std::size_t>(state.range(0));
    if (!referencePerModule && modules != kReference)
        referencePerModule = run(measurementsOf(kReference)).seconds / static_cast<double>(kReference);
    forgetPeak();
    const Measurements measurements = measurementsOf(modules);
    double seconds = 0;
    BodyModel body;
    for ([[maybe_unused]] auto iteration : state) {
        Run latest = run(measurements);
        state.SetIterationTime(latest.seconds);
        seconds += latest.seconds;
        body = std::move(latest.body);
    }
    const double perModule = seconds / static_cast<double>(state.iterations()) / static_cast<double>(modules);
    if (!referencePerModule)
        referencePerModule = perModule;
    double iterations = 0;
    for (const StageReport& stage : body.quality.stages) {
        iterations += stage.iterations;
        state.counters[stage.stage + "_s"] += stage.seconds;
    }
    double detections = 0;
    double views = 0;
    for (const BodyView& view : body.views) {
        detections += static_cast<double>(view.observations.size());
        views += view.T_body_camera ? 1 : 0;
    }
    state.counters["s_per_module"] = perModule;
    state.counters["ratio"] = perModule / *referencePerModule;
    state.counters["peak_MB"] = statusOf("VmHWM");
    state.counters["placed"] = static_cast<double>(body.quality.modulesPlaced);
    state.counters["views"] = static_cast<double>(body.views.size());
    state.counters["views_placed"] = views;
    state.counters["sightings"] = detections / static_cast<double>(modules);
    state.counters["iterations"] = iterations;
}
BENCHMARK(calibrate)->Arg(100)->Arg(1000)->Arg(10000)->Arg(100000)->Iterations(1)->UseManualTime()->Unit(
    benchmark::kSecond);

}  // namespace
