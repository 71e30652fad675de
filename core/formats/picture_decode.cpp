#include "core/formats/picture_decode.h"

#include <fmt/format.h>

namespace skincal {

tl::expected<cv::Mat, std::string> decodePicture(std::string_view bytes, const ImageHeader& header) {
    if (header.bitsPerSample != 8)
        return tl::unexpected(fmt::format("expected 8 bits per channel, found {}", header.bitsPerSample));
    if (header.width < 1 || header.height < 1)
        return tl::unexpected<std::string>("expected a picture of at least one pixel");
    cv::Mat picture;
    const bool whole =
        header.format == ImageFormat::Png ? decodePng(bytes, header, picture) : decodeJpeg(bytes, header, picture);
    if (!whole)
        return tl::unexpected<std::string>("expected a picture that can be decoded, it is damaged");
    return picture;
}

}  // namespace skincal
