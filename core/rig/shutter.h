#pragma once

#include <chrono>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "core/vision/frame.h"

namespace skincal {

/// When the rows of a picture are exposed: row r of n from r / n * readout on, for as long as it is open. A shutter
/// that takes no time sees one moment.
struct Shutter {
    using Time = std::chrono::microseconds;

    Time open{};
    Time readout{};  ///< from the beginning of the first row to that of the last; 0 with a global shutter

    [[nodiscard]] Time length() const { return open + readout; }
    friend bool operator==(const Shutter&, const Shutter&) = default;
};

/// What is lit until a time since the first row's exposure began.
struct LitUntil {
    std::vector<LitModule> lit;
    Shutter::Time until{};
};

/// The picture of a scene that changes meanwhile: each row has of each picture the share of its exposure in which the
/// scene looked like that.
/// @param pictures  how it looked, one after the other, 8 bit, of one size and type
/// @param until     the end of each, rising; the last one's does not matter
[[nodiscard]] cv::Mat exposeRows(std::span<const cv::Mat> pictures, std::span<const Shutter::Time> until,
                                 const Shutter& shutter);

}  // namespace skincal
