#include "core/mesh/alignment_starts.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/geometry/parallel.h"

namespace skincal {
namespace {

constexpr std::size_t kFine = 6000;       // points that modules are scored against
constexpr std::size_t kCoarse = 500;      // points whose pairs are looked up
constexpr std::size_t kScored = 40;       // modules
constexpr std::size_t kModulePairs = 60;  // looked up
constexpr std::size_t kMatchesPerPair = 120;
constexpr double kAngleStep = 20 * kDegree;

/// What stays the same of two oriented points wherever they are: a key for like pairs.
std::optional<std::uint32_t> featureOf(const OrientedPoint& a, const OrientedPoint& b, double step, double longest) {
    const Vector3d way = b.position - a.position;
    const double distance = way.norm();
    if (distance < step || distance > longest)
        return std::nullopt;
    const auto bin = [](double cosine) {
        return static_cast<std::uint32_t>(std::acos(std::clamp(cosine, -1.0, 1.0)) / kAngleStep);
    };
    return (static_cast<std::uint32_t>(distance / step) << 12U) | (bin(a.normal.dot(way) / distance) << 8U) |
           (bin(b.normal.dot(way) / distance) << 4U) | bin(a.normal.dot(b.normal));
}

/// A frame that moves with the pair; nothing where both normals run along the line, which leaves a turn free.
std::optional<Isometry3d> frameOf(const OrientedPoint& a, const OrientedPoint& b) {
    const Vector3d x = (b.position - a.position).normalized();
    const Vector3d out = a.normal + b.normal;
    const Vector3d z = out - out.dot(x) * x;
    if (z.norm() < 0.3)
        return std::nullopt;
    Matrix3d R;
    R << x, z.normalized().cross(x), z.normalized();
    return makeIsometry(R, 0.5 * (a.position + b.position));
}

Isometry3d principalFrame(std::span<const OrientedPoint> points) {
    Vector3d mean = Vector3d::Zero();
    for (const OrientedPoint& point : points)
        mean += point.position / static_cast<double>(points.size());
    Matrix3d spread = Matrix3d::Zero();
    for (const OrientedPoint& point : points)
        spread += (point.position - mean) * (point.position - mean).transpose();
    Matrix3d R = Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvectors();
    R.col(2) = R.col(0).cross(R.col(1));
    return makeIsometry(R, mean);
}

/// Mean of squared distances from the tangent planes, each at most `reach`, which is also what facing inwards costs.
double costOf(const Isometry3d& T, std::span<const OrientedPoint> modules, const SampledSurface& surface,
              double reach) {
    double sum = 0;
    for (const OrientedPoint& module : modules) {
        const Vector3d p = T * module.position;
        const OrientedPoint& q = surface.nearest(p);
        const double off = q.normal.dot(p - q.position);
        const double aside = std::max(0.0, (p - q.position - off * q.normal).norm() - reach);
        const bool isFacing = q.normal.dot(T.linear() * module.normal) > 0.5;
        sum += isFacing ? std::min(reach * reach, off * off + aside * aside) : reach * reach;
    }
    return sum / static_cast<double>(modules.size());
}

std::vector<Isometry3d> posesFromPairs(std::span<const OrientedPoint> modules, const std::vector<OrientedPoint>& points,
                                       double step, Random& random) {
    double longest = 0;
    for (const OrientedPoint& a : modules) {
        for (const OrientedPoint& b : modules)
            longest = std::max(longest, (a.position - b.position).norm());
    }
    std::unordered_map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>> alike;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        for (std::uint32_t k = 0; k < points.size(); ++k) {
            if (const auto key = featureOf(points[i], points[k], step, longest + step))
                alike[*key].emplace_back(i, k);
        }
    }
    std::vector<Isometry3d> poses;
    std::size_t pairs = 0;
    for (std::size_t draw = 0; draw < 20 * kModulePairs && pairs < kModulePairs; ++draw) {
        const OrientedPoint& a = modules[random.index(modules.size())];
        const OrientedPoint& b = modules[random.index(modules.size())];
        // Near ones leave the direction open.
        const auto key = featureOf(a, b, std::max(step, 0.4 * longest), longest + step);
        const auto frame = key ? frameOf(a, b) : std::nullopt;
        if (!frame)
            continue;
        const auto found = alike.find(*featureOf(a, b, step, longest + step));
        if (found == alike.end())
            continue;
        ++pairs;
        const std::size_t matches = std::min(kMatchesPerPair, found->second.size());
        for (std::size_t m = 0; m < matches; ++m) {
            const std::size_t at = matches < found->second.size() ? random.index(found->second.size()) : m;
            if (const auto there = frameOf(points[found->second[at].first], points[found->second[at].second]))
                poses.push_back(*there * frame->inverse());
        }
    }
    return poses;
}

}  // namespace

double motionBetween(std::span<const OrientedPoint> modules, const Isometry3d& a, const Isometry3d& b) {
    double sum = 0;
    for (const OrientedPoint& module : modules)
        sum += (a * module.position - b * module.position).squaredNorm();
    return std::sqrt(sum / static_cast<double>(modules.size()));
}

std::vector<Isometry3d> alignmentStarts(std::span<const OrientedPoint> modules, const TriangleMesh& mesh,
                                        std::size_t most, Random& random, const RunContext& context) {
    const std::vector<OrientedPoint> fine = sampleSurface(mesh, kFine, random);
    if (fine.empty())
        return {};
    const double spacing = std::sqrt(mesh.area() / static_cast<double>(fine.size()));
    const std::vector<OrientedPoint> coarse = sampleSurface(mesh, kCoarse, random);
    if (context.isCancelled())
        return {};
    const SampledSurface surface(fine);
    const std::vector<OrientedPoint> scored = thinned(modules, kScored);
    double extent = 0;
    for (const OrientedPoint& module : scored)
        extent = std::max(extent, 2 * (module.position - scored.front().position).norm());

    std::vector<Isometry3d> poses =
        posesFromPairs(modules, coarse, std::max(extent / 25, std::sqrt(mesh.area() / kCoarse) / 2), random);
    if (context.isCancelled())
        return {};
    const Isometry3d bodyAxes = principalFrame(modules);
    const Isometry3d meshAxes = principalFrame(fine);
    for (const Vector3d& sign : {Vector3d(1, 1, 1), Vector3d(1, -1, -1), Vector3d(-1, 1, -1), Vector3d(-1, -1, 1)})
        poses.push_back(meshAxes * makeIsometry(sign.asDiagonal(), Vector3d::Zero()) * bodyAxes.inverse());

    std::vector<std::pair<double, std::size_t>> order(poses.size());
    const double reach = std::max(2 * spacing, 0.04 * extent);
    bool isCancelled = false;
    forEachInParallel(
        poses.size(), 64,
        [&](std::size_t i) {
            order[i] = {costOf(poses[i], scored, surface, reach), i};
        },
        [&](std::size_t) { return !(isCancelled = context.isCancelled()); });
    if (isCancelled)
        return {};
    std::sort(order.begin(), order.end());
    std::vector<Isometry3d> starts;
    for (const auto& [cost, i] : order) {
        const bool isNew = std::all_of(starts.begin(), starts.end(), [&](const Isometry3d& start) {
            return motionBetween(scored, start, poses[i]) > 0.08 * extent;
        });
        if (isNew)
            starts.push_back(poses[i]);
        if (starts.size() == most)
            break;
    }
    return starts;
}

}  // namespace skincal
