#include "core/session/session_storage.h"

#include <fmt/format.h>

#include "core/vision/decoder.h"

namespace skincal {
namespace {

tl::expected<void, std::string> decodePictures(ScannedView& view, const std::filesystem::path& directory,
                                               const CameraModel& camera, const std::vector<ModuleId>& modules,
                                               const RunContext& context) {
    auto pictures = std::make_shared<Pictures>();
    for (const FrameInfo& frame : view.frames) {
        if (context.isCancelled())
            return tl::unexpected(std::string());
        auto picture = loadFrame(directory, frame, camera);
        if (!picture)
            return tl::unexpected(picture.error().message());
        pictures->push_back(*std::move(picture));
    }
    const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> { return (*pictures)[k]; };
    auto decoded = decodeView(view.name, modules, view.frames, load, {}, context);
    if (!decoded)
        return tl::unexpected(decoded.error().cancelled ? std::string() : decoded.error().message);
    view.decoded = *std::move(decoded);
    view.pictures = std::move(pictures);
    return {};
}

/// Names for pictures that were taken here and have none yet; no two views share one.
void nameFrames(ScannedView& view, std::size_t number) {
    for (std::size_t k = 0; k < view.frames.size(); ++k) {
        if (view.frames[k].file.empty())
            view.frames[k].file = fmt::format("views/{:03}/{:05}.png", number, k);
    }
}

}  // namespace

tl::expected<OpenedRecording, std::string> readSession(const std::filesystem::path& directory,
                                                       const RunContext& context) {
    const auto recording = readRecording(directory, Completeness::Begun);
    if (!recording)
        return tl::unexpected(recording.error().message());
    OpenedRecording opened = openedFrom(*recording);
    std::vector<ModuleId> modules;
    for (const SkinModule& module : recording->skin.modules)
        modules.push_back(module.id);
    auto& views = opened.measured.views;
    for (std::size_t v = 0; v < views.size(); ++v) {
        context.report("reading pictures", static_cast<double>(v) / static_cast<double>(views.size()));
        if (views[v].frames.empty())
            continue;
        if (const auto decoded = decodePictures(views[v], directory, recording->camera, modules, context); !decoded)
            return tl::unexpected(decoded.error());
    }
    return opened;
}

tl::expected<void, std::string> writeSession(const Measured& measured, const Decisions& decisions,
                                             const std::filesystem::path& directory) {
    Measured named = measured;
    std::set<std::string> taken;
    for (const ScannedView& view : named.views) {
        for (const FrameInfo& frame : view.frames)
            taken.insert(std::filesystem::path(frame.file).parent_path().string());
    }
    std::size_t number = 0;
    for (ScannedView& view : named.views) {
        while (taken.contains(fmt::format("views/{:03}", number)))
            ++number;
        nameFrames(view, number);
        if (!view.frames.empty())
            taken.insert(std::filesystem::path(view.frames.front().file).parent_path().string());
        if (!view.pictures)
            continue;
        for (std::size_t k = 0; k < view.frames.size(); ++k) {
            if (std::filesystem::exists(directory / view.frames[k].file))
                continue;
            if (const auto written = writeFrame(directory, view.frames[k].file, (*view.pictures)[k]); !written)
                return tl::unexpected(written.error().message());
        }
    }
    if (const auto written = writeRecording(recordingOf(named, decisions), directory, true); !written)
        return tl::unexpected(written.error().message());
    return {};
}

}  // namespace skincal
