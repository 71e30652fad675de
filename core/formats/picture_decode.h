#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/formats/image_header.h"

namespace skincal {

/// Decodes a PNG or JPEG of 8 bits per channel whole or not at all: CV_8UC1 where it is grey, else CV_8UC3 (BGR). An
/// alpha channel means nothing and is left out, and so are orientation tags, which would turn the picture under its
/// calibration. Anything that a decoder would only warn of, and fill with grey, is damage: a cut-off end, a wrong
/// checksum, bytes that make no sense. Nothing is printed; the error is a sentence.
/// @param header  of the same bytes; its size has been checked.
[[nodiscard]] tl::expected<cv::Mat, std::string> decodePicture(std::string_view bytes, const ImageHeader& header);

/// The two kinds. False where the bytes are damaged.
[[nodiscard]] bool decodePng(std::string_view bytes, const ImageHeader& header, cv::Mat& picture);
[[nodiscard]] bool decodeJpeg(std::string_view bytes, const ImageHeader& header, cv::Mat& picture);

}  // namespace skincal
