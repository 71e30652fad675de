#include "ui/widgets/image_conversion.h"

namespace skincal {

QImage toImage(const cv::Mat& picture) {
    if (picture.empty())
        return {};
    const auto format = picture.channels() == 1 ? QImage::Format_Grayscale8 : QImage::Format_BGR888;
    return QImage(picture.data, picture.cols, picture.rows, static_cast<qsizetype>(picture.step), format).copy();
}

}  // namespace skincal
