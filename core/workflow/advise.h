#pragma once

#include "core/estimation/next_measurement.h"
#include "core/estimation/observability.h"
#include "core/workflow/calibrate.h"

namespace skincal {

struct AdviseOptions {
    CalibrateOptions calibrate;  ///< the method is always the joint one: it alone has covariances
    ShortfallOptions shortfalls;
    NextMeasurementOptions next;
};

/// What a recording lacks and what to measure next.
struct Advice {
    BodyModel body;  ///< as calibrate() has it
    std::vector<Shortfall> shortfalls;
    std::vector<NextPose> poses;  ///< the best first; empty where nothing can be forecast
    std::vector<NextView> views;
    std::optional<double> worst;          ///< m, standard deviation of the worst module in the body itself
    std::optional<ModuleId> worstModule;  ///< which it is
    std::optional<double> worstSize;      ///< m, the part of it that is the body's size, which links alone tell
    std::optional<double> rms;            ///< m, over all placed modules
    std::optional<double> scale;          ///< relative standard deviation of the body's size
};

/// A recording in, advice out: solved jointly, then findShortfalls, rankNextPoses and rankNextViews. Pure and
/// repeatable. Fails as calibrate() does; that the data do not suffice to forecast anything is no failure.
[[nodiscard]] tl::expected<Advice, CalibrateError> advise(const Recording& recording, const RecordingFrameLoader& load,
                                                          AdviseOptions options = {}, const RunContext& context = {});

}  // namespace skincal
