#pragma once

#include <array>
#include <optional>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "core/camera_calibration/board_plan.h"
#include "core/camera_calibration/board_view.h"
#include "core/geometry/error.h"
#include "core/geometry/run_context.h"
#include "core/vision/camera_model.h"

namespace skincal {

struct CameraCalibrationOptions {
    DistortionModel model = DistortionModel::PlumbBob;
    /// Of plumb_bob: false leaves k3 at 0, as ROS and OpenCV's guides advise for all but wide lenses.
    bool thirdRadialTerm = false;
    /// A board is out where its root mean square residual is above this times the boards' median …
    double boardRejection = 3;
    /// … and above this, in pixels: no board is out for being merely worse than very good ones.
    double boardTolerance_px = 0.5;
    double lossScale_px = 1;  ///< of the Cauchy loss while boards are being judged
    int minBoards = 3;        ///< 3 and more
    int maxIterations = 200;
    [[nodiscard]] bool validate() const;
};

/// Standard deviations, as far as the residuals' scatter goes; k in the order of the model, 0 for what was held fixed.
struct IntrinsicsSigma {
    double fx = 0;
    double fy = 0;
    double cx = 0;
    double cy = 0;
    std::vector<double> distortion;
};

/// One of the boards that went in, in the same order.
struct CalibratedBoard {
    bool used = true;   ///< false: an outlier, had no part in the result
    double rms_px = 0;  ///< root mean square length of its corners' residuals; infinite where it has no pose
    Eigen::Isometry3d T_v_b = Eigen::Isometry3d::Identity();  ///< pose of the board frame in the camera
    std::vector<Vector2d> residuals;                          ///< measured minus predicted, px, as BoardView::corners
};

enum class CalibrationTrust { Good, Usable, NotToBeTrusted };

struct CalibrationReason {
    enum class Kind {
        FewBoards,        ///< boards used
        PoorCoverage,     ///< share of an 8x6 grid's cells with corners in them
        LittleTilt,       ///< largest angle between two boards, degrees
        LargeResiduals,   ///< rms, px
        FocalUncertain,   ///< sigma of the focal length over the focal length
        CentreUncertain,  ///< sigma of the principal point over the picture's width
        ManyRejected,     ///< share of boards that were outliers
        FoldsBack,        ///< the distortion folds back within the picture: two directions, one pixel
        NotDetermined,    ///< the boards leave a parameter free
    };
    Kind kind{};
    CalibrationTrust trust{};  ///< the best verdict that this allows
    double found = 0;
    double needed = 0;  ///< for the next better verdict
};

struct CameraCalibration {
    CameraModel camera;
    std::optional<IntrinsicsSigma> sigma;  ///< absent where the boards leave a parameter free
    std::vector<CalibratedBoard> boards;
    std::vector<std::size_t> rejected;  ///< boards that weren't used
    double rms_px = 0;                  ///< over all corners of the boards that were
    CalibrationTrust trust = CalibrationTrust::Good;
    std::vector<CalibrationReason> reasons;  ///< why it isn't Good, worst first
};

/// Calibrates a camera from views of one board (Zhang, PAMI 2000): minimises over intrinsics, distortion and the
/// boards' poses the sum of |pixel - project(T_v_b p_b)|^2, by Levenberg-Marquardt. First with a Cauchy loss, so that
/// boards that disagree stand out; these are left out and named, and the rest solved by plain least squares. Sigmas
/// come from the inverse normal matrix times the residuals' variance (degrees of freedom counted). Boards that face the
/// camera squarely, all at one angle, leave the focal length free: see reasons. Fails with TooFewPoses (fewer boards
/// than minBoards, before or after rejection), TooFewPoints (a board of fewer than 6 corners), SizeMismatch (pictures
/// of different sizes), NotFinite, NotConverged, Cancelled. Throws std::logic_error for options or a plan that aren't
/// valid, ids that the plan doesn't have, or a size that isn't positive.
[[nodiscard]] tl::expected<CameraCalibration, CalibrationError> calibrateCamera(
    std::span<const BoardView> views, const BoardPlan& plan, const CameraCalibrationOptions& options = {},
    const RunContext& context = {});

/// Fills in trust and reasons from the rest: what the header's Kinds measure, held against fixed limits.
void judgeCalibration(std::span<const BoardView> views, CameraCalibration& calibration);

}  // namespace skincal
