#include "core/mesh/mesh_comparison.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "core/geometry/parallel.h"
#include "core/geometry/statistics.h"
#include "core/mesh/alignment_starts.h"
#include "core/mesh/mesh_alignment.h"

namespace skincal {
namespace {

constexpr std::size_t kStarts = 40;
constexpr std::size_t kFinalists = 10;
constexpr std::size_t kCoarseModules = 80;
constexpr std::size_t kFineModules = 400;
constexpr double kFree = 0.07;         // sensitivity below which a motion counts as free
constexpr double kLooseShift = 3e-3;   // m, standard deviation of where the modules are
constexpr double kLooseOffset = 1e-3;  // m
constexpr double kSmallShare = 0.05;   // of the mesh's area
constexpr double kBadFit = 4e-3;       // m

struct Candidate {
    MeshAlignment alignment;
    double cost = 0;
};

std::vector<OrientedPoint> orientedOf(std::span<const PlacedModule> modules) {
    std::vector<OrientedPoint> points;
    for (const PlacedModule& module : modules)
        points.push_back({module.T_body_module.translation(), module.T_body_module.linear().col(2)});
    return points;
}

double extentOf(std::span<const OrientedPoint> points) {
    Eigen::AlignedBox3d box;
    for (const OrientedPoint& point : points)
        box.extend(point.position);
    return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Root mean square of the deviations, none counted for more than `most`; what has no surface counts for that.
double cappedRms(const std::vector<OrientedPoint>& modules, const MeshSurface& surface, const MeshAlignment& alignment,
                 double reach, double most) {
    double sum = 0;
    for (const OrientedPoint& module : modules) {
        const auto found = surface.nearest(alignment.T_mesh_body * module.position,
                                           alignment.T_mesh_body.linear() * module.normal, reach);
        const double off = found ? found->distance - alignment.offset : most;
        sum += std::min(most * most, off * off);
    }
    return std::sqrt(sum / static_cast<double>(modules.size()));
}

/// Refines all of them, sorts by cost and keeps one of those that came together. Left half done where cancelled.
void refine(std::vector<Candidate>& candidates, const std::vector<OrientedPoint>& modules, const MeshSurface& surface,
            const MeshAlignmentOptions& options, const RunContext& context) {
    // Who called asks, for all threads: on a fine mesh one alignment takes a good part of a second.
    std::atomic<bool> isCancelled = false;
    RunContext asked;
    asked.isCancelled = [&, caller = std::this_thread::get_id()] {
        if (std::this_thread::get_id() == caller && context.isCancelled())
            isCancelled = true;
        return isCancelled.load();
    };
    forEachInParallel(
        candidates.size(), 1,
        [&](std::size_t i) {
            MeshAlignmentOptions own = options;
            own.offset = candidates[i].alignment.offset;
            candidates[i].alignment = alignToMesh(modules, surface, candidates[i].alignment.T_mesh_body, own, asked);
            candidates[i].cost = cappedRms(modules, surface, candidates[i].alignment, options.reach, 0.01);
        },
        [&](std::size_t) { return !asked.isCancelled(); }, [&] { (void)asked.isCancelled(); });
    if (isCancelled)
        return;
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    const double alike = std::max(3e-3, 0.01 * extentOf(modules));
    std::vector<Candidate> kept;
    for (const Candidate& candidate : candidates) {
        const bool isNew = std::all_of(kept.begin(), kept.end(), [&](const Candidate& other) {
            return motionBetween(modules, other.alignment.T_mesh_body, candidate.alignment.T_mesh_body) > alike;
        });
        if (isNew)
            kept.push_back(candidate);
    }
    candidates = std::move(kept);
}

void describe(std::span<const PlacedModule> modules, const MeshSurface& surface, double reach, MeshComparison& result) {
    std::vector<double> sizes;
    double squares = 0;
    double angles = 0;
    for (const PlacedModule& module : modules) {
        const Isometry3d T = result.T_mesh_body * module.T_body_module;
        const Vector3d out = T.linear().col(2);
        const auto found = surface.nearest(T.translation(), out, reach);
        if (!found) {
            result.unmatched.push_back(module.id);
            continue;
        }
        const ModuleDeviation deviation{module.id, found->distance - result.offset,
                                        std::atan2(out.cross(found->normal).norm(), out.dot(found->normal))};
        result.modules.push_back(deviation);
        sizes.push_back(std::abs(deviation.deviation));
        squares += deviation.deviation * deviation.deviation;
        angles += deviation.angle * deviation.angle;
        if (result.modules.size() == 1 || std::abs(deviation.deviation) > std::abs(result.worst.deviation))
            result.worst = deviation;
    }
    if (sizes.empty())
        return;
    const auto count = static_cast<double>(sizes.size());
    result.rms = std::sqrt(squares / count);
    result.angle_rms = std::sqrt(angles / count);
    std::sort(sizes.begin(), sizes.end());
    result.share95 = sizes[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1];
    result.median = median(std::move(sizes));
}

double coverOf(const std::vector<OrientedPoint>& modules, const TriangleMesh& mesh, const Isometry3d& T,
               Random& random) {
    std::vector<OrientedPoint> placed;
    for (const OrientedPoint& module : modules)
        placed.push_back({T * module.position, T.linear() * module.normal});
    const SampledSurface boards(placed);
    constexpr std::size_t kSamples = 4000;
    const auto samples = sampleSurface(mesh, kSamples, random);
    const auto near = std::count_if(samples.begin(), samples.end(), [&](const OrientedPoint& sample) {
        return (boards.nearest(sample.position).position - sample.position).norm() < MeshComparison::kCoverReach;
    });
    return samples.empty() ? 0 : static_cast<double>(near) / static_cast<double>(samples.size());
}

void doubt(const std::vector<OrientedPoint>& modules, const MeshSurface& surface, double reach,
           const std::vector<Candidate>& candidates, bool fitsOffset, const RunContext& context,
           MeshComparison& result) {
    using Kind = AlignmentDoubt::Kind;
    const MeshAlignment& best = candidates.front().alignment;
    const double ratio = surface.mesh().diagonal() / extentOf(modules);
    if (best.sigma > kBadFit)
        result.doubts.push_back({Kind::FitsBadly, best.sigma, 0});
    if (ratio > 50 || ratio < 0.5)
        result.doubts.push_back({Kind::SizesDiffer, ratio, 0});
    if (!result.unmatched.empty())
        result.doubts.push_back({Kind::Unmatched, static_cast<double>(result.unmatched.size()), 0});
    // What fits is compared by what fits: a module that sits elsewhere does so in every pose.
    const double most = std::clamp(4 * best.sigma, 1e-3, 1e-2);
    const double rms = cappedRms(modules, surface, best, reach, most);
    const double apart = std::max(5e-3, 0.02 * extentOf(modules));
    for (const Candidate& other : candidates) {
        if (context.isCancelled())
            return;
        const double motion = motionBetween(modules, best.T_mesh_body, other.alignment.T_mesh_body);
        const double otherRms = cappedRms(modules, surface, other.alignment, reach, most);
        if (motion > apart && otherRms < 1.25 * rms + 0.1e-3) {
            result.doubts.push_back({Kind::OtherPoseFits, motion, otherRms});
            break;
        }
    }
    const AlignmentStrength strength = strengthOf(modules, surface, best, reach);
    const double perRoot = best.sigma / std::sqrt(static_cast<double>(std::max<std::size_t>(1, best.matched)));
    const double weakest = strength.sensitivity[0];
    if (weakest < kFree || perRoot / weakest > kLooseShift)
        result.doubts.push_back({Kind::Slides, weakest, 0});
    if (fitsOffset && (strength.offset < 0.01 || perRoot / strength.offset > kLooseOffset))
        result.doubts.push_back({Kind::OffsetUnknown, perRoot / std::max(1e-3, strength.offset), 0});
    if (result.covered < kSmallShare)
        result.doubts.push_back({Kind::FewCovered, result.covered, 0});
}

bool isFinite(std::span<const PlacedModule> modules, const TriangleMesh& mesh) {
    return std::all_of(modules.begin(), modules.end(),
                       [](const PlacedModule& module) { return module.T_body_module.matrix().allFinite(); }) &&
           std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Vector3d& v) { return v.allFinite(); });
}

tl::unexpected<CalibrationError> failed(ErrorCode code, std::map<std::string, double> numbers = {}) {
    return tl::unexpected(CalibrationError{code, std::move(numbers)});
}

}  // namespace

tl::expected<MeshComparison, CalibrationError> compareWithMesh(std::span<const PlacedModule> modules,
                                                               const TriangleMesh& mesh,
                                                               const MeshComparisonOptions& options,
                                                               const RunContext& context) {
    if (modules.size() < kLeastModulesOnMesh)
        return failed(ErrorCode::TooFewPoints, {{"found", static_cast<double>(modules.size())},
                                                {"needed", static_cast<double>(kLeastModulesOnMesh)}});
    if (!isFinite(modules, mesh))
        return failed(ErrorCode::NotFinite);
    if (!(mesh.area() > 0))
        return failed(ErrorCode::DegeneratePoints);
    const std::vector<OrientedPoint> all = orientedOf(modules);
    const std::vector<OrientedPoint> fine = thinned(all, kFineModules);
    const std::vector<OrientedPoint> coarse = thinned(all, kCoarseModules);
    Random random(options.seed, "mesh");
    context.report(Sentence::saying("placing on the mesh"), 0);
    const MeshSurface surface(mesh, context);
    if (context.isCancelled())
        return failed(ErrorCode::Cancelled);
    const auto starts = alignmentStarts(coarse, mesh, kStarts, random, context);
    if (context.isCancelled())
        return failed(ErrorCode::Cancelled);
    context.report(Sentence::saying("placing on the mesh"), 0.3);

    MeshAlignmentOptions align;
    align.fitOffset = options.fitOffset;
    align.reach = std::max(0.01, 0.15 * extentOf(all));
    align.iterations = 30;
    std::vector<Candidate> candidates;
    for (const Isometry3d& start : starts)
        candidates.push_back({{start, options.offset, 0, 0}, 0});
    refine(candidates, coarse, surface, align, context);
    if (context.isCancelled())
        return failed(ErrorCode::Cancelled);
    context.report(Sentence::saying("placing on the mesh"), 0.7);
    if (candidates.size() > kFinalists)
        candidates.resize(kFinalists);
    align.reach = std::max(0.01, 0.05 * extentOf(all));
    align.iterations = 60;
    refine(candidates, fine, surface, align, context);
    if (context.isCancelled())
        return failed(ErrorCode::Cancelled);
    if (candidates.empty() || 2 * candidates.front().alignment.matched < fine.size())
        return failed(ErrorCode::NoConsensus);

    MeshComparison result;
    result.T_mesh_body = candidates.front().alignment.T_mesh_body;
    result.offset = candidates.front().alignment.offset;
    describe(modules, surface, align.reach, result);
    if (context.isCancelled())
        return failed(ErrorCode::Cancelled);
    result.covered = coverOf(all, mesh, result.T_mesh_body, random);
    doubt(fine, surface, align.reach, candidates, options.fitOffset, context, result);
    if (context.isCancelled())
        return failed(ErrorCode::Cancelled);
    return result;
}

double metres(MeshUnit unit) {
    return unit == MeshUnit::Millimetre ? 1e-3 : 1;
}

MeshUnit likelyUnit(std::span<const PlacedModule> modules, const TriangleMesh& mesh) {
    // Between a body of the modules' own size and one thirty times as large both fit in metres; a factor of 1,000 lies
    // between the units, so the middle of it, in powers, decides.
    const double extent = extentOf(orientedOf(modules));
    return mesh.diagonal() > 50 * extent ? MeshUnit::Millimetre : MeshUnit::Metre;
}

}  // namespace skincal
