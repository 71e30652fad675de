#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>

#include "core/formats/file_error.h"
#include "core/mesh/triangle_mesh.h"

namespace skincal {

/// A surface from an STL file, binary or ASCII (all solids of it), in the file's own unit, which STL does not tell.
/// Corners are joined, triangles without area dropped, a closed surface that is inside out turned (welded,
/// turnedOutwards); the normals that the file gives are not used.
///
/// A binary file has 80 bytes of anything, a count, and exactly as many facets of 50 bytes; what begins with "solid"
/// and does not have that size is ASCII. Refused, with what was expected and found: files above 100 MB (two
/// million facets), files that are neither, a count that does not fit the size, facets cut short or with other than
/// three corners, coordinates that are no numbers or beyond 1e9, and surfaces without a triangle that has an area.
/// Fails where cancelled, too.
[[nodiscard]] tl::expected<TriangleMesh, FileError> readStl(const std::filesystem::path& file,
                                                            const RunContext& context = {});
[[nodiscard]] tl::expected<TriangleMesh, FileError> parseStl(const std::string& bytes,
                                                             const std::filesystem::path& file,
                                                             const RunContext& context = {});

/// The bytes of a binary STL file; coordinates in the mesh's unit, as floats.
[[nodiscard]] std::string stlBytes(const TriangleMesh& mesh);

}  // namespace skincal
