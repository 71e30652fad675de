#include <png.h>

#include <cstring>
#include <vector>

#include "core/formats/picture_decode.h"
#include "core/formats/recording_parse.h"

namespace skincal {
namespace {

/// libpng reports errors by longjmp: the functions that call it hold nothing that needs a destructor, this does.
class PngReader {
  public:
    explicit PngReader(std::string_view bytes) : rest_(bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
        info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    bool readHeader() {
        if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0)
            return false;
        png_set_read_fn(png_, this, read);
        png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
        png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
        png_read_info(png_, info_);
        png_set_palette_to_rgb(png_);
        png_set_strip_alpha(png_);
        png_set_bgr(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }

    [[nodiscard]] bool isColour() const { return (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) != 0; }

    bool readRows(cv::Mat& picture) {
        if (png_get_image_width(png_, info_) != static_cast<unsigned>(picture.cols) ||
            png_get_image_height(png_, info_) != static_cast<unsigned>(picture.rows) ||
            png_get_rowbytes(png_, info_) != static_cast<std::size_t>(picture.cols) * picture.elemSize())
            return false;
        rows_.clear();
        for (int y = 0; y < picture.rows; ++y)
            rows_.push_back(picture.ptr(y));
        if (setjmp(png_jmpbuf(png_)) != 0)
            return false;
        png_read_image(png_, rows_.data());
        png_read_end(png_, nullptr);  // fails without IEND
        return true;
    }

  private:
    [[noreturn]] static void fail(png_structp png, png_const_charp) { png_longjmp(png, 1); }
    static void ignore(png_structp, png_const_charp) {}
    static void read(png_structp png, png_bytep out, std::size_t count) {
        auto& rest = static_cast<PngReader*>(png_get_io_ptr(png))->rest_;
        if (count > rest.size())
            png_error(png, "cut off");
        std::memcpy(out, rest.data(), count);
        rest.remove_prefix(count);
    }

    std::string_view rest_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::vector<png_bytep> rows_;
};

}  // namespace

bool decodePng(std::string_view bytes, const ImageHeader& header, cv::Mat& picture) {
    PngReader reader(bytes);
    if (!reader.readHeader())
        return false;
    picture.create(static_cast<int>(header.height), static_cast<int>(header.width),
                   reader.isColour() ? CV_8UC3 : CV_8UC1);
    return reader.readRows(picture);
}

}  // namespace skincal
