#include "core/formats/camera_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "core/geometry/random.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CameraModel readSample(const std::string& name, const std::string& camera = {}) {
    const auto result = readCameraModel(std::filesystem::path(SKINCAL_TEST_DATA) / "cameras" / name, camera);
    EXPECT_TRUE(result) << result.error().message();
    return result.value_or(CameraModel{});
}

void expectIntrinsics(const CameraModel& camera, double fx, double fy, double cx, double cy) {
    EXPECT_EQ(camera.fx, fx);
    EXPECT_EQ(camera.fy, fy);
    EXPECT_EQ(camera.cx, cx);
    EXPECT_EQ(camera.cy, cy);
}

TEST(CameraFile, ReadsWhatRosSaves) {
    const CameraModel camera = readSample("ros_camera_info.yaml");
    EXPECT_EQ(camera.width, 640);
    EXPECT_EQ(camera.height, 480);
    expectIntrinsics(camera, 438.783367, 437.302876, 305.593336, 243.738352);
    EXPECT_EQ(camera.distortionModel, DistortionModel::PlumbBob);
    EXPECT_THAT(camera.distortion, ElementsAre(-0.361976, 0.11051, 0.001014, 0.000505, 0));
}

TEST(CameraFile, ReadsMessagesOfRosPrintedOnATerminal) {
    for (const std::string name : {"ros1_topic.yaml", "ros2_topic.yaml"}) {
        const CameraModel camera = readSample(name);
        EXPECT_EQ(camera.width, 1280) << name;
        expectIntrinsics(camera, 911.25, 910.5, 647.0, 358.75);
        EXPECT_EQ(camera.distortionModel, DistortionModel::RationalPolynomial);
        EXPECT_THAT(camera.distortion, ElementsAre(0.5, -2.75, 0.0005, -0.00025, 1.5, 0.375, -2.5, 1.4375));
    }
}

TEST(CameraFile, ReadsWhatOpenCvsSampleWrites) {
    for (const std::string name : {"opencv.yml", "opencv.xml", "opencv_old_sample.xml"}) {
        const CameraModel camera = readSample(name);
        EXPECT_EQ(camera.width, 640) << name;
        EXPECT_EQ(camera.height, 480) << name;
        expectIntrinsics(camera, 5.3591575307485539e+02, 5.3591575307485539e+02, 3.4228314953752817e+02,
                         2.3557082321320789e+02);
        EXPECT_THAT(camera.distortion,
                    ElementsAre(-2.6637260909660682e-01, -3.8588898922304653e-02, 1.7831947042852964e-03,
                                -2.8122100441115472e-04, 2.3839153080878486e-01));
    }
}

TEST(CameraFile, ReadsOpenCvsFisheye) {
    const CameraModel camera = readSample("opencv_fisheye.yml");
    EXPECT_EQ(camera.distortionModel, DistortionModel::Equidistant);
    EXPECT_THAT(camera.distortion, ElementsAre(-0.0125, 0.0625, -0.03125, 0.0078125));
}

TEST(CameraFile, ReadsKalibr) {
    const CameraModel left = readSample("kalibr_stereo.yaml", "cam0");
    expectIntrinsics(left, 461.629, 460.152, 362.680, 246.049);
    EXPECT_EQ(left.width, 752);
    EXPECT_EQ(left.distortionModel, DistortionModel::PlumbBob);
    EXPECT_THAT(left.distortion, ElementsAre(-0.27695, 0.06712, 0.00087, 0.00011, 0));
    const CameraModel right = readSample("kalibr_stereo.yaml", "cam1");
    EXPECT_EQ(right.distortionModel, DistortionModel::Equidistant);
    EXPECT_THAT(right.distortion, ElementsAre(-0.0125, 0.0625, -0.03125, 0.0078125));
}

CameraModel randomCamera(std::uint64_t seed) {
    Random random(seed, "camera file");
    CameraModel camera;
    camera.width = 16 + static_cast<int>(random.index(4000));
    camera.height = 16 + static_cast<int>(random.index(3000));
    camera.fx = camera.width * random.uniform(0.1, 10);
    camera.fy = camera.width * random.uniform(0.1, 10);
    camera.cx = random.uniform(-10, camera.width);
    camera.cy = random.uniform(-10, camera.height);
    constexpr std::array kModels{DistortionModel::PlumbBob, DistortionModel::RationalPolynomial,
                                 DistortionModel::Equidistant};
    camera.distortionModel = kModels.at(random.index(3));
    for (std::size_t i = 0; random.uniform() < 0.95 && i < coefficientCount(camera.distortionModel); ++i)
        camera.distortion.push_back(random.normal() * std::pow(10, random.uniform(-12, 2)));
    if (camera.distortion.size() != coefficientCount(camera.distortionModel))
        camera.distortion.clear();
    return camera;
}

TEST(CameraFile, WhatIsWrittenReadsBackToTheSameBits) {
    const test::TemporaryDirectory directory;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const CameraModel a = randomCamera(seed);
        ASSERT_TRUE(writeCameraModel(directory / "camera.yaml", a));
        const auto b = readCameraModel(directory / "camera.yaml");
        ASSERT_TRUE(b) << b.error().message();
        EXPECT_EQ(b->width, a.width);
        EXPECT_EQ(b->height, a.height);
        expectIntrinsics(*b, a.fx, a.fy, a.cx, a.cy);
        EXPECT_EQ(b->distortionModel, a.distortionModel);
        EXPECT_EQ(b->distortion, a.distortion);
        EXPECT_EQ(cameraModelToYaml(*b), cameraModelToYaml(a));
    }
}

TEST(CameraFile, NumbersHaveAPointAndNamesAreTame) {
    CameraModel camera{640, 480, 500, 500, 320, 240, DistortionModel::PlumbBob, {1e-7, 0, 0, 0, 1e3}};
    const std::string text = cameraModelToYaml(camera, "a\"b\n: [");
    EXPECT_THAT(text, HasSubstr("data: [500.0, 0.0, 320.0,"));
    EXPECT_THAT(text, HasSubstr("[1.0e-07, 0.0, 0.0, 0.0, 1000.0]"));
    EXPECT_THAT(text, HasSubstr("camera_name: \"a_b____\""));
}

TEST(CameraFile, WritingWhereThereIsNoDirectoryFails) {
    EXPECT_FALSE(writeCameraModel("/nonexistent/camera.yaml", randomCamera(1)));
}

const std::string kRos =
    "image_width: 640\nimage_height: 480\ncamera_name: a\n"
    "camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}\n"
    "distortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [0.1, 0, 0, 0, 0]}\n";
const std::string kKalibr =
    "cam0:\n  camera_model: pinhole\n  intrinsics: [500, 500, 320, 240]\n  distortion_model: radtan\n"
    "  distortion_coeffs: [0.1, 0, 0, 0]\n  resolution: [640, 480]\n";
const std::string kXml =
    "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width><image_height>480</image_height>\n"
    "<camera_matrix type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt>"
    "<data>500. 0. 320. 0. 500. 240. 0. 0. 1.</data></camera_matrix>\n"
    "<distortion_coefficients><rows>5</rows><cols>1</cols><dt>d</dt><data>.1 0 0 0 0</data></distortion_coefficients>"
    "\n</opencv_storage>\n";

struct Defect {
    std::string text;
    std::string from;
    std::string to;
    std::string place;
    std::string problem;
};

void PrintTo(const Defect& defect, std::ostream* out) {
    *out << "'" << defect.from << "' as '" << defect.to << "'";
}

class CameraFileDefect : public testing::TestWithParam<Defect> {};

TEST_P(CameraFileDefect, IsNamedWithItsPlace) {
    const Defect& defect = GetParam();
    std::string text = defect.text;
    ASSERT_TRUE(parseCameraModel(text, "camera.yaml")) << "whole, it is read";
    const std::size_t at = text.find(defect.from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, defect.from.size(), defect.to);
    const auto result = parseCameraModel(text, "camera.yaml");
    ASSERT_FALSE(result) << text;
    EXPECT_EQ(result.error().file, "camera.yaml");
    EXPECT_EQ(result.error().place, defect.place) << result.error().message();
    EXPECT_THAT(result.error().problem, HasSubstr(defect.problem));
}

INSTANTIATE_TEST_SUITE_P(
    Ros, CameraFileDefect,
    testing::Values(
        Defect{kRos, "image_width: 640", "width_: 640", "", "expected a key 'image_width', it is missing"},
        Defect{kRos, "image_height: 480", "image_height: 0", "image_height", "expected an integer from 1 to 16384"},
        Defect{kRos, "image_width: 640", "image_width: 16000", "camera_matrix", "focal lengths"},
        Defect{kRos, "image_width: 640\nimage_height: 480", "image_width: 16000\nimage_height: 16000", "image_height",
               "megapixels"},
        Defect{kRos, "camera_matrix", "other", "", "expected a key 'camera_matrix', it is missing"},
        Defect{kRos, "distortion_coefficients", "other", "", "expected a key 'distortion_coefficients', it is missing"},
        Defect{kRos, "rows: 3", "rows: 2", "camera_matrix.data", "expected 2x3 numbers, found 9"},
        Defect{kRos, "rows: 3, cols: 3, data: [500, ", "rows: 2, cols: 4, data: [", "camera_matrix",
               "expected a matrix of 3x3, found 8 numbers"},
        Defect{kRos, "[500, 0,", "[500, 3,", "camera_matrix", "without skew, found 3"},
        Defect{kRos, "0, 0, 1]", "0, 0, 2]", "camera_matrix", "expected a camera matrix [fx 0 cx; 0 fy cy; 0 0 1]"},
        Defect{kRos, "[500, 0, 320, 0, 500, 240, 0, 0, 1]", "[0, 0, 0, 0, 0, 0, 0, 0, 0]", "camera_matrix",
               "not calibrated"},
        Defect{kRos, "[500, 0,", "[-500, 0,", "camera_matrix", "focal lengths of 32 to 32000 pixels, found -500"},
        Defect{kRos, "320", "1e9", "camera_matrix", "principal point"},
        Defect{kRos, "320", ".nan", "camera_matrix.data[2]", "expected a number, found \".nan\""},
        Defect{kRos, "320", "1e999", "camera_matrix.data[2]", "expected a number"},
        Defect{kRos, "320", "left", "camera_matrix.data[2]", "expected a number, found \"left\""},
        Defect{kRos, "[0.1,", "[1e6,", "distortion_coefficients", "coefficients within 10000"},
        Defect{kRos, "cols: 5, data: [0.1, ", "cols: 3, data: [", "distortion_coefficients.data", "expected 1x3"},
        Defect{kRos, "cols: 5, data: [0.1, 0, ", "cols: 3, data: [", "distortion_coefficients",
               "expected 5 coefficients of plumb_bob, found 3"},
        Defect{kRos, "plumb_bob", "equidistant", "distortion_coefficients",
               "expected 4 coefficients of equidistant, found 5"},
        Defect{kRos, "plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [",
               "rational_polynomial\ndistortion_coefficients: {rows: 1, cols: 14, data: [1, 1, 1, 1, 1, 1, 1, 1, 1, ",
               "distortion_coefficients", "thin prism"},
        Defect{kRos, "plumb_bob", "fov", "distortion_model", "found \"fov\""},
        Defect{kRos, "plumb_bob", "\"\"", "distortion_model", "found \"\""},
        Defect{kRos, "camera_name: a", "camera_model: omnidir", "camera_model", "found \"omnidir\""},
        Defect{kRos, "camera_name: a", "binning_x: 2", "binning_x", "without binning"},
        Defect{kRos, "camera_name: a", "roi: {x_offset: 0, width: 320}", "roi.width", "region of interest"},
        Defect{kRos, "camera_name: a", "image_width: 3", "line 3, column 1", "'image_width' is there twice"},
        Defect{kRos, "camera_name: a", "camera_name: [", "line 5, column 1", "expected YAML"},
        Defect{kRos, "camera_name: a", "camera_name: &n a\nother: *n", "line 4, column 8", "alias"},
        Defect{kRos, "camera_name: a", "---\na: 1", "", "expected one document, found several"},
        Defect{kRos, "camera_name: a", "[1, 2]: 3", "line 3, column 1", "expected a key of plain text"}));

INSTANTIATE_TEST_SUITE_P(
    Kalibr, CameraFileDefect,
    testing::Values(Defect{kKalibr, "pinhole", "omni", "cam0.camera_model", "expected \"pinhole\", found \"omni\""},
                    Defect{kKalibr, "pinhole", "ds", "cam0.camera_model", "found \"ds\""},
                    Defect{kKalibr, "radtan", "fov", "cam0.distortion_model", "found \"fov\""},
                    Defect{kKalibr, "[640, 480]", "[640]", "cam0.resolution", "expected width and height"},
                    Defect{kKalibr, "[640, 480]", "[640, -1]", "cam0.resolution[1]", "expected an integer from 1 to"},
                    Defect{kKalibr, "[500, 500, 320, 240]", "[0.6, 500, 500, 320, 240]", "cam0.intrinsics",
                           "expected fx, fy, cx and cy, found 5 numbers"},
                    Defect{kKalibr, "[0.1, 0, 0, 0]", "[0.1]", "cam0.distortion_coeffs", "expected 4 coefficients"},
                    Defect{kKalibr, "  distortion_coeffs: [0.1, 0, 0, 0]\n", "", "cam0", "'distortion_coeffs'"},
                    Defect{kKalibr, "  resolution: [640, 480]", "  resolution: [640, 480]\ncam1: {intrinsics: []}", "",
                           "found cam0, cam1"},
                    Defect{kKalibr, "cam0", "left", "", "expected a camera calibration of ROS"}));

INSTANTIATE_TEST_SUITE_P(
    Xml, CameraFileDefect,
    testing::Values(Defect{kXml, "</opencv_storage>", "", "line 2", "expected XML: XML_ERROR_PARSING"},
                    Defect{kXml, "opencv_storage>", "storage>", "line 2", "expected XML"},
                    Defect{kXml, "<image_width>640</image_width>", "", "", "'image_width'"},
                    Defect{kXml, "<rows>3</rows>", "<rows>4</rows>", "camera_matrix.data", "expected 4x3"},
                    Defect{kXml, "320.", "x", "camera_matrix.data[2]", "expected a number"},
                    Defect{kXml, "<image_height>", "<image_width>3</image_width><image_height>", "line 3",
                           "'image_width' is there twice"}));

TEST(CameraFile, OtherFilesAreRefused) {
    const auto refused = [](std::string_view bytes, const std::string& problem) {
        const auto result = parseCameraModel(bytes, "camera.yaml");
        ASSERT_FALSE(result) << bytes;
        EXPECT_THAT(result.error().message(), HasSubstr(problem));
    };
    refused("", "empty");
    refused("just text", "expected a camera calibration");
    refused("<html></html>", "<opencv_storage>");
    refused("<opencv_storage>7</opencv_storage>", "expected a camera calibration");
    refused(std::string_view("\x89PNG\0\0", 6), "other bytes");
    refused(std::string(100'000, '['), "expected");
    std::string nested;
    for (int i = 0; i < 40; ++i)
        nested += "a:\n" + std::string(static_cast<std::size_t>(i) + 1, ' ');
    refused(nested + "1", "levels of nesting");
    refused(std::string(100'000, '{'), "expected");
    std::string deep;
    for (int i = 0; i < 50'000; ++i)
        deep += "<a>";
    refused("<opencv_storage>" + deep, "expected XML");
    std::string wide = "a: [";
    for (int i = 0; i < 100'001; ++i)
        wide += "1,";
    refused(wide + "]", "at most 100000 values");
    refused("<opencv_storage><data>" + wide.substr(4) + "</data></opencv_storage>", "expected a camera calibration");
}

TEST(CameraFile, MissingAndHugeFilesAreRefused) {
    const test::TemporaryDirectory directory;
    EXPECT_FALSE(readCameraModel(directory / "none.yaml"));
    test::writeText(directory / "huge.yaml", std::string((1U << 20U) + 1, ' '));
    const auto huge = readCameraModel(directory / "huge.yaml");
    ASSERT_FALSE(huge);
    EXPECT_THAT(huge.error().message(), HasSubstr("at most 1 MB"));
}

TEST(CameraFile, ACameraOfAChainIsChosenByName) {
    const std::filesystem::path file = std::filesystem::path(SKINCAL_TEST_DATA) / "cameras/kalibr_stereo.yaml";
    const auto unnamed = readCameraModel(file);
    ASSERT_FALSE(unnamed);
    EXPECT_THAT(unnamed.error().message(), HasSubstr("found cam0, cam1"));
    const auto unknown = readCameraModel(file, "cam7");
    ASSERT_FALSE(unknown);
    EXPECT_THAT(unknown.error().message(), HasSubstr("expected a camera 'cam7', found cam0, cam1"));
}

}  // namespace
}  // namespace skincal
