#include "core/camera_calibration/calibrate_camera.h"

#include <stdexcept>

#include "core/camera_calibration/board_solver.h"

namespace skincal {
namespace {

std::optional<CalibrationError> defectOf(std::span<const BoardView> views, const CameraCalibrationOptions& options) {
    constexpr std::size_t kMinCorners = 6;
    if (views.size() < static_cast<std::size_t>(options.minBoards))
        return CalibrationError{ErrorCode::TooFewPoses,
                                {{"found", static_cast<double>(views.size())}, {"needed", options.minBoards}}};
    for (const BoardView& view : views) {
        if (view.size != views.front().size)
            return CalibrationError{ErrorCode::SizeMismatch};
        if (view.corners.size() < kMinCorners)
            return CalibrationError{
                ErrorCode::TooFewPoints,
                {{"found", static_cast<double>(view.corners.size())}, {"needed", static_cast<double>(kMinCorners)}}};
        for (const BoardCorner& corner : view.corners) {
            if (!corner.pixel.allFinite())
                return CalibrationError{ErrorCode::NotFinite};
        }
    }
    return std::nullopt;
}

}  // namespace

bool CameraCalibrationOptions::validate() const {
    return boardRejection > 1 && boardTolerance_px >= 0 && lossScale_px > 0 && minBoards >= 3 && maxIterations > 0;
}

tl::expected<CameraCalibration, CalibrationError> calibrateCamera(std::span<const BoardView> views,
                                                                  const BoardPlan& plan,
                                                                  const CameraCalibrationOptions& options,
                                                                  const RunContext& context) {
    if (!options.validate() || !plan.validate())
        throw std::logic_error("calibrateCamera: options or plan out of range");
    if (auto defect = defectOf(views, options))
        return tl::unexpected(std::move(*defect));
    if (views.front().size.width <= 0 || views.front().size.height <= 0)
        throw std::logic_error("calibrateCamera: pictures without a size");
    BoardSolver solver(views, plan, options, context);
    context.report(Sentence::saying("poses of the boards"), 0);
    solver.start();
    const auto enough = [&] { return solver.usedCount() >= static_cast<std::size_t>(options.minBoards); };
    const auto tooFew = [&] {
        return tl::unexpected(
            CalibrationError{ErrorCode::TooFewPoses,
                             {{"found", static_cast<double>(solver.usedCount())}, {"needed", options.minBoards}}});
    };
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) {
        if (!enough())
            return tooFew();
        context.report(Sentence::saying("boards that disagree"), 0.2 + 0.15 * round);
        if (context.isCancelled())
            return tl::unexpected(CalibrationError{ErrorCode::Cancelled});
        if (auto solved = solver.solve(true); !solved)
            return tl::unexpected(std::move(solved.error()));
        if (!solver.rejectBoards())
            break;
    }
    if (!enough())
        return tooFew();
    context.report(Sentence::saying("final estimate"), 0.8);
    if (auto solved = solver.solve(false); !solved)
        return tl::unexpected(std::move(solved.error()));
    CameraCalibration result = solver.result();
    judgeCalibration(views, result);
    context.report(Sentence::saying("final estimate"), 1);
    return result;
}

}  // namespace skincal
