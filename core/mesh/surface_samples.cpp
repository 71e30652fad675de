#include "core/mesh/surface_samples.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

namespace skincal {
namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;

/// By area, with chance: some lie close together.
std::vector<OrientedPoint> drawPoints(const TriangleMesh& mesh, std::size_t count, Random& random) {
    std::vector<double> areas;
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        areas.push_back(sum += mesh.crossOf(t).norm());
    std::vector<OrientedPoint> points;
    if (!(sum > 0))
        return points;
    for (std::size_t k = 0; k < count; ++k) {
        // One draw in each equal share of the area.
        const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(count) * sum;
        const auto found = std::upper_bound(areas.begin(), areas.end() - 1, at);
        const auto t = static_cast<std::size_t>(found - areas.begin());
        const auto& [a, b, c] = mesh.triangles[t];
        const double root = std::sqrt(random.uniform());
        const double share = random.uniform();
        points.push_back(
            {(1 - root) * mesh.vertices[a] + root * (1 - share) * mesh.vertices[b] + root * share * mesh.vertices[c],
             mesh.crossOf(t).normalized()});
    }
    // Not in the order of the file: thinning keeps those that come first.
    for (std::size_t k = points.size(); k > 1; --k)
        std::swap(points[k - 1], points[random.index(k)]);
    return points;
}

}  // namespace

std::vector<OrientedPoint> thinned(std::span<const OrientedPoint> points, std::size_t most) {
    std::vector<OrientedPoint> some;
    const std::size_t count = std::min(most, points.size());
    for (std::size_t i = 0; i < count; ++i)
        some.push_back(points[i * points.size() / count]);
    return some;
}

std::vector<OrientedPoint> sampleSurface(const TriangleMesh& mesh, std::size_t count, Random& random) {
    constexpr std::size_t kDrawsPerPoint = 6;
    const double spacing = 0.7 * std::sqrt(mesh.area() / static_cast<double>(std::max<std::size_t>(1, count)));
    // A grid of cells of the spacing: what is nearer lies in the same cell or one beside it.
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;
    using Cell = Eigen::Matrix<std::int64_t, 3, 1>;
    const auto keyOf = [](const Cell& cell) {
        // Far from the origin keys repeat: what shares one is compared in vain.
        constexpr int kBits = 21;
        constexpr std::int64_t kHalf = 1 << (kBits - 1);
        std::uint64_t key = 0;
        for (int i = 0; i < 3; ++i)
            key = (key << kBits) | static_cast<std::uint64_t>((cell[i] + kHalf) & ((1 << kBits) - 1));
        return key;
    };
    std::vector<OrientedPoint> kept;
    for (const OrientedPoint& point : drawPoints(mesh, kDrawsPerPoint * count, random)) {
        const Cell cell = (point.position / spacing).array().floor().cast<std::int64_t>();
        bool isFree = true;
        for (int n = 0; isFree && n < 27; ++n) {
            const auto found = cells.find(keyOf(cell + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
            if (found == cells.end())
                continue;
            // Two sides of a thin wall are both kept.
            isFree = std::none_of(found->second.begin(), found->second.end(), [&](std::size_t other) {
                return (kept[other].position - point.position).norm() < spacing &&
                       kept[other].normal.dot(point.normal) > 0.5;
            });
        }
        if (!isFree)
            continue;
        cells[keyOf(cell)].push_back(kept.size());
        kept.push_back(point);
    }
    return kept;
}

struct SampledSurface::Index {
    bgi::rtree<std::pair<Point, std::uint32_t>, bgi::rstar<16>> tree;
};

SampledSurface::SampledSurface(std::vector<OrientedPoint> points)
    : points_(std::move(points)), index_(std::make_unique<Index>()) {
    std::vector<std::pair<Point, std::uint32_t>> entries;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        const Vector3d& p = points_[i].position;
        entries.emplace_back(Point(p.x(), p.y(), p.z()), i);
    }
    index_->tree = decltype(Index::tree)(entries);
}

SampledSurface::~SampledSurface() = default;

const OrientedPoint& SampledSurface::nearest(const Vector3d& p) const {
    if (points_.empty())
        throw std::logic_error("SampledSurface: no points");
    std::pair<Point, std::uint32_t> found;
    index_->tree.query(bgi::nearest(Point(p.x(), p.y(), p.z()), 1), &found);
    return points_[found.second];
}

}  // namespace skincal
