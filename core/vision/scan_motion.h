#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/vision/amplitude_map.h"

namespace skincal {

/// Two places of one module's LED, seen in different parts of a scan.
struct SplitSighting {
    Vector2d early = Vector2d::Zero();
    Vector2d late = Vector2d::Zero();
};

/// Whether the camera moved while a view was scanned: where LEDs are in the first half of its planes, and where in the
/// second. A knock of less than a pixel leaves every spot in its place, for the halves to tell; of a larger one each
/// half makes spots of its own (SplitSighting).
class ScanMotion {
  public:
    explicit ScanMotion(int radius, const SpotFitOptions& options) : radius_(radius), options_(options) {}

    /// A spot that one word explains; does nothing where its word can't be told from drift in one of the halves.
    void watch(const SpotCandidate& spot, cv::Size picture, const Codebook& codebook, const LightFilter& filter);
    void add(std::span<const FramePlane> planes, const ImageNoise& noise);

    /// Median shift over the spots, px; zero where it is no more than noise; nothing where fewer than three can tell.
    [[nodiscard]] std::optional<double> moved_px() const;
    /// The same from modules that were seen in two places.
    [[nodiscard]] static std::optional<double> moved_px(std::span<const SplitSighting> sightings);

  private:
    struct Halves {
        AmplitudeMap early;
        AmplitudeMap late;
    };
    int radius_;
    SpotFitOptions options_;
    std::vector<Halves> spots_;
};

}  // namespace skincal
