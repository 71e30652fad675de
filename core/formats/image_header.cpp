#include "core/formats/image_header.h"

#include <cstdint>

namespace skincal {
namespace {

std::uint32_t bigEndian(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

const tl::unexpected<std::string> kCutOff("expected a whole picture, it ends within its header");

tl::expected<ImageHeader, std::string> parseJpeg(std::string_view bytes) {
    std::size_t at = 2;
    while (at + 4 <= bytes.size()) {
        if (static_cast<unsigned char>(bytes[at]) != 0xFF)
            return tl::unexpected<std::string>("expected a JPEG marker, found other bytes");
        const auto marker = static_cast<unsigned char>(bytes[at + 1]);
        if (marker == 0xFF) {  // fill byte
            ++at;
            continue;
        }
        if (marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7)) {  // these stand alone
            at += 2;
            continue;
        }
        // Decoders skip a zero as rubbish, where a length would be read here: the two must see the same frame header.
        if (marker == 0x00 || (marker >= 0xD8 && marker <= 0xDA))
            return tl::unexpected<std::string>("expected a JPEG frame header before the picture's data");
        const std::size_t length = bigEndian(bytes, at + 2, 2);
        const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        if (frame) {
            if (at + 9 > bytes.size())
                return kCutOff;
            return ImageHeader{ImageFormat::Jpeg, static_cast<long>(bigEndian(bytes, at + 7, 2)),
                               static_cast<long>(bigEndian(bytes, at + 5, 2)),
                               static_cast<unsigned char>(bytes[at + 4])};
        }
        if (length < 2)
            return tl::unexpected<std::string>("expected a JPEG segment of at least 2 bytes");
        at += 2 + length;
    }
    return kCutOff;
}

}  // namespace

tl::expected<ImageHeader, std::string> parseImageHeader(std::string_view bytes) {
    constexpr std::string_view kPngSignature("\x89PNG\r\n\x1A\n", 8);
    if (bytes.substr(0, 8) == kPngSignature) {
        if (bytes.size() < 29 || bytes.substr(12, 4) != "IHDR")
            return kCutOff;
        return ImageHeader{ImageFormat::Png, static_cast<long>(bigEndian(bytes, 16, 4)),
                           static_cast<long>(bigEndian(bytes, 20, 4)), static_cast<unsigned char>(bytes[24])};
    }
    if (bytes.substr(0, 2) == "\xFF\xD8")
        return parseJpeg(bytes);
    return tl::unexpected<std::string>("expected a PNG or JPEG picture");
}

}  // namespace skincal
