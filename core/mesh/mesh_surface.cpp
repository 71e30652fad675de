#include "core/mesh/mesh_surface.h"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/transform_iterator.hpp>
#include <cmath>
#include <functional>

#include "core/mesh/in_steps.h"

namespace skincal {
namespace {

namespace bg = boost::geometry;
namespace bgi = boost::geometry::index;
using Point = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;

Point toBoost(const Vector3d& p) {
    return {p.x(), p.y(), p.z()};
}

/// Where on a triangle: in its face, on an edge or in a corner.
struct Foot {
    Vector3d point;
    enum class Part { Face, Edge, Corner } part = Part::Face;
    std::size_t which = 0;  ///< edge or corner
};

/// Ref: Ericson, Real-Time Collision Detection, 5.1.5.
Foot footOn(const std::array<Vector3d, 3>& corner, const Vector3d& p) {
    const Vector3d ab = corner[1] - corner[0];
    const Vector3d ac = corner[2] - corner[0];
    const double d1 = ab.dot(p - corner[0]);
    const double d2 = ac.dot(p - corner[0]);
    if (d1 <= 0 && d2 <= 0)
        return {corner[0], Foot::Part::Corner, 0};
    const double d3 = ab.dot(p - corner[1]);
    const double d4 = ac.dot(p - corner[1]);
    if (d3 >= 0 && d4 <= d3)
        return {corner[1], Foot::Part::Corner, 1};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return {corner[0] + d1 / (d1 - d3) * ab, Foot::Part::Edge, 0};
    const double d5 = ab.dot(p - corner[2]);
    const double d6 = ac.dot(p - corner[2]);
    if (d6 >= 0 && d5 <= d6)
        return {corner[2], Foot::Part::Corner, 2};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return {corner[0] + d2 / (d2 - d6) * ac, Foot::Part::Edge, 2};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return {corner[1] + (d4 - d3) / (d4 - d3 + d5 - d6) * (corner[2] - corner[1]), Foot::Part::Edge, 1};
    const double total = va + vb + vc;
    return {corner[0] + vb / total * ab + vc / total * ac, Foot::Part::Face, 0};
}

double angleBetween(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

using Entry = std::pair<Box, std::uint32_t>;

struct Cancelled {};

/// Handed a million boxes, a tree asks for them one by one until it is done, and nobody in between: who hands them out
/// does.
struct AskingHand {
    struct State {
        const RunContext& context;
        std::size_t count = 0;
    };
    State* state = nullptr;

    const Entry& operator()(const Entry& entry) const {
        if (state->count++ % kAskEvery == 0 && state->context.isCancelled())
            throw Cancelled();
        return entry;
    }
};

}  // namespace

struct MeshSurface::Index {
    bgi::rtree<Entry, bgi::rstar<16>> tree;
};

MeshSurface::~MeshSurface() = default;

MeshSurface::MeshSurface(TriangleMesh mesh, const RunContext& context)
    : mesh_(std::move(mesh)), index_(std::make_unique<Index>()) {
    if (weighFacesAndCorners(context) && weighEdges(context))
        plant(context);
}

bool MeshSurface::weighFacesAndCorners(const RunContext& context) {
    const auto& vertices = mesh_.vertices;
    vertexNormals_.assign(vertices.size(), Vector3d::Zero());
    faceNormals_.reserve(mesh_.triangles.size());
    const bool isSummed = forEachInSteps(mesh_.triangles.size(), context, [&](std::size_t t) {
        const auto& corners = mesh_.triangles[t];
        const Vector3d normal = mesh_.crossOf(t).normalized();
        faceNormals_.push_back(normal);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t at = corners.at(i);
            const std::uint32_t next = corners.at((i + 1) % 3);
            const std::uint32_t last = corners.at((i + 2) % 3);
            vertexNormals_[at] += angleBetween(vertices[next] - vertices[at], vertices[last] - vertices[at]) * normal;
        }
    });
    return isSummed && forEachInSteps(vertices.size(), context, [&](std::size_t i) { vertexNormals_[i].normalize(); });
}

bool MeshSurface::weighEdges(const RunContext& context) {
    // Its corners, and whose it is: triangle and which of its edges.
    using Edge = std::pair<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>>;
    std::vector<Edge> edges;
    edges.reserve(3 * mesh_.triangles.size());
    const bool isListed = forEachInSteps(mesh_.triangles.size(), context, [&](std::size_t t) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh_.triangles[t].at(i);
            const std::uint32_t b = mesh_.triangles[t].at((i + 1) % 3);
            edges.push_back({(static_cast<std::uint64_t>(std::min(a, b)) << 32U) | std::max(a, b),
                             {static_cast<std::uint32_t>(t), i}});
        }
    });
    if (!isListed || !sortInSteps(edges, context, std::less<>()))
        return false;
    edgeNormals_.resize(mesh_.triangles.size());
    std::size_t first = 0;
    return forEachInSteps(edges.size(), context, [&](std::size_t last) {
        if (last + 1 < edges.size() && edges[last + 1].first == edges[last].first)
            return;
        Vector3d normal = Vector3d::Zero();
        for (std::size_t k = first; k <= last; ++k)
            normal += faceNormals_[edges[k].second.first];
        normal.normalize();
        for (; first <= last; ++first)
            edgeNormals_[edges[first].second.first].at(edges[first].second.second) = normal;
    });
}

void MeshSurface::plant(const RunContext& context) {
    std::vector<Entry> entries;
    entries.reserve(mesh_.triangles.size());
    const bool isBoxed = forEachInSteps(mesh_.triangles.size(), context, [&](std::size_t t) {
        Eigen::AlignedBox3d box;
        for (const std::uint32_t corner : mesh_.triangles[t])
            box.extend(mesh_.vertices[corner]);
        entries.emplace_back(Box(toBoost(box.min()), toBoost(box.max())), static_cast<std::uint32_t>(t));
    });
    if (!isBoxed)
        return;
    AskingHand::State state{context};
    const auto handed = [&](auto at) { return boost::make_transform_iterator(at, AskingHand{&state}); };
    try {
        index_->tree = decltype(Index::tree)(handed(entries.cbegin()), handed(entries.cend()));
    } catch (const Cancelled&) {
        return;  // the tree is as it was: empty
    }
}

std::optional<SurfacePoint> MeshSurface::nearest(const Vector3d& p, const Vector3d& facing, double reach) const {
    double best = reach * reach;
    std::optional<std::uint32_t> nearest;
    Foot foot{};
    const Point at = toBoost(p);
    const auto faces = bgi::satisfies([&](const auto& entry) { return faceNormals_[entry.second].dot(facing) > 0; });
    // Where nothing near faces that way, the far side of a fine mesh is half a million triangles away.
    const Vector3d around = Vector3d::Constant(reach);
    const auto within = bgi::intersects(Box(toBoost(p - around), toBoost(p + around)));
    // The triangle whose box is nearest need not be the nearest; once a box is farther than what was found, it is.
    std::vector<Entry> entries;
    for (unsigned count = 6;; count *= 4) {
        entries.clear();
        index_->tree.query(bgi::nearest(at, count) && within && faces, std::back_inserter(entries));
        double farthest = 0;
        for (const auto& [box, t] : entries) {
            const double away = bg::comparable_distance(at, box);
            farthest = std::max(farthest, away);
            if (away >= best)
                continue;
            const auto& [a, b, c] = mesh_.triangles[t];
            const Foot candidate = footOn({mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]}, p);
            const double distance = (candidate.point - p).squaredNorm();
            if (distance < best) {
                best = distance;
                nearest = t;
                foot = candidate;
            }
        }
        if (entries.size() < count || farthest >= best)
            break;
    }
    if (!nearest)
        return std::nullopt;
    SurfacePoint result;
    result.point = foot.point;
    result.normal = foot.part == Foot::Part::Face     ? faceNormals_[*nearest]
                    : foot.part == Foot::Part::Corner ? vertexNormals_[mesh_.triangles[*nearest].at(foot.which)]
                                                      : edgeNormals_[*nearest].at(foot.which);
    const Vector3d way = p - foot.point;
    const double sign = result.normal.dot(way) < 0 ? -1 : 1;
    result.distance = sign * way.norm();
    // On the surface itself there is no way to it.
    constexpr double kTouches = 1e-9;
    result.gradient = way.norm() > kTouches ? Vector3d(sign * way.normalized()) : result.normal;
    return result;
}

}  // namespace skincal
