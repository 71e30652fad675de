#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/vision/coded_scan.h"
#include "core/vision/decoder.h"

namespace skincal {

/// A spot while its scan is under way.
struct LiveSpot {
    Vector2d pixel = Vector2d::Zero();  ///< to the pixel
    double contrast = 0;                ///< grey levels between on and off at its core
    std::size_t possible = 0;           ///< modules whose word begins as what was received; 0: it is none of them
    std::optional<ModuleId> module{};   ///< where only one is possible
};

/// Spots of a scan that is not over yet, for the eyes of who watches: from the first picture with light after one
/// without, bit by bit by plain thresholds. What counts is decided by decodeView from all pictures together.
class LiveSpots {
  public:
    LiveSpots(std::vector<ModuleId> modules, LitSets lit, const DecoderOptions& options = {});

    /// The next picture, 8-bit BGR or grey, in the order of the lit sets. Returns false where it can't be read (another
    /// size or depth than the ones before), or is one too many: it is ignored then.
    bool add(const cv::Mat& picture);
    [[nodiscard]] std::size_t pictures() const { return next_; }
    [[nodiscard]] std::vector<LiveSpot> spots() const;

  private:
    struct Spot {
        SpotCandidate at;
        double off = 0;
        double on = 0;
        std::string word{};  ///< received, one character per picture
    };

    void find(const FramePixels& dark, const FramePixels& light);

    std::vector<ModuleId> modules_;
    LitSets lit_;
    DecoderOptions options_;
    std::vector<std::string> words_;  ///< sent so far, per module
    std::optional<FramePixels> before_;
    std::vector<Spot> spots_;
    std::size_t found_ = 0;  ///< how many pictures there were when the spots were found
    std::size_t next_ = 0;
};

}  // namespace skincal
