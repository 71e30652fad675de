#include "core/workflow/simulated_recording.h"

#include <algorithm>
#include <memory>

#include "core/simulation/renderer.h"

namespace skincal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecordingFile = "recording.json";

bool hasColour(const std::vector<FrameInfo>& frames) {
    return std::any_of(frames.begin(), frames.end(), [](const FrameInfo& frame) {
        return std::any_of(frame.lit.begin(), frame.lit.end(), [](const LitModule& l) { return l.colour.has_value(); });
    });
}

bool isNumber(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Goes only where it is empty: whatever else somebody put there stays, and so does the folder.
void removeEmptyFolder(const fs::path& folder) {
    std::error_code error;
    if (fs::is_directory(fs::symlink_status(folder, error)) && fs::is_empty(folder, error))
        fs::remove(folder, error);
}

/// Pictures of a recording, by the names that recordings give them: views/NNN/NNNNN.png or .jpg.
std::vector<fs::path> picturesIn(const fs::path& folder) {
    std::vector<fs::path> pictures;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string extension = entry.path().extension().string();
        const bool picture = extension == ".png" || extension == ".jpg" || extension == ".jpeg";
        if (picture && isNumber(entry.path().stem().string()) && fs::is_regular_file(entry.symlink_status(error)))
            pictures.push_back(entry.path());
    }
    return pictures;
}

std::vector<fs::path> viewFoldersIn(const fs::path& directory) {
    std::vector<fs::path> folders;
    std::error_code error;
    // A link may lead anywhere; what is behind it is not this recording's.
    if (!fs::is_directory(fs::symlink_status(directory / "views", error)))
        return folders;
    for (const auto& entry : fs::directory_iterator(directory / "views", error)) {
        if (isNumber(entry.path().filename().string()) && fs::is_directory(entry.symlink_status(error)))
            folders.push_back(entry.path());
    }
    return folders;
}

/// recording.json first: what is left half-way through is no recording any more.
tl::expected<void, FileError> removeRecording(const fs::path& directory) {
    std::vector<fs::path> members{directory / kRecordingFile, directory / "gravity.csv", directory / "detections.csv"};
    const auto folders = viewFoldersIn(directory);
    for (const fs::path& folder : folders) {
        const auto pictures = picturesIn(folder);
        members.insert(members.end(), pictures.begin(), pictures.end());
    }
    for (const fs::path& member : members) {
        std::error_code error;
        fs::remove(member, error);
        if (error)
            return tl::unexpected(FileError{member, "", "can't remove it: " + error.message()});
    }
    for (const fs::path& folder : folders)
        removeEmptyFolder(folder);
    removeEmptyFolder(directory / "views");
    return {};
}

tl::expected<void, FileError> writePictures(const World& world, const Recording& recording, const fs::path& directory,
                                            const RunContext& context) {
    const auto load = framesOf(world, recording);
    const auto views = static_cast<double>(recording.views.size());
    for (std::size_t v = 0; v < recording.views.size(); ++v) {
        const auto& frames = recording.views[v].frames;
        for (std::size_t f = 0; f < frames.size(); ++f) {
            const double share = static_cast<double>(f) / static_cast<double>(frames.size());
            context.report(Sentence::saying("drawing pictures"), (static_cast<double>(v) + share) / views);
            if (context.isCancelled())
                return tl::unexpected(FileError{directory, "", "cancelled, nothing is recorded"});
            if (auto written = writeFrame(directory, frames[f].file, *load(v, f)); !written)
                return written;
        }
    }
    return {};
}

/// Takes back what writePictures wrote.
void removePictures(const Recording& recording, const fs::path& directory) {
    for (const RecordedView& view : recording.views) {
        fs::path folder;
        for (const FrameInfo& frame : view.frames) {
            std::error_code error;
            fs::remove(directory / frame.file, error);
            folder = (directory / frame.file).parent_path();
        }
        if (!folder.empty())
            removeEmptyFolder(folder);
    }
    removeEmptyFolder(directory / "views");
    removeEmptyFolder(directory);
}

}  // namespace

Recording recordingOf(const World& world) {
    Recording recording;
    recording.skin = world.skin;
    recording.gravity = simulateGravity(world);
    recording.camera = world.scenario.camera;
    const bool pictures = world.scenario.views.scan != ScanKind::Detections;
    const auto detections = pictures ? std::vector<ViewDetections>{} : simulateDetections(world);
    for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
        RecordedView view;
        view.name = viewName(v);
        if (pictures)
            view.frames = planScan(world, v);
        else
            view.detections = detections[v].found;
        recording.views.push_back(std::move(view));
    }
    return recording;
}

RecordingFrameLoader framesOf(const World& world, const Recording& recording) {
    // A renderer is costly to make and frames are read view by view: the last one is kept.
    struct Current {
        std::size_t view = 0;
        std::unique_ptr<FrameRenderer> renderer;
    };
    auto current = std::make_shared<Current>();
    return [&world, &recording, current](std::size_t view, std::size_t frame) -> tl::expected<cv::Mat, std::string> {
        const auto& frames = recording.views[view].frames;
        if (!current->renderer || current->view != view) {
            current->renderer = std::make_unique<FrameRenderer>(world, view, frames.size());
            current->view = view;
        }
        return current->renderer->render(frames[frame].lit, frame, hasColour(frames));
    };
}

tl::expected<void, FileError> writeSimulation(const World& world, const std::filesystem::path& directory,
                                              bool overwrite, const RunContext& context) {
    const Recording recording = recordingOf(world);
    std::error_code error;
    if (fs::exists(directory / kRecordingFile, error)) {
        if (!overwrite)
            return tl::unexpected(FileError{directory, "", "there is a recording already"});
        if (auto removed = removeRecording(directory); !removed)
            return removed;
    }
    // recording.json last: a directory without it is no recording, so one without its pictures is never read.
    auto written = writePictures(world, recording, directory, context);
    if (written)
        written = writeRecording(recording, directory, overwrite);
    if (!written)
        removePictures(recording, directory);
    return written;
}

}  // namespace skincal
