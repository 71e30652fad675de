#include "core/session/session_storage.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>

#include "core/formats/files.h"
#include "core/formats/recording_bytes.h"
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
        return tl::unexpected(decoded.error().cancelled ? std::string() : decoded.error().message.english());
    view.decoded = *std::move(decoded);
    view.pictures = std::move(pictures);
    return {};
}

bool isThere(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::exists(file, error);
}

/// Whether that very picture is there, to the last bit.
bool holds(const std::filesystem::path& directory, const FrameInfo& frame, const cv::Mat& picture) {
    CameraModel size;
    size.width = picture.cols;
    size.height = picture.rows;
    const auto there = loadFrame(directory, frame, size);
    return there && there->type() == picture.type() && cv::norm(*there, picture, cv::NORM_INF) == 0;
}

/// Where a recording goes; nothing: where there is nothing yet.
using Place = std::optional<std::filesystem::path>;

/// Whether a view's files hold its own pictures or are not there yet. Files of an earlier scan of the view, or of
/// another recording, may be in their place.
bool hasPlace(const ScannedView& view, const Place& directory) {
    for (std::size_t k = 0; k < view.frames.size(); ++k) {
        const FrameInfo& frame = view.frames[k];
        if (frame.file.empty() ||
            (directory && isThere(*directory / frame.file) && !holds(*directory, frame, (*view.pictures)[k])))
            return false;
    }
    return true;
}

/// Names files for a view's pictures, the old ones where these will do. No two views share a folder.
void findPlace(ScannedView& view, const Place& directory, std::set<std::string>& taken) {
    for (std::size_t number = 0; !hasPlace(view, directory); ++number) {
        const std::string folder = fmt::format("views/{:03}", number);
        if (taken.contains(folder))
            continue;
        for (std::size_t k = 0; k < view.frames.size(); ++k)
            view.frames[k].file = fmt::format("{}/{:05}.png", folder, k);
    }
    for (const FrameInfo& frame : view.frames)
        taken.insert(std::filesystem::path(frame.file).parent_path().string());
}

bool isWritten(const ScannedView& view, const Decisions& decisions) {
    return view.pictures && decisions.camera && !decisions.droppedViews.contains(view.name);
}

/// With a name for every picture that is written.
Measured named(Measured measured, const Decisions& decisions, const Place& directory) {
    std::set<std::string> taken;
    for (const ScannedView& view : measured.views) {
        for (const FrameInfo& frame : view.frames)
            taken.insert(std::filesystem::path(frame.file).parent_path().string());
    }
    for (ScannedView& view : measured.views) {
        if (isWritten(view, decisions))
            findPlace(view, directory, taken);
    }
    return measured;
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
        context.report(Sentence::saying("reading pictures"),
                       static_cast<double>(v) / static_cast<double>(views.size()));
        if (views[v].frames.empty())
            continue;
        if (const auto decoded = decodePictures(views[v], directory, recording->camera, modules, context); !decoded)
            return tl::unexpected(decoded.error());
    }
    return opened;
}

tl::expected<void, std::string> writeSession(const Measured& measured, const Decisions& decisions,
                                             const std::filesystem::path& directory) {
    const Measured whole = named(measured, decisions, directory);
    for (const ScannedView& view : whole.views) {
        for (std::size_t k = 0; isWritten(view, decisions) && k < view.frames.size(); ++k) {
            if (isThere(directory / view.frames[k].file))
                continue;
            if (const auto written = writeFrame(directory, view.frames[k].file, (*view.pictures)[k]); !written)
                return tl::unexpected(written.error().message());
        }
    }
    if (const auto written = writeRecording(recordingOf(whole, decisions), directory, true); !written)
        return tl::unexpected(written.error().message());
    return {};
}

std::optional<std::map<std::string, std::string>> digestSession(const Measured& measured, const Decisions& decisions,
                                                                PictureDigests& known, const RunContext& context) {
    if (!decisions.camera)
        return std::nullopt;
    const Measured whole = named(measured, decisions, std::nullopt);
    std::map<std::string, std::string> digests;
    for (const ScannedView& view : whole.views) {
        if (!isWritten(view, decisions))
            continue;
        auto& ofView = known[view.pictures];
        for (std::size_t k = 0; k < view.frames.size(); ++k) {
            if (context.isCancelled())
                return std::nullopt;
            if (ofView.size() == k)
                ofView.push_back(sha256(pngOf((*view.pictures)[k])));
            digests[view.frames[k].file] = ofView[k];
        }
    }
    for (const auto& [file, text] : textsOf(recordingOf(whole, decisions)))
        digests[file] = sha256(text);
    return digests;
}

}  // namespace skincal
