#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "core/formats/files.h"
#include "core/formats/image_header.h"
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
            if (!fs::is_regular_file(*path, error))
                return tl::unexpected(FileError{*path, "", "expected a picture, there is no such file"});
        }
    }
    return {};
}

}  // namespace

tl::expected<Recording, FileError> readRecording(const fs::path& directory) {
    const fs::path jsonFile = directory / "recording.json";
    std::error_code error;
    if (!fs::is_directory(directory, error))
        return tl::unexpected(FileError{directory, "", "expected a recording, a directory that holds recording.json"});
    const auto text = readFile(jsonFile, kMaxJsonBytes);
    if (!text)
        return tl::unexpected(text.error());
    auto parsed = parseRecordingJson(*text, jsonFile);
    if (!parsed)
        return tl::unexpected(parsed.error());
    Recording& recording = parsed->recording;
    if (parsed->gravityFile) {
        const auto csv = readMember(directory, *parsed->gravityFile, "gravity", kMaxCsvBytes);
        if (!csv)
            return tl::unexpected(csv.error());
        if (const auto result = parseGravityCsv(*csv, directory / *parsed->gravityFile, recording); !result)
            return tl::unexpected(result.error());
    }
    if (parsed->detectionsFile) {
        const auto csv = readMember(directory, *parsed->detectionsFile, "detections", kMaxCsvBytes);
        if (!csv)
            return tl::unexpected(csv.error());
        if (const auto result = parseDetectionsCsv(*csv, directory / *parsed->detectionsFile, recording); !result)
            return tl::unexpected(result.error());
    }
    if (const auto result = checkFrames(directory, recording); !result)
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
    if (header->bitsPerSample != 8)
        return tl::unexpected(
            FileError{*path, "", fmt::format("expected 8 bits per channel, found {}", header->bitsPerSample)});
    const FileError damaged{*path, "", "expected a picture that can be decoded, it is damaged"};
    // The decoder fills what a cut-off JPEG lacks with grey and calls that a success. An end before the last scan is
    // that of a thumbnail; within a scan's data neither marker occurs.
    if (header->format == ImageFormat::Jpeg) {
        const auto end = bytes->rfind("\xFF\xD9");
        if (end == std::string::npos || end < bytes->rfind("\xFF\xDA"))
            return tl::unexpected(damaged);
    }
    cv::Mat picture;
    try {
        const cv::Mat buffer(1, static_cast<int>(bytes->size()), CV_8UC1, const_cast<char*>(bytes->data()));
        // Orientation tags would turn the picture under its calibration; an alpha channel means nothing here.
        picture = cv::imdecode(buffer, cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) {
        picture.release();
    }
    if (picture.empty() || picture.cols != camera.width || picture.rows != camera.height)
        return tl::unexpected(damaged);
    return picture;
}

tl::expected<std::map<std::string, std::string>, FileError> digestRecording(const fs::path& directory,
                                                                            const Recording& recording) {
    const auto text = readFile(directory / "recording.json", kMaxJsonBytes);
    if (!text)
        return tl::unexpected(text.error());
    const auto parsed = parseRecordingJson(*text, directory / "recording.json");
    if (!parsed)
        return tl::unexpected(parsed.error());
    std::map<std::string, std::string> digests{{"recording.json", sha256(*text)}};
    std::vector<std::pair<std::string, std::string>> members;
    if (parsed->gravityFile)
        members.emplace_back("gravity", *parsed->gravityFile);
    if (parsed->detectionsFile)
        members.emplace_back("detections", *parsed->detectionsFile);
    for (const RecordedView& view : recording.views) {
        for (const FrameInfo& frame : view.frames)
            members.emplace_back("views", frame.file);
    }
    for (const auto& [place, file] : members) {
        const auto bytes = readMember(directory, file, place, kMaxCsvBytes);
        if (!bytes)
            return tl::unexpected(bytes.error());
        digests[file] = sha256(*bytes);
    }
    return digests;
}

}  // namespace skincal
