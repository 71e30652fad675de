#include "core/rig/shutter.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace skincal {

cv::Mat exposeRows(std::span<const cv::Mat> pictures, std::span<const Shutter::Time> until, const Shutter& shutter) {
    if (pictures.empty() || pictures.size() != until.size())
        throw std::logic_error("exposeRows: one end for each picture");
    using Seconds = std::chrono::duration<double>;
    const int rows = pictures.front().rows;
    const double open = std::max(1e-9, Seconds(shutter.open).count());
    cv::Mat picture(pictures.front().size(), CV_MAKETYPE(CV_32F, pictures.front().channels()), cv::Scalar::all(0));
    for (int row = 0; row < rows; ++row) {
        const double begin = Seconds(shutter.readout).count() * row / rows;
        double before = 0;
        for (std::size_t i = 0; i < pictures.size(); ++i) {
            const bool isLast = i + 1 == pictures.size();
            const double end = isLast ? 1 : std::clamp((Seconds(until[i]).count() - begin) / open, 0.0, 1.0);
            if (end <= before)
                continue;
            cv::Mat part;
            pictures[i].row(row).convertTo(part, CV_32F, end - before);
            picture.row(row) += part;
            before = end;
        }
    }
    cv::Mat shown;
    picture.convertTo(shown, pictures.front().type());
    return shown;
}

}  // namespace skincal
