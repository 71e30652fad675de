#include "core/estimation/gravity_shortfall.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/estimation/gravity_spread.h"
#include "core/geometry/statistics.h"

namespace skincal {
namespace {

struct WeakModule {
    std::size_t module = 0;
    std::vector<Vector3d> up_u;
    double readingSigma = 0;
    double rotationSigma = 0;  ///< of the worst axis, rad
};

double worstAxis(const Matrix3d& C) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(C, Eigen::EigenvaluesOnly).eigenvalues()[2]);
}

/// Some of many, evenly: they were all posed together.
std::vector<const WeakModule*> sample(const std::vector<WeakModule>& weak, const AdviceBasis& basis) {
    std::vector<const WeakModule*> placed;
    for (const WeakModule& module : weak) {
        if (basis.isPlaced(module.module))
            placed.push_back(&module);
    }
    constexpr std::size_t kEnough = 12;
    if (placed.size() <= kEnough)
        return placed;
    std::vector<const WeakModule*> some;
    for (std::size_t i = 0; i < kEnough; ++i)
        some.push_back(placed[i * placed.size() / kEnough]);
    return some;
}

std::optional<Vector3d> directionToAdd(const std::vector<WeakModule>& weak, const AdviceBasis& basis,
                                       const AdjustmentOptions& weights, std::size_t directions) {
    const auto some = sample(weak, basis);
    if (some.empty())
        return std::nullopt;
    std::optional<Vector3d> best;
    double least = 0;
    for (const Vector3d& up_r : evenDirections(directions)) {
        // The volume of uncertainty: one pose can't do much about the worst axis while the sensors' biases are open.
        double volume = 0;
        for (const WeakModule* module : some) {
            std::vector<Vector3d> up_u = module->up_u;
            up_u.emplace_back(basis.state.T_r_u[module->module]->linear().transpose() * up_r);
            volume += std::log(gravityRotationCovariance(up_u, module->readingSigma, weights).determinant());
        }
        if (!best || volume < least) {
            best = up_r;
            least = volume;
        }
    }
    return best;
}

void name(Shortfall& shortfall, const std::vector<std::size_t>& modules, const BodySolution& solution) {
    for (const std::size_t u : modules) {
        shortfall.modules.push_back(solution.measurements->skin.modules[u].id);
        shortfall.patches.push_back(solution.layout.patches[solution.layout.patchOf[u]].id);
    }
    std::sort(shortfall.patches.begin(), shortfall.patches.end());
    shortfall.patches.erase(std::unique(shortfall.patches.begin(), shortfall.patches.end()), shortfall.patches.end());
}

Shortfall missing(const std::vector<std::size_t>& modules, const BodySolution& solution) {
    Shortfall shortfall{Shortfall::Kind::GravityMissing};
    name(shortfall, modules, solution);
    const bool all = modules.size() == solution.layout.patchOf.size();
    const Sentence advice =
        Sentence::saying("read the accelerometers in three poses at least, each with another side up");
    shortfall.text =
        all ? Sentence::saying(
                  "no module has gravity readings in two poses or more, which tell how modules are turned: {}", advice)
        : modules.size() == 1
            ? Sentence::saying("{} has no gravity readings in two poses or more, which tell how modules are turned: {}",
                               listed(shortfall.modules), advice)
            : Sentence::saying(
                  "{} have no gravity readings in two poses or more, which tell how modules are turned: {}",
                  listed(shortfall.modules), advice);
    return shortfall;
}

Shortfall alike(const std::vector<WeakModule>& weak, const BodySolution& solution, const AdviceBasis& basis,
                const ShortfallOptions& options) {
    Shortfall shortfall{Shortfall::Kind::PosesAlike};
    std::vector<std::size_t> modules;
    std::vector<double> sigmas;
    std::vector<double> tilts;
    std::size_t poses = 0;
    for (const WeakModule& module : weak) {
        modules.push_back(module.module);
        sigmas.push_back(module.rotationSigma);
        tilts.push_back(largestTilt(module.up_u));
        poses = std::max(poses, module.up_u.size());
    }
    name(shortfall, modules, solution);
    const double sigma = median(std::move(sigmas));
    shortfall.figure = sigma / kDegree;
    shortfall.unit = "deg";
    shortfall.up_r = directionToAdd(weak, basis, solution.weights, options.directions);
    const bool most = 2 * modules.size() > solution.layout.patchOf.size();
    constexpr double kNotAtAll = 40 * kDegree;
    const Sentence known = sigma > kNotAtAll
                               ? Sentence::saying("unknown about one axis")
                               : Sentence::saying("known to {:.1f}° only about their worst axis", sigma / kDegree);
    const Sentence which =
        most ? Sentence::saying("gravity poses are too few or too alike")
             : Sentence::saying("gravity poses are too few or too alike for {}", listed(shortfall.modules));
    const Sentence count = poses == 1 ? Sentence::saying("1 pose") : Sentence::saying("{} poses", poses);
    const double tilt = median(std::move(tilts)) / kDegree;
    shortfall.text =
        shortfall.up_r
            ? Sentence::saying(
                  "{} ({}, tilted by at most {:.0f}°): how modules are turned is {}; add poses that tilt the "
                  "body by about 90° from those there are, such as one in which {}",
                  which, count, tilt, known, wordsForUp(*shortfall.up_r, solution))
            : Sentence::saying(
                  "{} ({}, tilted by at most {:.0f}°): how modules are turned is {}; add poses that tilt the "
                  "body by about 90° from those there are",
                  which, count, tilt, known);
    return shortfall;
}

}  // namespace

std::vector<Shortfall> gravityShortfalls(const BodySolution& solution, const AdviceBasis& basis,
                                         const ShortfallOptions& options) {
    std::vector<std::size_t> without;
    std::vector<WeakModule> weak;
    for (std::size_t u = 0; u < solution.layout.patchOf.size(); ++u) {
        const std::size_t readings = solution.input.gravity->of(u).size();
        const bool alone = solution.layout.patches[solution.layout.patchOf[u]].modules.size() < 2;
        if (alone && readings == 0)
            continue;
        if (readings < 2) {
            without.push_back(u);
            continue;
        }
        WeakModule module{u, upDirectionsOf(solution.input, solution.solved, u),
                          typicalSigma(solution.input, u, solution.weights), 0};
        module.rotationSigma = worstAxis(gravityRotationCovariance(module.up_u, module.readingSigma, solution.weights));
        if (module.rotationSigma > options.gravityRotation)
            weak.push_back(std::move(module));
    }
    std::vector<Shortfall> found;
    if (!without.empty())
        found.push_back(missing(without, solution));
    if (!weak.empty())
        found.push_back(alike(weak, solution, basis, options));
    return found;
}

}  // namespace skincal
