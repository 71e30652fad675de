#pragma once

#include <tl/expected.hpp>

#include "core/estimation/joint_refinement.h"
#include "core/estimation/spot_settlement.h"
#include "core/estimation/sturdy_method.h"
#include "core/estimation/suspects.h"

namespace skincal {

struct JointMethodOptions {
    SturdyMethodOptions start;
    RefinementOptions refinement;
    SuspectOptions suspects;
    SpotOptions spots;
    /// How far accelerometers sit askew on their boards, rad about each axis, where the maker says so; 0 estimates
    /// none. It stands as given: gravity can't tell it from how a module is turned, links and pictures hardly.
    double misalignmentSigma = 0;
    int maxTakeOuts = 6;  ///< rounds in which suspects are taken out
    int maxTrials = 4;    ///< of other explanations where a patch does not fit its pictures

    [[nodiscard]] bool validate() const;
};

/// The joint estimate from the data alone: started by the sturdy method, refined over everything at once with weights
/// from the residuals; what everything else contradicts is taken out and named; and where a patch does not fit its
/// pictures, other explanations are tried and kept where they cost less (see alternatives). Last, where several spots
/// blink a module's word, the one that lies where the body has its LED is taken, if there is one (see settleSpots).
/// Each module has its covariance relative to the first placed view, which is the body frame.
/// Fails with Cancelled or NotConverged. Where the data do not fix all unknowns the sturdy method's weights stand and
/// there are no covariances.
[[nodiscard]] tl::expected<BodySolution, CalibrationError> solveJointly(const Measurements& measurements,
                                                                        const GravityTable& gravity,
                                                                        const JointMethodOptions& options = {},
                                                                        const RunContext& context = {});

/// The same for measurements to which views, detections or gravity poses were added (or views taken away at the end),
/// from the solution before: what is new is attached to it and everything is solved once from there, with the weights
/// that it had. Quick enough to follow an operator; what was taken out stays out. Solves anew where the skin has
/// changed or nothing was placed before.
/// @param last  it, and what it was made of, must still be there.
[[nodiscard]] tl::expected<BodySolution, CalibrationError> updateJointly(const BodySolution& last,
                                                                         const Measurements& measurements,
                                                                         const GravityTable& gravity,
                                                                         const JointMethodOptions& options = {},
                                                                         const RunContext& context = {});

/// Takes the spots that the solution decides on and solves again with them, until there are no more or as often as
/// `options.spots` allows. Fails with Cancelled or NotConverged.
[[nodiscard]] tl::expected<void, CalibrationError> chooseSpots(BodySolution& solution,
                                                               const RefinementOptions& refinement,
                                                               const SpotOptions& options,
                                                               const RunContext& context = {});

/// solveJointly as a body model.
[[nodiscard]] tl::expected<BodyModel, CalibrationError> calibrateJoint(const Measurements& measurements,
                                                                       const JointMethodOptions& options = {},
                                                                       const RunContext& context = {});

}  // namespace skincal
