#include "core/workflow/calibrate.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/estimation/stage_clock.h"
#include "core/vision/verdicts.h"

namespace skincal {
namespace {

tl::expected<ViewDetections, CalibrateError> detect(const Recording& recording, std::size_t v,
                                                    const std::vector<ModuleId>& modules,
                                                    const RecordingFrameLoader& load, const CalibrateOptions& options,
                                                    const RunContext& context) {
    const RecordedView& view = recording.views[v];
    if (view.frames.empty())
        return ViewDetections{view.name, view.detections, {}};
    const FrameLoader loadFrameOfView = [&](std::size_t frame) { return load(v, frame); };
    RunContext part = context;
    part.report = [&](const Sentence&, double done) {
        context.report(Sentence::saying("reading frames"),
                       (static_cast<double>(v) + done) / static_cast<double>(recording.views.size()));
    };
    const bool paper = options.method == Method::Paper && suitsPaperDetector(view.frames, options.paperDetector);
    auto found = paper ? detectPaper(view.name, modules, view.frames, loadFrameOfView, options.paperDetector, part)
                       : decodeView(view.name, modules, view.frames, loadFrameOfView, options.decoder, part);
    if (!found)
        return tl::unexpected(
            CalibrateError{found.error().message.english(), !found.error().cancelled, found.error().cancelled});
    return *found;
}

/// The operator's word: a rejected detection counts as not found, and so do several spots of which none was sure.
void applyDecisions(const Recording& recording, ViewDetections& view) {
    for (const Decision& decision : recording.decisions) {
        if (decision.view != view.name || decision.verdict != "rejected")
            continue;
        const auto removed =
            std::erase_if(view.found, [&](const LedDetection& d) { return d.module == decision.module; });
        const Sentence why = rejectedByOperator(decision.reason);
        if (removed > 0)
            view.undetected.push_back(
                {decision.module, DetectionVerdict::NotFound, why, {}, Undetected::Cause::Rejected});
        for (Undetected& undetected : view.undetected) {
            if (undetected.module == decision.module && !undetected.spots.empty())
                undetected = {decision.module, DetectionVerdict::NotFound, why, {}, Undetected::Cause::Rejected};
        }
    }
}

}  // namespace

std::string_view name(Method method) {
    switch (method) {
        case Method::Paper:
            return "paper";
        case Method::Joint:
            return "joint";
        default:
            return "sturdy";
    }
}

std::optional<Method> methodFromName(std::string_view text) {
    for (const Method method : {Method::Paper, Method::Sturdy, Method::Joint}) {
        if (name(method) == text)
            return method;
    }
    return std::nullopt;
}

RecordingFrameLoader framesOf(const std::filesystem::path& directory, const Recording& recording) {
    return [directory, &recording](std::size_t view, std::size_t frame) -> tl::expected<cv::Mat, std::string> {
        auto picture = loadFrame(directory, recording.views[view].frames[frame], recording.camera);
        if (!picture)
            return tl::unexpected(picture.error().message());
        return *picture;
    };
}

tl::expected<Measurements, CalibrateError> measure(const Recording& recording, const RecordingFrameLoader& load,
                                                   const CalibrateOptions& options, const RunContext& context) {
    Measurements measurements{recording.skin, recording.gravity, recording.camera, {}};
    std::vector<ModuleId> modules;
    for (const SkinModule& module : recording.skin.modules)
        modules.push_back(module.id);
    for (std::size_t v = 0; v < recording.views.size(); ++v) {
        auto view = detect(recording, v, modules, load, options, context);
        if (!view)
            return tl::unexpected(view.error());
        applyDecisions(recording, *view);
        measurements.views.push_back(std::move(*view));
    }
    return measurements;
}

tl::expected<BodyModel, CalibrateError> calibrate(const Recording& recording, const RecordingFrameLoader& load,
                                                  const CalibrateOptions& options, const RunContext& context) {
    const StageClock reading("reading frames");
    const auto measurements = measure(recording, load, options, context);
    if (!measurements)
        return tl::unexpected(measurements.error());
    const StageReport read = reading.stop();
    const StageClock estimating("estimate");
    auto body = options.method == Method::Paper   ? calibratePaper(*measurements, options.paper, context)
                : options.method == Method::Joint ? calibrateJoint(*measurements, options.joint, context)
                                                  : calibrateSturdy(*measurements, options.sturdy, context);
    if (!body)
        return tl::unexpected(CalibrateError{body.error().message(), false, body.error().code == ErrorCode::Cancelled});
    auto& stages = body->quality.stages;
    if (stages.empty())
        stages.push_back(estimating.stop());
    const bool anyFrames = std::any_of(recording.views.begin(), recording.views.end(),
                                       [](const RecordedView& view) { return !view.frames.empty(); });
    if (anyFrames)
        stages.insert(stages.begin(), read);
    body->generator.version = SKINCAL_VERSION;
    body->generator.options["method"] = std::string(name(options.method));
    if (options.method == Method::Joint && options.joint.misalignmentSigma > 0)
        body->generator.options["misalignment_deg"] = fmt::format("{}", options.joint.misalignmentSigma / kDegree);
    return *body;
}

}  // namespace skincal
