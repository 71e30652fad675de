#pragma once

#include <array>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/geometry/ids.h"

namespace skincal {

/// A module whose LED was on, and its colour where it was lit in one (each channel 0 or 1; nothing means white).
struct LitModule {
    ModuleId module;
    std::optional<std::array<int, 3>> colour{};
};

/// One frame of a view: what was lit while it was exposed. `lit` empty is a background frame.
struct FrameInfo {
    std::string file;
    std::vector<LitModule> lit;
    std::optional<double> time_s{};
    std::size_t look = 0;  ///< which scan of the view it belongs to, rising: see FurtherLooks
};

/// Loads frame k of a view as 8-bit BGR or grey; the decoder asks for frames in order and may ask for one several
/// times, so that no view has to fit into memory. The error is a sentence that names the file.
using FrameLoader = std::function<tl::expected<cv::Mat, std::string>(std::size_t frame)>;

}  // namespace skincal
