#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/adjustment/measurements.h"
#include "core/estimation/body_model.h"
#include "core/estimation/joint_method.h"
#include "core/estimation/paper_method.h"
#include "core/estimation/sturdy_method.h"
#include "core/formats/recording.h"
#include "core/vision/decoder.h"
#include "core/vision/paper_detector.h"

namespace skincal {

enum class Method {
    Paper,   ///< the paper to the letter: the baseline
    Sturdy,  ///< without its weaknesses: where Joint starts from
    Joint,   ///< everything at once, weighed by what the residuals show, with covariances: the default
};

[[nodiscard]] std::string_view name(Method method);
[[nodiscard]] std::optional<Method> methodFromName(std::string_view text);

struct CalibrateOptions {
    Method method = Method::Joint;
    PaperMethodOptions paper;
    PaperDetectorOptions paperDetector;
    SturdyMethodOptions sturdy;
    JointMethodOptions joint;
    DecoderOptions decoder;
};

/// Loads frame `frame` of view `view`.
using RecordingFrameLoader = std::function<tl::expected<cv::Mat, std::string>(std::size_t view, std::size_t frame)>;

/// Why there is no body: the data or the files.
struct CalibrateError {
    std::string message;
    bool badInput = false;  ///< a picture could not be read, rather than the data not sufficing
    bool cancelled = false;
};

/// The loader for a recording's own pictures.
[[nodiscard]] RecordingFrameLoader framesOf(const std::filesystem::path& directory, const Recording& recording);

/// LED positions of every view: from its frames where it has any, else its detections; what the operator rejected is
/// taken out. The paper's method uses the paper's detector where the frames suit it (a pattern of many LEDs at once
/// has none in the paper; the decoder stands in).
[[nodiscard]] tl::expected<Measurements, CalibrateError> measure(const Recording& recording,
                                                                 const RecordingFrameLoader& load,
                                                                 const CalibrateOptions& options = {},
                                                                 const RunContext& context = {});

/// The one computation: a recording in, a body model out; pure and repeatable.
[[nodiscard]] tl::expected<BodyModel, CalibrateError> calibrate(const Recording& recording,
                                                                const RecordingFrameLoader& load,
                                                                const CalibrateOptions& options = {},
                                                                const RunContext& context = {});

}  // namespace skincal
