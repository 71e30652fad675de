#include <fmt/format.h>

#include "core/formats/files.h"
#include "core/formats/picture_decode.h"
#include "core/formats/recording.h"
#include "core/formats/recording_parse.h"

namespace skincal {
namespace {

namespace fs = std::filesystem;

tl::expected<std::string, FileError> readMember(const fs::path& directory, const std::string& relative,
                                                const std::string& place, std::size_t limit) {
    const auto path = resolveInside(directory, relative);
    if (!path)
        return tl::unexpected(FileError{directory / "recording.json", place, path.error()});
    return readFile(*path, limit);
}

tl::expected<void, FileError> checkFrames(const fs::path& directory, const Recording& recording) {
    for (std::size_t v = 0; v < recording.views.size(); ++v) {
        for (std::size_t f = 0; f < recording.views[v].frames.size(); ++f) {
            const auto path = resolveInside(directory, recording.views[v].frames[f].file);
            if (!path)
                return tl::unexpected(FileError{directory / "recording.json",
                                                fmt::format("views[{}].frames[{}].file", v, f), path.error()});
            std::error_code error;
            const fs::file_status status = fs::status(*path, error);
            if (fs::is_regular_file(status))
                continue;
            const std::string& file = recording.views[v].frames[f].file;
            std::string problem = fmt::format("expected a picture, there is no such file '{}'", file);
            if (status.type() == fs::file_type::none)
                problem = fmt::format("expected a readable file, '{}' is none: {}", file, error.message());
            else if (fs::exists(status))
                problem = fmt::format("expected a regular file, '{}' is none", file);
            return tl::unexpected(FileError{directory / "recording.json",
                                            fmt::format("views[{}].frames[{}].file", v, f), std::move(problem)});
        }
    }
    return {};
}

}  // namespace

tl::expected<Recording, FileError> readRecording(const fs::path& directory, Completeness completeness) {
    const fs::path jsonFile = directory / "recording.json";
    std::error_code error;
    const fs::file_status status = fs::status(directory, error);
    if (status.type() == fs::file_type::none)
        return tl::unexpected(FileError{directory, "", "expected a readable directory: " + error.message()});
    if (!fs::is_directory(status))
        return tl::unexpected(FileError{directory, "", "expected a recording, a directory that holds recording.json"});
    const auto text = readFile(jsonFile, kMaxJsonBytes);
    if (!text)
        return tl::unexpected(text.error());
    auto recording = parseRecordingJson(*text, jsonFile, completeness);
    if (!recording)
        return recording;
    const auto gravity = readMember(directory, recording->gravityFile, "gravity", kMaxCsvBytes);
    if (!gravity)
        return tl::unexpected(gravity.error());
    if (const auto result = parseGravityCsv(*gravity, directory / recording->gravityFile, *recording); !result)
        return tl::unexpected(result.error());
    if (!recording->detectionsFile.empty()) {
        const auto csv = readMember(directory, recording->detectionsFile, "detections", kMaxCsvBytes);
        if (!csv)
            return tl::unexpected(csv.error());
        if (const auto result = parseDetectionsCsv(*csv, directory / recording->detectionsFile, *recording); !result)
            return tl::unexpected(result.error());
    }
    if (const auto result = checkFrames(directory, *recording); !result)
        return tl::unexpected(result.error());
    return recording;
}

tl::expected<cv::Mat, FileError> loadFrame(const fs::path& directory, const FrameInfo& frame,
                                           const CameraModel& camera) {
    const auto path = resolveInside(directory, frame.file);
    if (!path)
        return tl::unexpected(FileError{directory / frame.file, "", path.error()});
    const auto bytes = readFile(*path, kMaxImageBytes);
    if (!bytes)
        return tl::unexpected(bytes.error());
    const auto header = parseImageHeader(*bytes);
    if (!header)
        return tl::unexpected(FileError{*path, "", header.error()});
    if (header->width != camera.width || header->height != camera.height)
        return tl::unexpected(FileError{*path, "",
                                        fmt::format("expected a picture of the camera's size {}x{}, found {}x{}",
                                                    camera.width, camera.height, header->width, header->height)});
    const auto picture = decodePicture(*bytes, *header);
    if (!picture)
        return tl::unexpected(FileError{*path, "", picture.error()});
    return *picture;
}

std::vector<std::string> filesOf(const Recording& recording) {
    std::vector<std::string> files{"recording.json", recording.gravityFile};
    if (!recording.detectionsFile.empty())
        files.push_back(recording.detectionsFile);
    for (const RecordedView& view : recording.views) {
        for (const FrameInfo& frame : view.frames)
            files.push_back(frame.file);
    }
    return files;
}

tl::expected<std::map<std::string, std::string>, FileError> digestRecording(const fs::path& directory,
                                                                            const Recording& recording) {
    std::map<std::string, std::string> digests;
    for (const std::string& file : filesOf(recording)) {
        const auto bytes = readMember(directory, file, "", kMaxCsvBytes);
        if (!bytes)
            return tl::unexpected(bytes.error());
        digests[file] = sha256(*bytes);
    }
    return digests;
}

}  // namespace skincal
