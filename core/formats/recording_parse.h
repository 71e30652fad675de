#pragma once

/// The reader of a recording taken apart, for tests and fuzzing: text in, values out, no file system.

#include <filesystem>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/formats/recording.h"

namespace skincal {

/// Above these a recording is refused: no skin is that large, a damaged file easily is.
inline constexpr std::size_t kMaxModules = 1'000'000;
inline constexpr int kMaxLooks = 1000;  // of a view
inline constexpr std::size_t kMaxLinks = 4'000'000;
inline constexpr std::size_t kMaxTemplates = 1'000;
inline constexpr std::size_t kMaxPorts = 64;
inline constexpr std::size_t kMaxViews = 100'000;
inline constexpr std::size_t kMaxFramesPerView = 1'000'000;
inline constexpr long kMaxImageSide = 16'384;
inline constexpr double kMaxImagePixels = 64e6;
/// Focal lengths outside of these shares of the picture's width are refused: no lens has them, a wrong unit has.
inline constexpr double kMinFocalShare = 0.05;
inline constexpr double kMaxFocalShare = 50;
inline constexpr std::size_t kMaxJsonBytes = std::size_t{128} << 20U;
inline constexpr std::size_t kMaxCsvBytes = std::size_t{4} << 30U;
inline constexpr std::size_t kMaxImageBytes = std::size_t{256} << 20U;

/// Standard deviations outside of these are refused, m/s^2 and px alike.
inline constexpr double kMinSigma = 1e-6;
inline constexpr double kMaxSigma = 1e6;

/// Everything but gravity and detections, whose files it names.
[[nodiscard]] tl::expected<Recording, FileError> parseRecordingJson(std::string_view text,
                                                                    const std::filesystem::path& file,
                                                                    Completeness completeness = Completeness::Whole);

/// Fills recording.gravity.
[[nodiscard]] tl::expected<void, FileError> parseGravityCsv(std::string_view text, const std::filesystem::path& file,
                                                            Recording& recording);

/// Fills the views' detections.
[[nodiscard]] tl::expected<void, FileError> parseDetectionsCsv(std::string_view text, const std::filesystem::path& file,
                                                               Recording& recording);

}  // namespace skincal
