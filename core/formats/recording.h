#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/formats/camera_origin.h"
#include "core/formats/file_error.h"
#include "core/skin/skin.h"
#include "core/vision/camera_model.h"
#include "core/vision/detection.h"
#include "core/vision/frame.h"

namespace skincal {

struct RecordedView {
    std::string name;
    std::vector<FrameInfo> frames;  ///< win over detections where there are any
    /// Sure ones only: a file has no place for several spots of one module (Undetected::spots). Where frames are kept
    /// they are found again; where only detections are, such a module counts as not found.
    std::vector<LedDetection> detections;
};

/// What the operator accepted or rejected.
struct Decision {
    std::string view;
    ModuleId module;
    std::string verdict;  ///< "accepted" or "rejected"
    std::string reason;
};

/// Keys that the page does not name, each with its JSON text: kept by whoever writes the file again.
using UnknownKeys = std::map<std::string, std::string>;

/// A *.skinrec directory: everything that was measured, nothing that was computed.
struct Recording {
    Skin skin;
    std::vector<GravityReading> gravity;
    CameraModel camera;
    std::vector<RecordedView> views;
    std::vector<Decision> decisions;
    std::string gravityFile;     ///< as read; writers use gravity.csv
    std::string detectionsFile;  ///< as read, empty where there is none; written detections.csv
    CameraOrigin cameraOrigin{};
    UnknownKeys unknown{};                                ///< of recording.json itself
    std::map<std::string, UnknownKeys> unknownOfTypes{};  ///< by name of the module type
};

enum class Completeness {
    Whole,  ///< as recording.md asks
    Begun,  ///< kept while it is being made: the camera may be missing as long as there is no view
};

/// Reads and checks a recording without loading its pictures (frame files must exist). Every defect that
/// recording.md lists gives one error that names the file, the place and what was expected.
[[nodiscard]] tl::expected<Recording, FileError> readRecording(const std::filesystem::path& directory,
                                                               Completeness completeness = Completeness::Whole);

/// Writes recording.json, gravity.csv and (where a view has any) detections.csv. Pictures are written by
/// writeFrame. Refuses a directory that already holds a recording unless `overwrite`. A camera of no width is left out:
/// what is written then is only begun. Throws std::logic_error where there are views without a camera.
[[nodiscard]] tl::expected<void, FileError> writeRecording(const Recording& recording,
                                                           const std::filesystem::path& directory,
                                                           bool overwrite = false);

/// Loads one frame, PNG or JPEG only, after checking from its header that it has the camera's size.
[[nodiscard]] tl::expected<cv::Mat, FileError> loadFrame(const std::filesystem::path& directory, const FrameInfo& frame,
                                                         const CameraModel& camera);

/// Writes an 8-bit picture as PNG, making its folder.
[[nodiscard]] tl::expected<void, FileError> writeFrame(const std::filesystem::path& directory, const std::string& file,
                                                       const cv::Mat& picture);

/// recording.json, the gravity and detections files that it names and each frame, as paths in the recording.
[[nodiscard]] std::vector<std::string> filesOf(const Recording& recording);

/// SHA-256 of each of filesOf.
[[nodiscard]] tl::expected<std::map<std::string, std::string>, FileError> digestRecording(
    const std::filesystem::path& directory, const Recording& recording);

}  // namespace skincal
