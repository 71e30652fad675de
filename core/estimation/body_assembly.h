#pragma once

#include <string>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/adjustment/measurements.h"
#include "core/estimation/body_model.h"
#include "core/estimation/patch_shape.h"
#include "core/estimation/skin_layout.h"
#include "core/estimation/spot_verdict.h"

namespace skincal {

/// What a method hands over once its estimation is done; assembleBody makes the body model of it.
struct BodyEstimate {
    std::string method;
    std::string bodyFrame = "first-view";
    std::vector<std::optional<Isometry3d>> T_r_u;          ///< per module
    std::vector<std::optional<Isometry3d>> T_r_o;          ///< per patch
    std::vector<std::optional<Isometry3d>> T_r_v;          ///< per view
    std::vector<PatchShape> shapes;                        ///< per patch
    std::vector<Sentence> patchStatus;                     ///< per patch: "placed", or why not
    std::vector<Sentence> viewStatus;                      ///< per view
    std::vector<std::vector<std::size_t>> patchViews;      ///< per patch: views that have a say in its pose
    std::vector<AccelerometerCalibration> accelerometers;  ///< per module; empty where not estimated
    /// Per module, body frame (BodyModule::covariance); empty where not estimated.
    std::vector<std::optional<Matrix6d>> covariances;
    std::vector<bool> rejected;            ///< per entry of AdjustmentInput::pixels
    std::vector<Sentence> rejectedReason;  ///< likewise
    /// Likewise: why a detection does not count wherever it lies, being part of a finding; empty where it does.
    std::vector<Sentence> setAside;
    std::vector<SpotVerdict> spots;       ///< where several spots blink a module's word, taken or not
    std::vector<Sentence> moduleTrouble;  ///< per module: why it has no pose though its patch has; empty where none
    std::vector<std::size_t> notHeld;     ///< modules that nothing measured holds
    std::vector<Sentence> linkTrouble;    ///< per link of the graph: why a neighbour does not count as one
    std::map<std::string, double> condition;
    std::vector<Sentence> warnings;
    std::vector<Sentence> missing;
    std::vector<Finding> findings;
    std::vector<StageReport> stages;
    std::vector<std::size_t> undecidedViews;  ///< those that could be in two places as well as not
    Trust trustAtMost = Trust::Good;          ///< where the method knows of a reason for doubt
};

/// Fills in verdicts, residuals, link distances and the quality figures, and says whether to trust the result.
[[nodiscard]] BodyModel assembleBody(const Measurements& measurements, const GravityTable& gravity,
                                     const SkinLayout& layout, const AdjustmentInput& input,
                                     const BodyEstimate& estimate);

}  // namespace skincal
