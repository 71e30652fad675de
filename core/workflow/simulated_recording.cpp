#include "core/workflow/simulated_recording.h"

#include <algorithm>
#include <memory>

#include "core/simulation/renderer.h"

namespace skincal {
namespace {

bool hasColour(const std::vector<FrameInfo>& frames) {
    return std::any_of(frames.begin(), frames.end(), [](const FrameInfo& frame) {
        return std::any_of(frame.lit.begin(), frame.lit.end(), [](const LitModule& l) { return l.colour.has_value(); });
    });
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
    if (auto written = writeRecording(recording, directory, overwrite); !written)
        return written;
    const auto load = framesOf(world, recording);
    for (std::size_t v = 0; v < recording.views.size(); ++v) {
        context.report("drawing pictures", static_cast<double>(v) / static_cast<double>(recording.views.size()));
        for (std::size_t f = 0; f < recording.views[v].frames.size(); ++f) {
            if (context.isCancelled())
                return tl::unexpected(FileError{directory, "", "cancelled, the recording is incomplete"});
            if (auto written = writeFrame(directory, recording.views[v].frames[f].file, *load(v, f)); !written)
                return written;
        }
    }
    return {};
}

}  // namespace skincal
