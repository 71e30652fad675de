#include "core/formats/camera_dialects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/formats/recording_parse.h"

namespace skincal {
namespace {

using Keys = std::vector<std::string_view>;

/// The first of several spellings that is there; complains about the first one where none is.
JsonCursor anyOf(const JsonCursor& cursor, const Keys& keys) {
    for (const std::string_view key : keys) {
        if (cursor.has(key))
            return cursor.at(key);
    }
    return cursor.at(keys.front());
}

bool hasAny(const JsonCursor& cursor, const Keys& keys) {
    return std::any_of(keys.begin(), keys.end(), [&](std::string_view key) { return cursor.has(key); });
}

std::vector<double> numbers(const JsonCursor& list) {
    constexpr std::size_t kMost = 64;
    std::vector<double> result;
    for (const JsonCursor& entry : list.array(kMost)) {
        if (entry.json().is_array()) {
            // A matrix as a list of its rows.
            for (const double value : numbers(entry))
                result.push_back(value);
        } else {
            result.push_back(entry.number());
        }
    }
    return result;
}

/// {rows, cols, data}, or the numbers alone.
std::vector<double> matrix(const JsonCursor& cursor) {
    if (cursor.json().is_array())
        return numbers(cursor);
    const JsonCursor data = cursor.at("data");
    std::vector<double> result = numbers(data);
    const auto rows = static_cast<std::size_t>(cursor.at("rows").integer(0, 64));
    const auto cols = static_cast<std::size_t>(cursor.at("cols").integer(0, 64));
    if (rows * cols != result.size())
        data.fail(fmt::format("expected {}x{} numbers, found {}", rows, cols, result.size()));
    return result;
}

void readSize(const JsonCursor& width, const JsonCursor& height, CameraModel& camera) {
    camera.width = static_cast<int>(width.integer(1, kMaxImageSide));
    camera.height = static_cast<int>(height.integer(1, kMaxImageSide));
    if (static_cast<double>(camera.width) * camera.height > kMaxImagePixels)
        height.fail(fmt::format("expected a picture of at most {:g} megapixels, found {}x{}", kMaxImagePixels / 1e6,
                                camera.width, camera.height));
}

void setIntrinsics(const JsonCursor& place, std::array<double, 4> values, CameraModel& camera) {
    const auto [fx, fy, cx, cy] = values;
    if (fx == 0 && fy == 0)
        place.fail("expected focal lengths, found zeros: this camera is not calibrated");
    const double low = kMinFocalShare * camera.width;
    const double high = kMaxFocalShare * camera.width;
    for (const double f : {fx, fy}) {
        if (!(f >= low && f <= high))
            place.fail(fmt::format("expected focal lengths of {:g} to {:g} pixels, found {:g}", low, high, f));
    }
    constexpr double kFar = 1e5;
    for (const double c : {cx, cy}) {
        if (!(std::abs(c) <= kFar))
            place.fail(fmt::format("expected a principal point within {:g} pixels, found {:g}", kFar, c));
    }
    camera.fx = fx;
    camera.fy = fy;
    camera.cx = cx;
    camera.cy = cy;
}

void readMatrix(const JsonCursor& cursor, CameraModel& camera) {
    const std::vector<double> k = matrix(cursor);
    if (k.size() != 9)
        cursor.fail(fmt::format("expected a matrix of 3x3, found {} numbers", k.size()));
    if (k[1] != 0)
        cursor.fail(fmt::format("expected a camera without skew, found {:g}", k[1]));
    const bool blank = std::all_of(k.begin(), k.end(), [](double value) { return value == 0; });
    if (!blank && (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1))
        cursor.fail("expected a camera matrix [fx 0 cx; 0 fy cy; 0 0 1]");
    setIntrinsics(cursor, {k[0], k[4], k[2], k[5]}, camera);
}

void setDistortion(const JsonCursor& place, DistortionModel model, std::vector<double> values, CameraModel& camera) {
    constexpr double kLargest = 1e4;
    for (const double value : values) {
        if (!(std::abs(value) <= kLargest))
            place.fail(fmt::format("expected coefficients within {:g}, found {:g}", kLargest, value));
    }
    camera.distortionModel = model;
    const std::size_t needed = coefficientCount(model);
    if (model == DistortionModel::PlumbBob && values.size() == 4)
        values.push_back(0);
    // OpenCV's longer models add s1 … s4, tau_x and tau_y to the rational one.
    const bool longer = model == DistortionModel::RationalPolynomial && (values.size() == 12 || values.size() == 14);
    if (longer && std::all_of(values.begin() + 8, values.end(), [](double value) { return value == 0; }))
        values.resize(8);
    else if (longer)
        place.fail("expected a lens without thin prism or tilted sensor, found coefficients of one");
    if (!values.empty() && values.size() != needed)
        place.fail(fmt::format("expected {} coefficients of {}, found {}", needed, name(model), values.size()));
    camera.distortion = std::move(values);
}

/// ROS and OpenCV say the model by name, by a flag, or by nothing but the count of coefficients.
DistortionModel modelOf(const JsonCursor& root, std::size_t count) {
    const bool named = root.holds("distortion_model");
    if (!named) {
        if (root.has("fisheye_model") && root.at("fisheye_model").integer(0, 1) == 1)
            return DistortionModel::Equidistant;
        return count > 5 ? DistortionModel::RationalPolynomial : DistortionModel::PlumbBob;
    }
    const JsonCursor cursor = root.at("distortion_model");
    const std::string text = cursor.text();
    if (text == "fisheye")
        return DistortionModel::Equidistant;
    if (count == 0 && (text.empty() || text == "none"))
        return DistortionModel::PlumbBob;
    const auto model = distortionModelFromName(text);
    if (!model)
        cursor.fail(fmt::format(
            "expected \"plumb_bob\", \"rational_polynomial\", \"equidistant\" or \"fisheye\", found \"{}\"", text));
    return *model;
}

void refuseCropped(const JsonCursor& root) {
    for (const std::string_view key : {"binning_x", "binning_y"}) {
        if (root.holds(key) && root.at(key).number() > 1)
            root.at(key).fail("expected a camera without binning");
    }
    if (!root.holds("roi") || !root.at("roi").json().is_object())
        return;
    const JsonCursor roi = root.at("roi");
    for (const std::string_view key : {"x_offset", "y_offset", "width", "height"}) {
        if (roi.holds(key) && roi.at(key).number() != 0)
            roi.at(key).fail("expected a camera without a region of interest");
    }
}

Keys matrixKeys() {
    return {"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"};
}

Keys distortionKeys() {
    return {"distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs", "D", "d"};
}

CameraModel rosOrOpenCv(const JsonCursor& root) {
    CameraModel camera;
    readSize(anyOf(root, {"image_width", "image_Width", "width"}),
             anyOf(root, {"image_height", "image_Height", "height"}), camera);
    if (root.holds("camera_model") && root.at("camera_model").text() != "pinhole")
        root.at("camera_model").fail(fmt::format("expected \"pinhole\", found \"{}\"", root.at("camera_model").text()));
    refuseCropped(root);
    readMatrix(anyOf(root, matrixKeys()), camera);
    const JsonCursor coefficients = anyOf(root, distortionKeys());
    std::vector<double> values = matrix(coefficients);
    const DistortionModel model = modelOf(root, values.size());
    setDistortion(coefficients, model, std::move(values), camera);
    return camera;
}

CameraModel kalibr(const JsonCursor& cam) {
    CameraModel camera;
    const JsonCursor model = cam.at("camera_model");
    if (model.text() != "pinhole")
        model.fail(fmt::format("expected \"pinhole\", found \"{}\"", model.text()));
    const auto resolution = cam.at("resolution").array(2);
    if (resolution.size() != 2)
        cam.at("resolution").fail("expected width and height");
    readSize(resolution[0], resolution[1], camera);
    const JsonCursor intrinsics = cam.at("intrinsics");
    const std::vector<double> k = numbers(intrinsics);
    if (k.size() != 4)
        intrinsics.fail(fmt::format("expected fx, fy, cx and cy, found {} numbers", k.size()));
    setIntrinsics(intrinsics, {k[0], k[1], k[2], k[3]}, camera);
    const JsonCursor distortion = cam.at("distortion_model");
    const std::string text = distortion.text();
    if (text == "none")
        return camera;
    if (text != "radtan" && text != "equidistant")
        distortion.fail(fmt::format("expected \"radtan\", \"equidistant\" or \"none\", found \"{}\"", text));
    const JsonCursor coefficients = cam.at("distortion_coeffs");
    const std::vector<double> values = numbers(coefficients);
    if (values.size() != 4)
        coefficients.fail(fmt::format("expected 4 coefficients, found {}", values.size()));
    setDistortion(coefficients, text == "radtan" ? DistortionModel::PlumbBob : DistortionModel::Equidistant, values,
                  camera);
    return camera;
}

bool isKalibr(const JsonCursor& entry) {
    return hasAny(entry, {"intrinsics", "distortion_coeffs", "cam_overlaps"}) || entry.has("camera_model");
}

}  // namespace

CameraModel cameraOfTree(const JsonCursor& root, const std::string& camera) {
    if (!root.json().is_object())
        root.fail("expected a camera calibration of ROS, OpenCV or Kalibr");
    if (hasAny(root, matrixKeys()))
        return rosOrOpenCv(root);
    std::vector<std::pair<std::string, JsonCursor>> cameras;
    for (auto& member : root.members()) {
        if (member.first.starts_with("cam") && isKalibr(member.second))
            cameras.push_back(member);
    }
    if (cameras.empty()) {
        const bool known = hasAny(root, {"image_width", "image_height", "image_Width", "distortion_model"});
        root.fail(known ? "expected a key 'camera_matrix', it is missing"
                        : "expected a camera calibration of ROS (camera_matrix, distortion_model), OpenCV "
                          "(camera_matrix, image_width) or Kalibr (cam0)");
    }
    std::string names;
    for (const auto& [name, cursor] : cameras) {
        if (name == camera || (camera.empty() && cameras.size() == 1))
            return kalibr(cursor);
        names += (names.empty() ? "" : ", ") + name;
    }
    if (camera.empty())
        root.fail("expected one camera, or the name of one, found " + names);
    root.fail(fmt::format("expected a camera '{}', found {}", camera, names));
}

}  // namespace skincal
