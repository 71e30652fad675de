#include "core/study/paper_experiments.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "core/estimation/joint_method.h"
#include "core/estimation/paper_method.h"
#include "core/simulation/renderer.h"
#include "core/study/study_world.h"
#include "core/vision/decoder.h"
#include "core/vision/paper_detector.h"

namespace skincal {
namespace {

using Poses = std::vector<Isometry3d>;

/// One experiment: how its world is made and which number is read from the result.
struct Experiment {
    std::string name;
    std::string quantity;
    std::string unit;
    double factor = 1;  ///< from SI to the unit
    double truth = 0;   ///< SI
    std::optional<double> printed;
    std::function<World(std::uint64_t seed)> makeWorld;
    /// The quantity, from estimated poses and the world they were estimated in.
    std::function<double(const World&, const Poses& T_r_v, const Poses& T_r_u)> read;
    bool needViews = true;
    bool hasBound = true;
    /// What the bound is computed of: a vector, of which the quantity is the length or comes close to it. Where there
    /// is none, the quantity.
    std::function<Eigen::VectorXd(const World&, const Poses& T_r_v, const Poses& T_r_u)> vector{};
    BoundOn boundOn = BoundOn::Views;
};

class Tally {
  public:
    void add(double value, double truth) {
        ++count_;
        sum_ += value;
        squares_ += (value - truth) * (value - truth);
    }
    [[nodiscard]] MethodOutcome outcome(double factor) const {
        MethodOutcome result;
        result.solved = count_;
        if (count_ > 0) {
            result.mean = factor * sum_ / count_;
            result.rms = factor * std::sqrt(squares_ / count_);
        }
        return result;
    }

  private:
    int count_ = 0;
    double sum_ = 0;
    double squares_ = 0;
};

using Read = std::function<double(const Poses& T_r_v, const Poses& T_r_u)>;

/// The quantity in our body. Nothing where a picture could be of two poses as well, unless it is the same in both but
/// for `tolerance`: the program says that it does not know, and that is no result.
std::optional<double> ourQuantity(const Measurements& measurements, bool needViews, const Read& read,
                                  double tolerance) {
    const GravityTable gravity(measurements.skin, measurements.gravity);
    const auto solution = solveJointly(measurements, gravity);
    if (!solution || (!solution->estimate.undecidedViews.empty() && solution->rivals.empty()))
        return std::nullopt;
    const auto poses = posesOf(describeSolution(*solution, {}), needViews);
    if (!poses)
        return std::nullopt;
    const double value = read(poses->T_r_v, poses->T_r_u);
    for (const BodyState& rival : solution->rivals) {
        Poses T_r_v;
        Poses T_r_u;
        for (const auto& T : rival.T_r_v)
            T_r_v.push_back(T.value_or(Isometry3d::Identity()));
        for (const auto& T : rival.T_r_u)
            T_r_u.push_back(T.value_or(Isometry3d::Identity()));
        if (!(std::abs(read(T_r_v, T_r_u) - value) < tolerance))
            return std::nullopt;
    }
    return value;
}

std::optional<BodyModel> paperBody(const Measurements& measurements) {
    auto body = calibratePaper(measurements);
    if (!body)
        return std::nullopt;
    return *std::move(body);
}

ExperimentRow run(const Experiment& experiment, const PaperStudyOptions& options, const RunContext& context) {
    ExperimentRow row{experiment.name,
                      experiment.quantity,
                      experiment.unit,
                      experiment.truth * experiment.factor,
                      experiment.printed,
                      {},
                      {},
                      std::nullopt};
    Tally paper;
    Tally ours;
    double boundSquares = 0;
    int bounds = 0;
    for (int trial = 0; trial < options.trials && !context.isCancelled(); ++trial) {
        const World world = experiment.makeWorld(static_cast<std::uint64_t>(trial) + 1);
        const Measurements measurements = measurementsOf(world);
        const Read read = [&](const Poses& T_r_v, const Poses& T_r_u) { return experiment.read(world, T_r_v, T_r_u); };
        double tolerance = 0;
        if (experiment.hasBound) {
            const auto quantity = [&](const Poses& T_r_v, const Poses& T_r_u) -> Eigen::VectorXd {
                if (experiment.vector)
                    return experiment.vector(world, T_r_v, T_r_u);
                return Eigen::VectorXd::Constant(1, read(T_r_v, T_r_u));
            };
            const Poses T_r_v(world.T_r_v.begin(), world.T_r_v.end());
            const Poses T_r_u(world.T_r_u.begin(), world.T_r_u.end());
            if (const auto bound = boundOf(world, measurements, experiment.boundOn, quantity)) {
                const double square = meanSquareOfLength(quantity(T_r_v, T_r_u), *bound);
                tolerance = std::sqrt(square);
                boundSquares += square;
                ++bounds;
            }
        }
        const auto body = paperBody(measurements);
        if (const auto poses = body ? posesOf(*body, experiment.needViews) : std::nullopt)
            paper.add(read(poses->T_r_v, poses->T_r_u), experiment.truth);
        if (const auto value = ourQuantity(measurements, experiment.needViews, read, tolerance))
            ours.add(*value, experiment.truth);
    }
    row.paper = paper.outcome(experiment.factor);
    row.ours = ours.outcome(experiment.factor);
    if (bounds > 0)
        row.bound = experiment.factor * std::sqrt(boundSquares / bounds);
    return row;
}

/// Two views that stand for one camera and a patch that moves by `motion` in the camera's frame (about the patch).
World movedPatch(const PatchPlan& plan, double distance, const Vector3d& translation, const Vector3d& rotation,
                 std::uint64_t seed, double pixelNoise, std::optional<std::size_t> covered = std::nullopt) {
    constexpr double kTilt = 20 * kDegree;
    World world = bareWorld({plan}, seed, pixelNoise);
    const Isometry3d T_r_v = cameraBefore(world, distance, kTilt);
    const Isometry3d T_v_o = T_r_v.inverse() * world.T_r_u.front();
    const Isometry3d after = makeIsometry(so3Exp(rotation) * T_v_o.linear(), T_v_o.translation() + translation);
    world.T_r_v = {T_r_v, world.T_r_u.front() * after.inverse()};
    if (covered) {
        // Something flat on the module: its light does not get out.
        const Isometry3d& T = world.T_r_u[*covered];
        const Vector3d led = T * world.skin.templateOf(*covered).led + 0.004 * T.linear().col(2);
        world.tubes.push_back({led - 0.001 * T.linear().col(0), led + 0.001 * T.linear().col(0), 0.0025});
    }
    return world;
}

/// How the patch moved between the two views, in the camera's frame.
Eigen::VectorXd translationBetween(const World&, const Poses& T_r_v, const Poses& T_r_u) {
    return (T_r_v[1].inverse() * T_r_u[0]).translation() - (T_r_v[0].inverse() * T_r_u[0]).translation();
}

Eigen::VectorXd rotationBetween(const World&, const Poses& T_r_v, const Poses&) {
    return so3Log(T_r_v[1].linear().transpose() * T_r_v[0].linear());
}

using VectorOfPoses = Eigen::VectorXd (*)(const World&, const Poses& T_r_v, const Poses& T_r_u);

/// Two views of one patch, and a quantity that is the length of a vector.
Experiment motionExperiment(std::string name, std::string quantity, VectorOfPoses vector, double truth,
                            std::optional<double> printed, std::function<World(std::uint64_t seed)> makeWorld) {
    const bool isShift = vector == translationBetween;
    Experiment result{std::move(name),
                      std::move(quantity),
                      isShift ? "mm" : "rad",
                      isShift ? 1e3 : 1,
                      truth,
                      printed,
                      std::move(makeWorld),
                      {}};
    result.read = [vector](const World& world, const Poses& T_r_v, const Poses& T_r_u) {
        return vector(world, T_r_v, T_r_u).norm();
    };
    result.vector = vector;
    return result;
}

void addShapeExperiments(std::vector<Experiment>& all, double noise) {
    constexpr double kRadius = 0.0501;
    const auto cylinderWorld = [noise](std::uint64_t seed) { return bareWorld({bentPatch(19, kRadius)}, seed, noise); };
    const auto cylinderOf = [](const std::vector<Isometry3d>& T_r_u) {
        std::vector<Vector3d> origins;
        Matrix3d normals = Matrix3d::Zero();
        for (const Isometry3d& T : T_r_u) {
            origins.push_back(T.translation());
            normals += T.linear().col(2) * T.linear().col(2).transpose();
        }
        // Normals of a cylinder have no part along its axis.
        const Vector3d axis = Eigen::SelfAdjointEigenSolver<Matrix3d>(normals).eigenvectors().col(0);
        return fitCylinder(origins, axis, kRadius);
    };
    all.push_back({"cylinder of 50.1 mm, 19 modules",
                   "radius",
                   "mm",
                   1e3,
                   kRadius,
                   49.80,
                   cylinderWorld,
                   [=](const World&, const Poses&, const Poses& T_r_u) { return cylinderOf(T_r_u).radius; },
                   false,
                   true,
                   {},
                   BoundOn::Modules});
    all.push_back({"cylinder of 50.1 mm, 19 modules", "rms from the cylinder", "mm", 1e3, 0, 1.6, cylinderWorld,
                   [=](const World&, const Poses&, const Poses& T_r_u) { return cylinderOf(T_r_u).rms; }, false,
                   false});

    all.push_back({"strip of 8 in a loop of 222.28 mm", "widest gap", "mm", 1e3, 0, 10.46,
                   [noise](std::uint64_t seed) { return bareWorld({ringOfEight()}, seed, noise); },
                   [](const World&, const Poses&, const Poses& T_r_u) {
                       const ModuleTemplate type = paperHexagon();
                       double widest = 0;
                       for (std::size_t m = 0; m < T_r_u.size(); ++m) {
                           const Isometry3d& next = T_r_u[(m + 1) % T_r_u.size()];
                           widest = std::max(widest, (T_r_u[m] * type.ports[0] - next * type.ports[3]).norm());
                       }
                       return widest;
                   },
                   false, false});
}

void addPoseExperiments(std::vector<Experiment>& all, double noise) {
    // Flat on the table, 600 mm in front of the camera and 225 mm below it.
    const auto table = [noise](std::uint64_t seed) {
        World world = bareWorld({flatPatch(7)}, seed, noise);
        // Seen 69 degrees from the front: beyond half intensity, but LEDs are still found there.
        world.scenario.views.maxAngle = 80 * kDegree;
        // 225 mm below the axis at 600 mm takes a lens as wide as the paper's laptop had.
        world.scenario.camera.fx = world.scenario.camera.fy = 900;
        Matrix3d R_v_o;
        R_v_o << 1, 0, 0, 0, 0, -1, 0, 1, 0;
        world.T_r_v = {world.T_r_u.front() * makeIsometry(R_v_o, {0, 0.225, 0.6}).inverse()};
        return world;
    };
    all.push_back({"flat patch of 7 on a table", "distance to the camera", "mm", 1e3, std::hypot(0.225, 0.6), 628.2,
                   table, [](const World&, const Poses& T_r_v, const Poses& T_r_u) {
                       return (T_r_v[0].inverse() * T_r_u[0]).translation().norm();
                   }});
    all.push_back({"flat patch of 7 on a table", "rotation", "rad", 1, 90 * kDegree, 1.634, table,
                   [](const World&, const Poses& T_r_v, const Poses& T_r_u) {
                       return rotationAngle(T_r_v[0].linear().transpose() * T_r_u[0].linear());
                   }});

    struct Cell {
        double distance;
        bool bent;
        std::optional<double> z, y, rz, ry;
    };
    // Table I of the paper. Its text gives both rows of translations in full. Of the rotations only the last column
    // (1.4 m, bent) is certain, which stands alone with a number for each row. The five entries before it (0.172,
    // 0.178, 0.145, 0.106 and a dash) belong to two rows of five cells, and nothing says which: those cells stay empty.
    constexpr std::nullopt_t kUnknown = std::nullopt;
    const std::vector<Cell> cells{
        {0.6, false, 19.53, 19.88, kUnknown, kUnknown}, {0.6, true, 17.66, 19.73, kUnknown, kUnknown},
        {1.0, false, 23.02, 19.67, kUnknown, kUnknown}, {1.0, true, 25.95, 19.84, kUnknown, kUnknown},
        {1.4, false, 26.18, 21.66, kUnknown, kUnknown}, {1.4, true, 23.09, 19.91, 0.182, 0.184}};
    for (const Cell& cell : cells) {
        const PatchPlan plan = cell.bent ? bentPatch(7, 0.040) : flatPatch(7);
        const std::string name =
            fmt::format("Table I, {:.1f} m, {}", cell.distance, cell.bent ? "bent to 40 mm" : "flat");
        constexpr double kShift = 0.020;
        constexpr double kTurn = 0.175;
        const auto world = [=](const Vector3d& t, const Vector3d& w) {
            return [=](std::uint64_t seed) { return movedPatch(plan, cell.distance, t, w, seed, noise); };
        };
        const Vector3d none = Vector3d::Zero();
        all.push_back(
            motionExperiment(name, "shift along z", translationBetween, kShift, cell.z, world({0, 0, kShift}, none)));
        all.push_back(
            motionExperiment(name, "shift along y", translationBetween, kShift, cell.y, world({0, kShift, 0}, none)));
        all.push_back(
            motionExperiment(name, "turn about z", rotationBetween, kTurn, cell.rz, world(none, {0, 0, kTurn})));
        all.push_back(
            motionExperiment(name, "turn about y", rotationBetween, kTurn, cell.ry, world(none, {0, kTurn, 0})));
    }
    all.push_back(motionExperiment(
        "7 on 40 mm at 1.0 m, the middle covered", "shift along z", translationBetween, 0.020, 25.68,
        [noise](std::uint64_t seed) {
            return movedPatch(bentPatch(7, 0.040), 1.0, {0, 0, 0.020}, Vector3d::Zero(), seed, noise, 0);
        }));
}

/// Vectors between the ports of the one patch and the ports of the other that they really meet, though no link joins
/// them; one column each.
Eigen::Matrix3Xd portGaps(const World& world, const Poses& T_r_u) {
    const ModuleTemplate type = paperHexagon();
    constexpr double kMeets = 4e-3;
    std::vector<Vector3d> gaps;
    for (std::size_t a = 0; a < T_r_u.size() / 2; ++a) {
        for (std::size_t b = T_r_u.size() / 2; b < T_r_u.size(); ++b) {
            for (const Vector3d& p : type.ports) {
                for (const Vector3d& q : type.ports) {
                    if ((world.T_r_u[a] * p - world.T_r_u[b] * q).norm() < kMeets)
                        gaps.emplace_back(T_r_u[a] * p - T_r_u[b] * q);
                }
            }
        }
    }
    Eigen::Matrix3Xd result(3, static_cast<Eigen::Index>(gaps.size()));
    for (std::size_t i = 0; i < gaps.size(); ++i)
        result.col(static_cast<Eigen::Index>(i)) = gaps[i];
    return result;
}

void addBodyExperiments(std::vector<Experiment>& all, double noise) {
    // A seven-cell flower tiles the plane by (72, 14) mm: the two patches meet port to port without being linked.
    all.push_back({"two patches side by side on 50 mm at 1.0 m", "mean mismatch of the links between", "mm", 1e3, 0,
                   3.0,
                   [noise](std::uint64_t seed) {
                       PatchPlan left = bentPatch(7, 0.050);
                       PatchPlan right = left;
                       left.offset = {-0.036, -0.007};
                       right.offset = {0.036, 0.007};
                       World world = bareWorld({left, right}, seed, noise);
                       // In front of both, from where the cylinder bulges.
                       Matrix3d R;
                       R << 1, 0, 0, 0, -1, 0, 0, 0, -1;
                       world.T_r_v = {makeIsometry(R, {0, 0, 1.05})};
                       return world;
                   },
                   [](const World& world, const Poses&, const Poses& T_r_u) {
                       return portGaps(world, T_r_u).colwise().norm().mean();
                   },
                   true, true,
                   [](const World& world, const Poses&, const Poses& T_r_u) -> Eigen::VectorXd {
                       const Eigen::Matrix3Xd gaps = portGaps(world, T_r_u);
                       return gaps.reshaped() / std::sqrt(static_cast<double>(gaps.cols()));
                   },
                   BoundOn::Modules});

    all.push_back({"shoe sole of 23, six covered, 0.6 m", "distance to the camera", "mm", 1e3, 0.6, std::nullopt,
                   [noise](std::uint64_t seed) {
                       PatchPlan plan = flatPatch(23);
                       plan.surface = SurfaceKind::Sole;
                       World world = bareWorld({plan}, seed, noise);
                       world.T_r_v = {cameraBefore(world, 0.6, 20 * kDegree)};
                       layCard(world, 6);
                       return world;
                   },
                   [](const World&, const Poses& T_r_v, const Poses& T_r_u) {
                       return (T_r_v[0].inverse() * T_r_u[0]).translation().norm();
                   }});
}

/// Seconds that one cell costs in one view: frames at a webcam's rate, and the computation on them.
MethodOutcome timePerCell(ScanKind scan, bool paper) {
    constexpr double kFramesPerSecond = 30;
    Scenario scenario = *findScenario("coded");
    scenario.views.scan = scan;
    scenario.views.count = 1;
    scenario.views.repeats = 3;  // the paper multiplies M = 3 binary images
    const World world = buildWorld(scenario, 1);
    const auto frames = planScan(world, 0);
    const FrameRenderer renderer(world, 0, frames.size());
    std::vector<cv::Mat> pictures;
    for (std::size_t k = 0; k < frames.size(); ++k)
        pictures.push_back(renderer.render(frames[k].lit, k));
    const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> { return pictures[k]; };
    std::vector<ModuleId> modules;
    for (const SkinModule& module : world.skin.modules)
        modules.push_back(module.id);
    const auto start = std::chrono::steady_clock::now();
    const auto found = paper ? detectPaper("view0", modules, frames, load) : decodeView("view0", modules, frames, load);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    MethodOutcome outcome;
    if (found && !found->found.empty()) {
        outcome.solved = 1;
        outcome.mean =
            (static_cast<double>(frames.size()) / kFramesPerSecond + seconds) / static_cast<double>(modules.size());
    }
    return outcome;
}

ExperimentRow timeRow() {
    ExperimentRow row;
    row.experiment = "scan of 14 cells at 30 frames/s";
    row.quantity = "time per cell and view";
    row.unit = "s";
    row.printed = 1.5;
    row.paper = timePerCell(ScanKind::OneAtATime, true);
    row.ours = timePerCell(ScanKind::Coded, false);
    return row;
}

}  // namespace

PaperStudy runPaperStudy(const PaperStudyOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("PaperStudyOptions out of range");
    std::vector<Experiment> experiments;
    addShapeExperiments(experiments, options.pixelNoise);
    addPoseExperiments(experiments, options.pixelNoise);
    addBodyExperiments(experiments, options.pixelNoise);
    const auto isLeftOut = [&](const std::string& name) { return name.find(options.only) == std::string::npos; };
    std::erase_if(experiments, [&](const Experiment& experiment) { return isLeftOut(experiment.name); });
    PaperStudy study{options, {}, false};
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        context.report(Sentence::verbatim(std::string(experiments[i].name)),
                       static_cast<double>(i) / static_cast<double>(experiments.size()));
        study.rows.push_back(run(experiments[i], options, context));
        if (context.isCancelled()) {
            study.cancelled = true;
            return study;
        }
    }
    if (ExperimentRow row = timeRow(); !isLeftOut(row.experiment))
        study.rows.push_back(std::move(row));
    return study;
}

}  // namespace skincal
