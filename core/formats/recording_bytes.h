#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/formats/recording.h"

namespace skincal {

/// File name and text, in the order in which they are written: recording.json last, since a directory without it is no
/// recording, so that a half-written one is never read.
using RecordingTexts = std::vector<std::pair<std::string, std::string>>;

/// What writeRecording writes. Throws as it does.
[[nodiscard]] RecordingTexts textsOf(const Recording& recording);

/// What writeFrame writes; empty where the picture is none.
[[nodiscard]] std::string pngOf(const cv::Mat& picture);

}  // namespace skincal
