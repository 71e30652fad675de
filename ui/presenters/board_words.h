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
/// One of the numbers that say what a lens does.
struct LensFigure {
    QString name;
    QString value;
    QString sigma;  ///< standard deviation; empty where it is not known or the number was held fixed
};
/// Focal lengths, centre, then the distortion's coefficients.
[[nodiscard]] std::vector<LensFigure> figuresOf(const CameraCalibration& calibration);

}  // namespace skincal
