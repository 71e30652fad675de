#include "core/study/scan_study.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/geometry/random.h"
#include "core/simulation/renderer.h"
#include "core/study/centre_bound.h"
#include "core/vision/decoder.h"
#include "core/vision/further_looks.h"
#include "core/vision/paper_detector.h"

namespace skincal {
namespace {

constexpr std::size_t kView = 1;
constexpr std::size_t kPatch = 50;

struct Named {
    Disturbance disturbance;
    std::string_view name;
    std::vector<double> strengths;
};

const std::vector<Named>& disturbances() {
    static const std::vector<Named> all{
        {Disturbance::None, "none", {0}},
        {Disturbance::Ambient, "ambient", {0, 30, 120, 200, 240, 300}},
        {Disturbance::Reflection, "reflection", {0.1, 0.3, 0.5, 0.7, 0.9}},
        {Disturbance::Screen, "screen", {20, 60, 120, 250}},
        {Disturbance::Mains50, "mains50", {10, 25, 50, 100}},
        {Disturbance::Mains60, "mains60", {10, 25, 50, 100}},
        {Disturbance::Sun, "sun", {0.1, 0.3, 1, 2}},
        {Disturbance::Person, "person", {1}},
        {Disturbance::Exposure, "exposure", {0.1, 0.3, 0.5, 0.7}},
        {Disturbance::Bump, "bump", {0.5, 2, 6, 20}},
        {Disturbance::Crowding, "crowding", {12, 8, 6, 4, 3}},
    };
    return all;
}

const Named& named(Disturbance disturbance) {
    return *std::find_if(disturbances().begin(), disturbances().end(),
                         [&](const Named& entry) { return entry.disturbance == disturbance; });
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

// Where a module's LED shows: one place, or two in a view whose camera is knocked.
std::vector<Vector2d> placesOf(const World& world, std::size_t module) {
    std::vector<Isometry3d> poses{world.T_r_v[kView]};
    if (world.scenario.disturbances.bump_px > 0)
        poses.push_back(poses.front() * makeIsometry(bumpOf(world.scenario), Vector3d::Zero()));
    std::vector<Vector2d> places;
    for (const Isometry3d& T_r_v : poses) {
        const Vector3d led_v = T_r_v.inverse() * (world.T_r_u[module] * world.trueTemplate(module).led);
        if (const auto pixel = world.scenario.camera.project(led_v))
            places.push_back(*pixel);
    }
    return places;
}

double distanceTo(const std::vector<Vector2d>& places, const Vector2d& pixel) {
    double nearest = 1e9;
    for (const Vector2d& place : places)
        nearest = std::min(nearest, (place - pixel).norm());
    return nearest;
}

// A room that changes has no level that noise could be told from.
bool isSteady(Disturbance disturbance) {
    return disturbance == Disturbance::None || disturbance == Disturbance::Ambient ||
           disturbance == Disturbance::Crowding;
}

void score(const World& world, const ViewDetections& view, const std::vector<std::optional<double>>& bounds,
           ScanScore& result) {
    const auto index = world.skin.indexById();
    std::vector<bool> visible(world.T_r_u.size());
    for (std::size_t u = 0; u < visible.size(); ++u) {
        visible[u] = visiblePixel(world, kView, u).has_value();
        result.visible += visible[u] ? 1U : 0U;
    }
    std::vector<std::vector<Vector2d>> placesOfAll(world.T_r_u.size());
    for (std::size_t u = 0; u < placesOfAll.size(); ++u) {
        if (visible[u])
            placesOfAll[u] = placesOf(world, u);
    }
    const auto isNearerToAnother = [&](std::size_t own, const Vector2d& pixel, double error) {
        for (std::size_t u = 0; u < placesOfAll.size(); ++u) {
            if (u != own && distanceTo(placesOfAll[u], pixel) < error)
                return true;
        }
        return false;
    };
    for (const LedDetection& found : view.found) {
        const std::size_t u = index.at(found.module);
        const std::vector<Vector2d> places = placesOf(world, u);
        const double error = distanceTo(places, found.pixel);
        // Where they are a few pixels apart, that is little; errors are hundredths elsewhere.
        constexpr double kNear_px = 0.5;
        if (error > ScanScore::kElsewhere_px || (error > kNear_px && isNearerToAnother(u, found.pixel, error))) {
            ++result.wrong;
        } else if (visible[u]) {
            ++result.found;
            result.squaredError += error * error;
            result.squaredSigmas += error * error / (found.sigma_px * found.sigma_px);
            if (!bounds.empty() && bounds[u]) {
                ++result.sharp;
                result.squaredBounds += error * error / (*bounds[u] * *bounds[u]);
                result.sharpSigmas += error * error / (found.sigma_px * found.sigma_px);
            }
        }
    }
    for (const Undetected& missing : view.undetected) {
        const std::size_t u = index.at(missing.module);
        const std::vector<Vector2d> places = placesOf(world, u);
        const bool handedOn = std::any_of(missing.spots.begin(), missing.spots.end(), [&](const SpotChoice& spot) {
            return distanceTo(places, spot.pixel) <= ScanScore::kElsewhere_px;
        });
        result.choices += visible[u] && handedOn ? 1U : 0U;
    }
}

}  // namespace

std::string_view name(Disturbance disturbance) {
    return named(disturbance).name;
}

std::optional<Disturbance> findDisturbance(std::string_view name) {
    for (const Named& entry : disturbances()) {
        if (entry.name == name)
            return entry.disturbance;
    }
    return std::nullopt;
}

const std::vector<double>& strengthsOf(Disturbance disturbance) {
    return named(disturbance).strengths;
}

std::string_view name(ScanMethod method) {
    switch (method) {
        case ScanMethod::Coded:
            return "coded";
        case ScanMethod::CodedOnce:
            return "coded once";
        case ScanMethod::OneAtATime:
            return "one at a time";
        case ScanMethod::PaperSingle:
            return "paper";
    }
    return "";
}

double ScanScore::foundShare() const {
    return visible > 0 ? static_cast<double>(found) / static_cast<double>(visible) : 1;
}

double ScanScore::rms_px() const {
    return found > 0 ? std::sqrt(squaredError / (2 * static_cast<double>(found))) : 0;
}

double ScanScore::rmsSigmas() const {
    return found > 0 ? std::sqrt(squaredSigmas / (2 * static_cast<double>(found))) : 0;
}

double ScanScore::rmsBounds() const {
    return sharp > 0 ? std::sqrt(squaredBounds / (2 * static_cast<double>(sharp))) : 0;
}

void ScanScore::add(const ScanScore& other) {
    views += other.views;
    frames += other.frames;
    visible += other.visible;
    found += other.found;
    choices += other.choices;
    wrong += other.wrong;
    squaredError += other.squaredError;
    squaredSigmas += other.squaredSigmas;
    sharp += other.sharp;
    squaredBounds += other.squaredBounds;
    sharpSigmas += other.sharpSigmas;
    seconds += other.seconds;
}

World scanWorld(const ScanCase& what, std::uint64_t seed) {
    Scenario scenario;
    scenario.name = "scan-study";
    scenario.camera = simulatedWebcam();
    scenario.sensors.poses = 0;
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
    if (what.disturbance == Disturbance::Crowding)
        pitch = std::min(pitch, what.strength * metresPerPixel);
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
    // Who scans from near by turns the exposure down, until few LEDs are clipped.
    constexpr double kBright = 0.6;
    scenario.pictures.ledPeak *= std::min(1.0, std::pow(what.distance / kBright, 2));
    scenario.views.count = 0;
    disturb(scenario, what);
    World world = buildWorld(scenario, seed);
    Random random(seed, "scan study");
    const Vector3d axis(0.0, 0.0, 1.0);
    const Vector3d aside =
        so3Exp(12 * kDegree * random.uniform() * Vector3d(random.normal(), random.normal(), 0).normalized()) * axis;
    // Looking down on the skin, x of the picture along x of the skin.
    Matrix3d R;
    R.col(2) = -aside;
    R.col(0) = (Vector3d::UnitX() - Vector3d::UnitX().dot(aside) * aside).normalized();
    R.col(1) = R.col(2).cross(R.col(0));
    const Isometry3d T_r_v = makeIsometry(R, what.distance * aside);
    world.T_r_v = {T_r_v, T_r_v};
    return world;
}

ScanScore scoreScan(const ScanCase& what, std::uint64_t seed, const RunContext& context) {
    return scoreScan(scanWorld(what, seed), what, context);
}

ScanScore scoreScan(World world, const ScanCase& what, const RunContext& context) {
    const bool isCoded = what.method == ScanMethod::Coded || what.method == ScanMethod::CodedOnce;
    world.scenario.views.scan = isCoded ? ScanKind::Coded : ScanKind::OneAtATime;
    std::vector<FrameInfo> frames = planScan(world, kView);
    const FrameRenderer renderer(world, kView, frames.size());
    std::vector<ModuleId> modules;
    for (const SkinModule& module : world.skin.modules)
        modules.push_back(module.id);
    // Decoders pass over the pictures several times: they are kept where that is a few, else painted anew.
    constexpr std::size_t kKept = 300;
    std::vector<cv::Mat> pictures(frames.size() <= kKept ? frames.size() : 0);
    double painting = 0;
    using Clock = std::chrono::steady_clock;
    const auto load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
        const auto start = Clock::now();
        cv::Mat picture = pictures.empty() ? cv::Mat() : pictures[k];
        if (picture.empty())
            picture = renderer.render(frames[k].lit, k);
        if (!pictures.empty())
            pictures[k] = picture;
        painting += std::chrono::duration<double>(Clock::now() - start).count();
        return picture;
    };
    ScanScore result;
    const auto decode = [&](const ViewDetections* before, std::size_t first) {
        painting = 0;
        const auto start = Clock::now();
        auto view = before != nullptr ? decodeFurther(*before, first, modules, frames, load, {}, context)
                    : what.method == ScanMethod::PaperSingle ? detectPaper("view", modules, frames, load, {}, context)
                                                             : decodeView("view", modules, frames, load, {}, context);
        if (!view && !view.error().cancelled)
            throw std::logic_error("a scan of the study can't be decoded: " + view.error().message.english());
        result.seconds = std::chrono::duration<double>(Clock::now() - start).count() - painting;
        return view;
    };
    auto view = decode(nullptr, 0);
    FurtherLooks further(kView);
    while (view && what.method == ScanMethod::Coded) {
        const auto look = further.next(*view);
        if (!look)
            break;
        const std::size_t first = frames.size();
        for (const auto& lit : *look)
            frames.push_back({{}, lit, {}, further.looks()});
        if (!pictures.empty())
            pictures.resize(frames.size());
        view = decode(&*view, first);
    }
    if (!view)
        return {};
    result.views = 1;
    result.frames = frames.size();
    std::vector<std::optional<double>> bounds;
    if (isSteady(what.disturbance) && !pictures.empty()) {
        // Not every detector has looked at all of them.
        for (std::size_t k = 0; k < frames.size(); ++k)
            (void)load(k);
        bounds = centreBounds(world, renderer.spots(), frames, pictures);
    }
    score(world, *view, bounds, result);
    return result;
}

bool ScanStudyOptions::validate() const {
    return !cases.empty() && seeds > 0 && seeds <= 100'000 &&
           std::all_of(cases.begin(), cases.end(), [](const ScanCase& what) {
               return what.modules > 0 && what.modules <= 20'000 && what.distance >= 0.2 && what.distance <= 5;
           });
}

std::vector<ScanCase> allScanCases() {
    std::vector<ScanCase> cases;
    for (const Named& entry : disturbances()) {
        for (const double strength : entry.strengths) {
            for (const ScanMethod method : {ScanMethod::Coded, ScanMethod::OneAtATime, ScanMethod::PaperSingle})
                cases.push_back({entry.disturbance, strength, 55, 0.8, method});
        }
    }
    for (const std::size_t modules : {7, 200, 1000, 10'000}) {
        for (const double distance : {0.3, 0.8, 2.0})
            cases.push_back({Disturbance::None, 0, modules, distance, ScanMethod::Coded});
    }
    for (const Named& entry : disturbances()) {
        if (entry.disturbance == Disturbance::None || entry.disturbance == Disturbance::Crowding)
            continue;
        for (const std::size_t modules : {7, 1000})
            cases.push_back(
                {entry.disturbance, entry.strengths[entry.strengths.size() / 2], modules, 0.8, ScanMethod::Coded});
    }
    return cases;
}

ScanStudy runScanStudy(const ScanStudyOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("ScanStudyOptions out of range");
    ScanStudy study{options, {}, false};
    const double all = static_cast<double>(options.cases.size()) * options.seeds;
    RunContext silent;
    silent.isCancelled = context.isCancelled;
    double done = 0;
    for (const ScanCase& what : options.cases) {
        ScanStudyRow row{what, {}};
        for (int i = 0; i < options.seeds; ++i) {
            context.report(Sentence::saying("scanning"), done++ / all);
            row.score.add(scoreScan(what, options.firstSeed + static_cast<std::uint64_t>(i), silent));
            if (context.isCancelled()) {
                study.cancelled = true;
                return study;
            }
        }
        study.rows.push_back(std::move(row));
    }
    return study;
}

}  // namespace skincal
