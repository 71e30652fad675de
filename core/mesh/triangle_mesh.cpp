#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "core/mesh/in_steps.h"

namespace skincal {

Vector3d TriangleMesh::crossOf(std::size_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
}

double TriangleMesh::area() const {
    double sum = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        sum += 0.5 * crossOf(t).norm();
    return sum;
}

double TriangleMesh::diagonal() const {
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : vertices)
        box.extend(vertex);
    return box.isEmpty() ? 0 : box.diagonal().norm();
}

TriangleMesh welded(const TriangleMesh& mesh, const RunContext& context) {
    // Exactly the same place: writers repeat a corner's bytes, and what is merely near may be two sides of a gap.
    const auto before = [&](std::uint32_t i, std::uint32_t k) {
        const Vector3d& a = mesh.vertices[i];
        const Vector3d& b = mesh.vertices[k];
        return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    std::vector<std::uint32_t> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    if (!sortInSteps(order, context, before))
        return {};
    TriangleMesh result;
    std::vector<std::uint32_t> place(order.size());
    const bool isJoined = forEachInSteps(order.size(), context, [&](std::size_t k) {
        if (k == 0 || before(order[k - 1], order[k]))
            result.vertices.push_back(mesh.vertices[order[k]]);
        place[order[k]] = static_cast<std::uint32_t>(result.vertices.size() - 1);
    });
    const double least = 1e-24 * mesh.diagonal() * mesh.diagonal();
    const bool isDone = isJoined && forEachInSteps(mesh.triangles.size(), context, [&](std::size_t t) {
                            const auto& [a, b, c] = mesh.triangles[t];
                            result.triangles.push_back({place[a], place[b], place[c]});
                            if (!(result.crossOf(result.triangles.size() - 1).norm() > least))
                                result.triangles.pop_back();
                        });
    return isDone ? std::move(result) : TriangleMesh{};
}

std::optional<double> enclosedVolume(const TriangleMesh& mesh, const RunContext& context) {
    // Every edge is walked as often one way, from the lower corner to the higher, as the other.
    std::vector<std::uint64_t> up;
    std::vector<std::uint64_t> down;
    double sixfold = 0;
    // From a place of its own: about a far origin, what is summed is large and of either sign.
    const auto corner = [&](std::uint32_t i) -> Vector3d { return mesh.vertices[i] - mesh.vertices[0]; };
    const bool isWalked = forEachInSteps(mesh.triangles.size(), context, [&](std::size_t t) {
        const auto& corners = mesh.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = corners.at(i);
            const std::uint32_t b = corners.at((i + 1) % 3);
            (a < b ? up : down).push_back((static_cast<std::uint64_t>(std::min(a, b)) << 32U) | std::max(a, b));
        }
        sixfold += corner(corners[0]).dot(corner(corners[1]).cross(corner(corners[2])));
    });
    if (!isWalked || up.empty() || up.size() != down.size() || !sortInSteps(up, context, std::less<>()) ||
        !sortInSteps(down, context, std::less<>()))
        return std::nullopt;
    return up == down ? std::optional(sixfold / 6) : std::nullopt;
}

TriangleMesh turnedOutwards(TriangleMesh mesh, const RunContext& context) {
    if (enclosedVolume(mesh, context).value_or(0) < 0) {
        for (auto& corners : mesh.triangles)
            std::swap(corners[1], corners[2]);
    }
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
    for (Vector3d& vertex : mesh.vertices)
        vertex *= factor;
    return mesh;
}

TriangleMesh transformed(TriangleMesh mesh, const Isometry3d& T) {
    for (Vector3d& vertex : mesh.vertices)
        vertex = T * vertex;
    return mesh;
}

TriangleMesh tubeMesh(const Vector3d& from, const Vector3d& to, double radius, int sides) {
    const Vector3d axis = to - from;
    if (sides < 3 || !(axis.norm() > 0) || !(radius > 0))
        throw std::logic_error("tubeMesh: a tube has a length, a radius and at least three sides");
    const Vector3d a = axis.unitOrthogonal();
    const Vector3d b = axis.normalized().cross(a);
    TriangleMesh mesh{{from, to}, {}};
    const auto n = static_cast<std::uint32_t>(sides);
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 360 * kDegree * i / n;
        const Vector3d out = radius * (std::cos(angle) * a + std::sin(angle) * b);
        mesh.vertices.emplace_back(from + out);
        mesh.vertices.emplace_back(to + out);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t low = 2 + 2 * i;
        const std::uint32_t next = 2 + 2 * ((i + 1) % n);
        mesh.triangles.push_back({low, next, next + 1});
        mesh.triangles.push_back({low, next + 1, low + 1});
        mesh.triangles.push_back({0, next, low});
        mesh.triangles.push_back({1, low + 1, next + 1});
    }
    return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
    const auto shift = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
    for (const auto& [a, b, c] : more.triangles)
        mesh.triangles.push_back({a + shift, b + shift, c + shift});
}

}  // namespace skincal
