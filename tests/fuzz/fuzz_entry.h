#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "core/formats/body_json.h"
#include "core/formats/camera_file.h"
#include "core/formats/picture_decode.h"
#include "core/formats/recording_parse.h"
#include "core/formats/truth_json.h"

namespace skincal::test {

/// What a CSV is read against: two modules and two views.
inline Recording smallRecording() {
    Recording recording;
    recording.skin.templates = {paperHexagon()};
    recording.skin.modules = {{ModuleId(17), 0}, {ModuleId(23), 0}};
    recording.camera.width = 640;
    recording.camera.height = 480;
    recording.camera.fx = recording.camera.fy = 500;
    recording.views = {{"view0", {}, {}}, {"view1", {}, {}}};
    return recording;
}

/// An error has words and fits on one line.
inline void check(const FileError& error) {
    if (error.problem.empty() || error.message().find('\n') != std::string::npos)
        throw std::logic_error("an error without words or of several lines");
}

/// What was read can be written and reads the same.
inline void checkRoundTrip(const BodyModel& body) {
    const auto again = parseBodyJson(bodyToJson(body), "again.body.json");
    if (!again || again->modules.size() != body.modules.size() || again->views.size() != body.views.size())
        throw std::logic_error("a body that does not survive being written");
}

inline void checkRoundTrip(const CameraModel& camera) {
    const auto again = parseCameraModel(cameraModelToYaml(camera), "again.yaml");
    if (!again || again->fx != camera.fx || again->cy != camera.cy || again->distortion != camera.distortion)
        throw std::logic_error("a camera that does not survive being written");
}

/// A small picture is decoded, too.
inline void checkPicture(std::string_view bytes) {
    const auto header = parseImageHeader(bytes);
    if (!header && header.error().empty())
        throw std::logic_error("an error without words");
    if (!header || header->width > 256 || header->height > 256)
        return;
    const auto picture = decodePicture(bytes, *header);
    if (picture ? picture->cols != header->width || picture->rows != header->height : picture.error().empty())
        throw std::logic_error("a picture of another size, or an error without words");
}

/// Feeds bytes to one of the readers; the first byte says which. Whatever it holds, they return; an answer that breaks
/// their promises throws.
inline void readAnything(std::string_view bytes) {
    if (bytes.empty())
        return;
    const std::string_view text = bytes.substr(1);
    Recording recording = smallRecording();
    switch (static_cast<unsigned char>(bytes.front()) % 7) {
        case 0:
            if (const auto result = parseRecordingJson(text, "recording.json"); !result)
                check(result.error());
            break;
        case 1:
            if (const auto result = parseGravityCsv(text, "gravity.csv", recording); !result)
                check(result.error());
            break;
        case 2:
            if (const auto result = parseDetectionsCsv(text, "detections.csv", recording); !result)
                check(result.error());
            break;
        case 3:
            checkPicture(text);
            break;
        case 4: {
            const auto result = parseBodyJson(text, "a.body.json");
            if (result)
                checkRoundTrip(*result);
            else
                check(result.error());
            break;
        }
        case 5: {
            const auto result = parseCameraModel(text, "camera.yaml");
            if (result)
                checkRoundTrip(*result);
            else
                check(result.error());
            break;
        }
        default:
            if (const auto result = parseTruthJson(text, "truth.json"); !result)
                check(result.error());
    }
}

}  // namespace skincal::test
