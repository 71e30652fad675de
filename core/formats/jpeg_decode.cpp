#include <csetjmp>
#include <cstdio>  // jpeglib.h needs FILE

#include <jpeglib.h>

#include "core/formats/picture_decode.h"

namespace skincal {
namespace {

/// More than any encoder writes; a file of millions of empty scans would take hours.
constexpr int kMaxScans = 500;

/// libjpeg reports errors by longjmp: the functions that call it hold nothing that needs a destructor, this does.
class JpegReader {
  public:
    explicit JpegReader(std::string_view bytes) : bytes_(bytes) {
        jpeg_.err = jpeg_std_error(&errors_);
        jpeg_.client_data = this;
        errors_.error_exit = fail;
        errors_.emit_message = note;
        errors_.output_message = [](j_common_ptr) {};
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    bool readHeader() {
        if (setjmp(jump_) != 0)
            return false;
        jpeg_create_decompress(&jpeg_);
        progress_.progress_monitor = limitScans;
        jpeg_.progress = &progress_;
        jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()),
                     static_cast<unsigned long>(bytes_.size()));
        jpeg_read_header(&jpeg_, TRUE);
        jpeg_.out_color_space = isColour() ? JCS_EXT_BGR : JCS_GRAYSCALE;
        return true;
    }

    [[nodiscard]] bool isColour() const { return jpeg_.num_components != 1; }

    bool readRows(cv::Mat& picture) {
        if (jpeg_.image_width != static_cast<unsigned>(picture.cols) ||
            jpeg_.image_height != static_cast<unsigned>(picture.rows))
            return false;
        if (setjmp(jump_) != 0)
            return false;
        jpeg_start_decompress(&jpeg_);
        if (jpeg_.output_components != picture.channels())
            return false;
        while (jpeg_.output_scanline < jpeg_.output_height) {
            JSAMPROW row = picture.ptr(static_cast<int>(jpeg_.output_scanline));
            jpeg_read_scanlines(&jpeg_, &row, 1);
        }
        jpeg_finish_decompress(&jpeg_);
        // Where libjpeg warns it has made up what it could not read.
        return errors_.num_warnings == 0;
    }

  private:
    [[noreturn]] static void fail(j_common_ptr jpeg) {
        std::longjmp(static_cast<JpegReader*>(jpeg->client_data)->jump_, 1);
    }
    static void note(j_common_ptr jpeg, int level) {
        if (level < 0)
            ++jpeg->err->num_warnings;
    }
    static void limitScans(j_common_ptr jpeg) {
        const auto* self = static_cast<JpegReader*>(jpeg->client_data);
        if (self->jpeg_.input_scan_number > kMaxScans)
            fail(jpeg);
    }

    std::string_view bytes_;
    jpeg_decompress_struct jpeg_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    std::jmp_buf jump_{};
};

}  // namespace

bool decodeJpeg(std::string_view bytes, const ImageHeader& header, cv::Mat& picture) {
    JpegReader reader(bytes);
    if (!reader.readHeader())
        return false;
    picture.create(static_cast<int>(header.height), static_cast<int>(header.width),
                   reader.isColour() ? CV_8UC3 : CV_8UC1);
    return reader.readRows(picture);
}

}  // namespace skincal
