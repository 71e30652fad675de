#include "core/formats/camera_export.h"

#include <fmt/format.h>

#include <span>
#include <vector>

#include "core/formats/camera_file.h"
#include "core/formats/yaml_number.h"

namespace skincal {
namespace {

std::string list(std::span<const double> values) {
    std::vector<std::string> texts;
    for (const double value : values)
        texts.push_back(yamlNumber(value));
    return fmt::format("[ {} ]", fmt::join(texts, ", "));
}

std::string openCv(const CameraModel& camera) {
    const std::vector<double> k{camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
    std::vector<double> d = camera.distortion;
    if (d.empty())
        d.assign(coefficientCount(camera.distortionModel), 0);
    const auto matrix = [](std::string_view key, std::size_t rows, std::span<const double> values) {
        return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: {}\n", key, rows,
                           values.size() / rows, list(values));
    };
    return fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\n", camera.width, camera.height) +
           matrix("camera_matrix", 3, k) +
           fmt::format("fisheye_model: {}\n", camera.distortionModel == DistortionModel::Equidistant ? 1 : 0) +
           matrix("distortion_coefficients", d.size(), d);
}

std::optional<std::string> kalibr(const CameraModel& camera) {
    std::vector<double> d = camera.distortion;
    if (camera.distortionModel == DistortionModel::RationalPolynomial)
        return std::nullopt;
    if (camera.distortionModel == DistortionModel::PlumbBob) {
        if (d.size() > 4 && d[4] != 0)
            return std::nullopt;
        d.resize(4, 0);
    }
    const bool isFisheye = camera.distortionModel == DistortionModel::Equidistant && !d.empty();
    d.resize(4, 0);
    return fmt::format(
        "cam0:\n  camera_model: pinhole\n  distortion_coeffs: {}\n  distortion_model: {}\n  intrinsics: {}\n"
        "  resolution: [ {}, {} ]\n  rostopic: /camera/image_raw\n",
        list(d), isFisheye ? "equidistant" : "radtan",
        list(std::vector<double>{camera.fx, camera.fy, camera.cx, camera.cy}), camera.width, camera.height);
}

}  // namespace

std::optional<std::string> exportCamera(const CameraModel& camera, CameraFileKind kind, std::string_view name) {
    switch (kind) {
        case CameraFileKind::OpenCv:
            return openCv(camera);
        case CameraFileKind::Kalibr:
            return kalibr(camera);
        default:
            return cameraModelToYaml(camera, name);
    }
}

}  // namespace skincal
