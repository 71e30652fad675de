#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/estimation/joint_method.h"
#include "core/estimation/next_measurement.h"
#include "core/estimation/observability.h"
#include "core/geometry/run_context.h"
#include "core/session/session_data.h"

namespace skincal {

/// A body with all that the window shows of it: a snapshot that nobody changes.
struct Solution {
    std::uint64_t revision = 0;  ///< of the session when it was asked for
    std::shared_ptr<const Measurements> measurements;
    std::shared_ptr<const GravityTable> gravity;
    BodySolution solved;  ///< refers to the two above
    BodyModel body;
    std::vector<Shortfall> shortfalls;
    double seconds = 0;     ///< that solving took
    bool isUpdate = false;  ///< from the solution before (updateJointly), rather than from the data alone
};

/// Whether one is what the other is, but for what differs when the same data are solved twice: a file of one does for
/// the other.
[[nodiscard]] bool isSameBody(const BodyModel& a, const BodyModel& b);

/// Whether patches are seen from one side only, or modules in no view at all.
[[nodiscard]] bool needsViews(const Solution& solution);

/// What to measure next; takes longer than the solution itself.
struct Guidance {
    std::uint64_t revision = 0;
    std::vector<NextPose> poses;
    std::vector<NextView> views;
};

/// Solves measurements, from `last` where that is quicker and they only grew since (updateJointly).
/// Fails with Cancelled or NotConverged.
[[nodiscard]] tl::expected<std::shared_ptr<const Solution>, CalibrationError> solve(
    std::shared_ptr<const Measurements> measurements, std::uint64_t revision, const Solution* last,
    const RunContext& context);

/// Nothing of what can't be forecast. Empty where cancelled.
[[nodiscard]] Guidance guidanceFor(const Solution& solution, const RunContext& context);

}  // namespace skincal
