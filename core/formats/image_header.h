#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace skincal {

enum class ImageFormat { Png, Jpeg };

struct ImageHeader {
    ImageFormat format = ImageFormat::Png;
    long width = 0;
    long height = 0;
    int bitsPerSample = 8;
};

/// Size and kind of a picture from its first bytes (PNG IHDR, JPEG SOF), so that nothing is decoded, and no memory
/// taken, before its size is known to be right. The error is a sentence.
[[nodiscard]] tl::expected<ImageHeader, std::string> parseImageHeader(std::string_view bytes);

}  // namespace skincal
