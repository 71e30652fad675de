#include "core/formats/camera_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "core/formats/camera_dialects.h"
#include "core/formats/files.h"
#include "core/formats/json_cursor.h"
#include "core/formats/tree_file.h"
#include "core/formats/yaml_number.h"

namespace skincal {
namespace {

constexpr std::size_t kMaxBytes = 1U << 20U;

bool isXml(std::string_view bytes) {
    const std::size_t first = bytes.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && bytes[first] == '<';
}

std::string matrix(std::string_view key, int rows, std::span<const double> values) {
    std::vector<std::string> texts;
    for (const double value : values)
        texts.push_back(yamlNumber(value));
    return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", key, rows,
                       values.size() / static_cast<std::size_t>(rows), fmt::join(texts, ", "));
}

}  // namespace

tl::expected<CameraModel, FileError> parseCameraModel(std::string_view bytes, const std::filesystem::path& file,
                                                      const std::string& camera) {
    try {
        // UTF-16 and pictures would otherwise get the parser's words.
        if (bytes.find('\0') != std::string_view::npos)
            return tl::unexpected(FileError{file, "", "expected text, YAML or XML, found other bytes"});
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (bytes.starts_with(kByteOrderMark))
            bytes.remove_prefix(kByteOrderMark.size());
        const nlohmann::json tree = isXml(bytes) ? parseOpenCvXml(bytes, file) : parseYaml(bytes, file);
        return cameraOfTree(JsonCursor(tree, file), camera);
    } catch (const FileErrorException& exception) {
        return tl::unexpected(exception.error);
    }
}

tl::expected<CameraModel, FileError> readCameraModel(const std::filesystem::path& file, const std::string& camera) {
    const auto bytes = readFile(file, kMaxBytes);
    if (!bytes)
        return tl::unexpected(bytes.error());
    return parseCameraModel(*bytes, file, camera);
}

std::string cameraModelToYaml(const CameraModel& camera, std::string_view name) {
    std::string safe(name.empty() ? "camera" : name);
    std::replace_if(
        safe.begin(), safe.end(), [](unsigned char c) { return c >= 0x80 || (std::isalnum(c) == 0 && c != '_'); }, '_');
    const double fx = camera.fx, fy = camera.fy, cx = camera.cx, cy = camera.cy;
    std::string text =
        fmt::format("image_width: {}\nimage_height: {}\ncamera_name: \"{}\"\n", camera.width, camera.height, safe);
    text += matrix("camera_matrix", 3, std::array{fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0});
    text += fmt::format("distortion_model: {}\n", skincal::name(camera.distortionModel));
    text += matrix("distortion_coefficients", 1, camera.distortion);
    // A single camera has neither of these; ROS refuses files without them.
    text += matrix("rectification_matrix", 3, std::array{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
    text += matrix("projection_matrix", 3, std::array{fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0});
    return text;
}

tl::expected<void, FileError> writeCameraModel(const std::filesystem::path& file, const CameraModel& camera,
                                               std::string_view name) {
    return writeFileAtomically(file, cameraModelToYaml(camera, name));
}

}  // namespace skincal
