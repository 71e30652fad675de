#pragma once

#include <QString>

#include "core/formats/camera_origin.h"

namespace skincal {

/// Where intrinsics come from, to stand behind "They were": "calibrated from 14 boards, rms 0.11 px, on 2026-11-26".
/// Empty where nobody knows.
[[nodiscard]] QString sentenceOf(const CameraOrigin& origin);

/// The day that it is, as CameraOrigin::date has it.
[[nodiscard]] std::string today();

}  // namespace skincal
