#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/run_context.h"
#include "core/geometry/se3.h"

namespace skincal {

/// A surface of triangles. Seen from outside, corners go round counter-clockwise, so that (b - a) x (c - a) points
/// outwards.
struct TriangleMesh {
    std::vector<Vector3d> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`

    /// Twice the area along the outward normal.
    [[nodiscard]] Vector3d crossOf(std::size_t triangle) const;
    [[nodiscard]] double area() const;
    /// Length of the diagonal of the box along the axes; 0 without vertices.
    [[nodiscard]] double diagonal() const;
};

/// Corners at one place become one vertex, triangles without area go: what formats that repeat corners (STL) need
/// before neighbours are known. Empty where cancelled.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh, const RunContext& context = {});

/// The volume that it encloses, negative where its triangles are inside out; nothing where it has a border, or edges
/// at which two triangles disagree on where outside is, and where cancelled. Of a welded mesh.
[[nodiscard]] std::optional<double> enclosedVolume(const TriangleMesh& mesh, const RunContext& context = {});

/// A closed mesh that is inside out is turned; all others stay as they are, and so does any where cancelled. Of a
/// welded mesh.
[[nodiscard]] TriangleMesh turnedOutwards(TriangleMesh mesh, const RunContext& context = {});

[[nodiscard]] TriangleMesh scaled(TriangleMesh mesh, double factor);
[[nodiscard]] TriangleMesh transformed(TriangleMesh mesh, const Isometry3d& T);

/// A tube from one point to another, with caps.
/// @param sides  at least 3.  Throws std::logic_error where there are fewer, or the points are one.
[[nodiscard]] TriangleMesh tubeMesh(const Vector3d& from, const Vector3d& to, double radius, int sides);

void append(TriangleMesh& mesh, const TriangleMesh& more);

}  // namespace skincal
