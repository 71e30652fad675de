#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "core/geometry/error.h"
#include "core/geometry/ids.h"
#include "core/geometry/run_context.h"
#include "core/mesh/triangle_mesh.h"

namespace skincal {

/// A module that is placed in the body.
struct PlacedModule {
    ModuleId id;
    Isometry3d T_body_module = Isometry3d::Identity();  ///< z out of the skin
};

struct MeshComparisonOptions {
    bool fitOffset = true;   ///< whether modules may all lie so far above the surface, as boards on a carrier do
    double offset = 0;       ///< m, where it is not fitted
    std::uint64_t seed = 1;  ///< of the draws; the same seed gives the same result
};

struct ModuleDeviation {
    ModuleId id;
    /// How far the middle of the module lies above where the mesh and the offset would have it, m, along the mesh's
    /// outward normal: d - h. Negative below.
    double deviation = 0;
    double angle = 0;  ///< between the module's z and the mesh's normal, rad
};

/// Why not to believe an alignment.
struct AlignmentDoubt {
    enum class Kind {
        OtherPoseFits,  ///< another pose fits nearly as well: `value` m away from it, with an rms of `other` m
        Slides,         ///< it may be shifted or turned with hardly a change: `value` of its sensitivity (0 to 1)
        OffsetUnknown,  ///< pose and offset can't be told apart: standard deviation `value` m
        FewCovered,     ///< modules lie on a small share of the mesh: `value` of its area
        SizesDiffer,    ///< the mesh's diagonal is `value` times the modules': of another unit, or another body
        FitsBadly,      ///< typical deviation `value` m: hardly the mesh of this body
        Unmatched,      ///< `value` modules have no surface of the mesh near that faces their way
    };
    Kind kind{};
    double value = 0;
    double other = 0;
};

struct MeshComparison {
    Isometry3d T_mesh_body = Isometry3d::Identity();
    double offset = 0;                     ///< h, m: how far modules lie above the mesh as a whole
    std::vector<ModuleDeviation> modules;  ///< those with a surface near; in the order given
    std::vector<ModuleId> unmatched;
    double rms = 0;      ///< of the deviations, m
    double median = 0;   ///< of their absolute values, m
    double share95 = 0;  ///< 95 % of the absolute values are not larger, m
    ModuleDeviation worst;
    double angle_rms = 0;  ///< rad
    double covered = 0;    ///< share of the mesh's area with a module within kCoverReach
    std::vector<AlignmentDoubt> doubts;

    static constexpr double kCoverReach = 0.03;  ///< m
};

/// Fewer can't hold six motions and an offset, and show a deviation besides.
inline constexpr std::size_t kLeastModulesOnMesh = 8;

/// Lays a body on a mesh, wherever the two are to begin with, and tells how they differ: the best of many starts
/// (alignmentStarts), each refined (alignToMesh).
/// @param mesh  m; welded, outside out (turnedOutwards)
/// Fails with TooFewPoints below kLeastModulesOnMesh, DegeneratePoints where the mesh has no area, NotFinite,
/// NoConsensus where no pose brings half of the modules near the surface, Cancelled.
[[nodiscard]] tl::expected<MeshComparison, CalibrationError> compareWithMesh(std::span<const PlacedModule> modules,
                                                                             const TriangleMesh& mesh,
                                                                             const MeshComparisonOptions& options = {},
                                                                             const RunContext& context = {});

/// Units that meshes come in, which STL files don't tell.
enum class MeshUnit { Millimetre, Metre };
/// How many metres one is.
[[nodiscard]] double metres(MeshUnit unit);
/// The one in which the mesh is nearer to the size of what the modules span.
[[nodiscard]] MeshUnit likelyUnit(std::span<const PlacedModule> modules, const TriangleMesh& mesh);

}  // namespace skincal
