#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/estimation/body_solution.h"

namespace skincal {

/// Something that the measurements lack for a good result, and what to do about it.
struct Shortfall {
    enum class Kind {
        GravityMissing,        ///< modules without readings in two poses
        PosesAlike,            ///< too few or too alike to tell how modules are turned
        PatchUnseen,           ///< in no view
        PatchSeenTooLittle,    ///< in no view well enough for a pose
        PatchNeverWithPlaced,  ///< seen, but in no view with a placed patch
        PatchContradicted,     ///< its shape explains its pictures nowhere
        UndecidedViews,        ///< they could be in two places
        FewViews,              ///< patches seen from one direction only
        ModulesHidden,         ///< views should show them and do not: covered, or their LED is broken
        ModulesUnseen,         ///< placed, but by gravity and links alone
        ScaleFromLinksOnly,    ///< ports and LED offsets do not tell well how large the body is
        Undetermined,          ///< the data do not fix all unknowns: there are no standard deviations
    };
    Kind kind{};
    std::vector<PatchId> patches{};
    std::vector<ModuleId> modules{};
    std::vector<std::string> views{};
    /// The pose to add: unit vector against gravity, body frame. Nothing where no pose helps or nothing is placed.
    std::optional<Vector3d> up_r{};
    std::optional<double> figure{};  ///< how bad it is, in `unit`; the sentence says of what
    std::string unit{};              ///< "deg", "mm", "%"; empty where there is no figure
    Sentence text{};                 ///< what is missing and what to do
};

/// "poses-alike" and the like, in files.
[[nodiscard]] std::string_view name(Shortfall::Kind kind);

struct ShortfallOptions {
    /// Modules whose rotation gravity alone tells worse than this about some axis (standard deviation) need more poses.
    double gravityRotation = 1 * kDegree;
    double relativeScale = 5e-3;      ///< standard deviation of the body's size that is still good
    double viewAngle = 10 * kDegree;  ///< views of a patch that differ by less are one
    int ledsOfAPose = 4;              ///< see PatchPoseOptions::minInliers
    std::size_t directions = 42;      ///< tried for the pose to add

    [[nodiscard]] bool validate() const {
        return gravityRotation > 0 && relativeScale > 0 && viewAngle > 0 && ledsOfAPose > 0 && directions > 0;
    }
};

/// What a solution lacks, the gravest first; empty where nothing does. Metric scale comes from the ports and LED
/// offsets of the modules alone, so its precision is that of the links (see BodyPrecision::scale).
/// Standard deviations are those of the solution's own weights. Throws std::logic_error where options are out of range.
[[nodiscard]] std::vector<Shortfall> findShortfalls(const BodySolution& solution, const ShortfallOptions& options = {});

}  // namespace skincal
