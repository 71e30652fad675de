#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "core/geometry/random.h"
#include "core/geometry/se3.h"
#include "core/vision/frame.h"

namespace skincal::test {

/// A little camera of the tests' own, so that they don't lean on the simulator: Gaussian spots on a slope, noise.
struct Painter {
    int width = 160;
    int height = 120;
    double sigma = 1.0;
    double noise = 1.5;

    struct Spot {
        Vector2d at;
        double peak;
    };

    [[nodiscard]] cv::Mat paint(const std::vector<Spot>& spots, Random& random, double extra = 0) const {
        cv::Mat picture(height, width, CV_8UC1);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                double value = 40 + 0.3 * x + 0.1 * y + extra + noise * random.normal();
                for (const Spot& s : spots)
                    value += s.peak * std::exp(-(Vector2d(x, y) - s.at).squaredNorm() / (2 * sigma * sigma));
                picture.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(value);
            }
        }
        return picture;
    }
};

/// Words of the tests' scans: frame k lights the modules whose word has a one there.
inline std::vector<FrameInfo> framesOf(const std::vector<ModuleId>& modules, const std::vector<std::string>& words) {
    std::vector<FrameInfo> frames(words.front().size());
    for (std::size_t k = 0; k < frames.size(); ++k) {
        frames[k].file = "frame" + std::to_string(k) + ".png";
        for (std::size_t u = 0; u < modules.size(); ++u) {
            if (words[u][k] == '1')
                frames[k].lit.push_back({modules[u], std::nullopt});
        }
    }
    return frames;
}

}  // namespace skincal::test
