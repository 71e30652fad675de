#include "core/vision/frame_pass.h"

namespace skincal {

tl::expected<void, ScanError> FramePass::run(const Sentence& stage, double from, double to,
                                             const std::function<void(std::size_t, const FramePixels&)>& visit) {
    for (std::size_t k = 0; k < frames_.size(); ++k) {
        if (context_.isCancelled())
            return tl::unexpected(ScanError{Sentence::saying("cancelled"), true});
        context_.report(stage, from + (to - from) * static_cast<double>(k) / static_cast<double>(frames_.size()));
        auto loaded = load_(k);
        if (!loaded)
            return tl::unexpected(ScanError{Sentence::verbatim(std::move(loaded.error())), false});
        const auto pixels = FramePixels::make(std::move(*loaded), frames_[k].file, size_, coloured_);
        if (!pixels)
            return tl::unexpected(ScanError{pixels.error(), false});
        size_ = pixels->size();
        visit(k, *pixels);
    }
    return {};
}

}  // namespace skincal
