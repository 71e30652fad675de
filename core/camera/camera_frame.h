#pragma once

#include <chrono>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skincal {

/// A picture as the camera took it. The pixels are shared, never written to.
struct CameraFrame {
    cv::Mat image;                     ///< 8 bit, grey or BGR
    std::chrono::microseconds time{};  ///< of exposure, std::chrono::steady_clock since its epoch
    std::uint64_t sequence = 0;        ///< rises by one with every frame that the camera took, dropped ones included
};

struct FrameFormat {
    int width = 0;
    int height = 0;
    double framesPerSecond = 0;

    friend bool operator==(const FrameFormat&, const FrameFormat&) = default;
};

}  // namespace skincal
