#pragma once

#include <QString>

#include "core/camera_calibration/board_collector.h"
#include "core/camera_calibration/board_finder.h"
#include "core/camera_calibration/calibrate_camera.h"

namespace skincal {

/// What camera calibration has to say, in sentences for the operator.

/// Why there can be no such board; empty where there can.
[[nodiscard]] QString planFault(const BoardPlan& plan);
/// Why nothing was taken from a picture.
[[nodiscard]] QString sentenceOf(const BoardFault& fault, const BoardPlan& plan);
[[nodiscard]] QString sentenceOf(OfferOutcome outcome);
/// What to do next with the board.
[[nodiscard]] QString sentenceOf(const MissingView& missing);
/// What a calibration lacks, with its number.
[[nodiscard]] QString sentenceOf(const CalibrationReason& reason);
[[nodiscard]] QString sentenceOf(CalibrationTrust trust);
/// Why there is no calibration.
[[nodiscard]] QString sentenceOf(const CalibrationError& error);
/// Focal lengths and centre with a standard deviation each, where there is one.
[[nodiscard]] QString figuresOf(const CameraCalibration& calibration);

}  // namespace skincal
