#include "core/vision/light_change.h"

#include <cstring>
#include <opencv2/core.hpp>

namespace skincal {
namespace {

double gained(const cv::Mat& after, const cv::Mat& before) {
    constexpr double kNoise = 20;
    cv::Mat more;
    cv::subtract(after, before, more);
    cv::subtract(more, cv::Scalar::all(kNoise), more);
    const cv::Scalar sums = cv::sum(more);
    return sums[0] + sums[1] + sums[2] + sums[3];
}

}  // namespace

double lightChange(const cv::Mat& picture, const cv::Mat& reference) {
    if (picture.empty() || picture.size() != reference.size() || picture.type() != reference.type())
        return 0;
    return gained(picture, reference) - gained(reference, picture);
}

bool isOfOneLevel(const cv::Mat& picture) {
    double least = 0;
    double most = 0;
    cv::minMaxIdx(picture.reshape(1), &least, &most);
    return least == most;
}

bool isSamePicture(const cv::Mat& a, const cv::Mat& b) {
    if (a.size() != b.size() || a.type() != b.type())
        return false;
    if (a.data == b.data)
        return true;
    const std::size_t bytes = static_cast<std::size_t>(a.cols) * a.elemSize();
    for (int row = 0; row < a.rows; ++row) {
        if (std::memcmp(a.ptr(row), b.ptr(row), bytes) != 0)
            return false;
    }
    return true;
}

}  // namespace skincal
