#pragma once

#include <functional>
#include <opencv2/core/types.hpp>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "core/geometry/run_context.h"
#include "core/geometry/sentence.h"
#include "core/vision/frame.h"
#include "core/vision/frame_pixels.h"

namespace skincal {

struct ScanError {
    Sentence message;  ///< a sentence that names the file, from the loader
    bool cancelled = false;
};

/// Loads the frames of a view one after the other, checks them and hands them on; reports progress and stops when
/// asked.
class FramePass {
  public:
    FramePass(std::span<const FrameInfo> frames, const FrameLoader& load, bool coloured, const RunContext& context)
        : frames_(frames), load_(load), coloured_(coloured), context_(context) {}

    /// @param from, to  the share of the whole work that this pass is
    /// Fails as FramePixels::make, with the loader's error, or with "cancelled".
    [[nodiscard]] tl::expected<void, ScanError> run(const Sentence& stage, double from, double to,
                                                    const std::function<void(std::size_t, const FramePixels&)>& visit);

  private:
    std::span<const FrameInfo> frames_;
    const FrameLoader& load_;
    bool coloured_;
    const RunContext& context_;
    cv::Size size_{};
};

}  // namespace skincal
