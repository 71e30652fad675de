#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/formats/recording.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal::test {

/// A small good recording, for tests to spoil.
inline nlohmann::json goodJson() {
    return nlohmann::json::parse(R"({
      "format": "skincal-recording", "version": 1,
      "module_types": [{"name": "hex", "outline": [[0.015, 0], [0, 0.015], [-0.015, 0]], "led": [0.0079, 0, 0],
                        "ports": [[0.012, 0.007, 0], [0.012, -0.007, 0]]}],
      "modules": [{"id": 17, "type": "hex"}, {"id": 23, "type": "hex"}],
      "links": [{"a": 17, "a_port": 0, "b": 23, "b_port": 1}],
      "host_links": [{"module": 17, "port": 1}],
      "gravity": "gravity.csv",
      "camera": {"model": "pinhole", "width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 32, "cy": 24,
                 "distortion_model": "plumb_bob", "distortion": [0, 0, 0, 0, 0]},
      "views": [{"name": "view0", "frames": [{"file": "views/0.png", "lit": [17]}]}, {"name": "view1"}],
      "detections": "detections.csv",
      "decisions": [{"view": "view0", "module": 17, "verdict": "rejected", "reason": "reflection"}]
    })");
}

inline constexpr const char* kGravity = "pose,module,ax,ay,az\n0,17,0.1,0.2,9.8\n1,17,9.8,0,0\n";
inline constexpr const char* kDetections = "view,module,x,y,sigma\nview1,17,10.5,20.25,0.05\n";

struct Files {
    nlohmann::json recording = goodJson();
    std::string text;  ///< instead of `recording` where not empty
    std::string gravity = kGravity;
    std::string detections = kDetections;
    cv::Mat picture = cv::Mat::zeros(48, 64, CV_8UC1);
    std::function<void(const TemporaryDirectory&)> then;
};

inline void write(const Files& files, const TemporaryDirectory& directory) {
    writeText(directory / "recording.json", files.text.empty() ? files.recording.dump() : files.text);
    writeText(directory / "gravity.csv", files.gravity);
    writeText(directory / "detections.csv", files.detections);
    std::filesystem::create_directories(directory / "views");
    cv::imwrite((directory / "views/0.png").string(), files.picture);
    if (files.then)
        files.then(directory);
}

/// Reads everything, pictures included: the first complaint, or nothing.
inline std::optional<FileError> complaintOf(const std::filesystem::path& directory) {
    const auto recording = readRecording(directory);
    if (!recording)
        return recording.error();
    for (const RecordedView& view : recording->views) {
        for (const FrameInfo& frame : view.frames) {
            if (const auto picture = loadFrame(directory, frame, recording->camera); !picture)
                return picture.error();
        }
    }
    return std::nullopt;
}

inline std::string noisyJpeg(int width, int height) {
    cv::Mat picture(height, width, CV_8UC1);
    cv::RNG(1).fill(picture, cv::RNG::UNIFORM, 0, 256);
    std::vector<unsigned char> bytes;
    cv::imencode(".jpg", picture, bytes);
    return {bytes.begin(), bytes.end()};
}

inline std::string cutOff(const std::string& bytes) {
    return bytes.substr(0, bytes.size() * 4 / 5);
}

/// The thumbnail in an APP1 segment right after the start, where cameras put theirs.
inline std::string withThumbnail(const std::string& jpeg, const std::string& thumbnail) {
    const std::size_t length = thumbnail.size() + 2;
    const std::string head{'\xFF', '\xE1', static_cast<char>(length >> 8U), static_cast<char>(length & 0xFFU)};
    return jpeg.substr(0, 2) + head + thumbnail + jpeg.substr(2);
}

inline void flip(const std::filesystem::path& file, std::size_t byte) {
    std::string bytes = readText(file);
    bytes.at(byte) = static_cast<char>(bytes.at(byte) ^ 1);
    writeText(file, bytes);
}

}  // namespace skincal::test
