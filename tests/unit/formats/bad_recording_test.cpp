#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/unit/formats/sample_recording.h"

namespace skincal {
namespace {

using nlohmann::json;
using namespace test;

TEST(Recording, AGoodOneIsRead) {
    const TemporaryDirectory directory;
    write({}, directory);
    EXPECT_FALSE(complaintOf(directory.path()));
    const auto recording = readRecording(directory.path());
    ASSERT_TRUE(recording);
    EXPECT_EQ(recording->skin.modules.size(), 2U);
    EXPECT_EQ(recording->gravity.size(), 2U);
    EXPECT_EQ(recording->views[1].detections.size(), 1U);
    EXPECT_EQ(recording->decisions[0].reason, "reflection");
}

struct Defect {
    std::string name;
    std::function<void(Files&)> make;
    std::string file;  ///< that the message names
    std::string place;
    std::string problem;  ///< part of what it says
};

void PrintTo(const Defect& defect, std::ostream* stream) {
    *stream << defect.name;
}

class BadRecording : public testing::TestWithParam<Defect> {};

TEST_P(BadRecording, GivesOneClearMessage) {
    const TemporaryDirectory directory;
    Files files;
    GetParam().make(files);
    write(files, directory);
    const auto complaint = complaintOf(directory.path());
    ASSERT_TRUE(complaint) << "nothing was said";
    EXPECT_THAT(complaint->file.filename().string(), testing::HasSubstr(GetParam().file));
    EXPECT_EQ(complaint->place, GetParam().place);
    EXPECT_THAT(complaint->problem, testing::HasSubstr(GetParam().problem));
    EXPECT_EQ(complaint->message().find('\n'), std::string::npos);
}

Defect inJson(std::string name, std::function<void(json&)> change, std::string place, std::string problem) {
    return {std::move(name), [change](Files& f) { change(f.recording); }, "recording.json", std::move(place),
            std::move(problem)};
}

Defect inGravity(std::string name, std::string row, std::string place, std::string problem) {
    return {std::move(name), [row](Files& f) { f.gravity += row; }, "gravity.csv", std::move(place),
            std::move(problem)};
}

Defect inDetections(std::string name, std::string row, std::string place, std::string problem) {
    return {std::move(name), [row](Files& f) { f.detections += row; }, "detections.csv", std::move(place),
            std::move(problem)};
}

std::vector<Defect> defects() {
    std::vector<Defect> all{
        inJson(
            "wrong_format", [](json& j) { j["format"] = "other"; }, "format", "expected \"skincal-recording\""),
        inJson(
            "no_format", [](json& j) { j.erase("format"); }, "", "expected a key 'format'"),
        inJson(
            "newer_version", [](json& j) { j["version"] = 2; }, "version", "newer version"),
        inJson(
            "version_text", [](json& j) { j["version"] = "1"; }, "version", "expected an integer"),
        inJson(
            "no_modules", [](json& j) { j.erase("modules"); }, "", "expected a key 'modules'"),
        inJson(
            "duplicate_id", [](json& j) { j["modules"][1]["id"] = 17; }, "modules[1].id", "17 is taken"),
        inJson(
            "id_zero", [](json& j) { j["modules"][0]["id"] = 0; }, "modules[0].id", "from 1 to 4294967295"),
        inJson(
            "id_too_large", [](json& j) { j["modules"][0]["id"] = 4294967296; }, "modules[0].id",
            "from 1 to 4294967295"),
        inJson(
            "id_huge", [](json& j) { j["modules"][0]["id"] = 18446744073709551615ULL; }, "modules[0].id", "integer"),
        inJson(
            "unknown_type", [](json& j) { j["modules"][0]["type"] = "oct"; }, "modules[0].type", "'oct'"),
        inJson(
            "duplicate_type", [](json& j) { j["module_types"].push_back(j["module_types"][0]); },
            "module_types[1].name", "taken"),
        inJson(
            "unknown_module", [](json& j) { j["links"][0]["a"] = 99; }, "links[0].a", "99 is none"),
        inJson(
            "missing_port", [](json& j) { j["links"][0]["b_port"] = 2; }, "links[0].b_port",
            "below 2 of 'hex', found 2"),
        inJson(
            "negative_port", [](json& j) { j["links"][0]["a_port"] = -1; }, "links[0].a_port", "found -1"),
        inJson(
            "link_kind", [](json& j) { j["links"][0]["kind"] = "glued"; }, "links[0].kind", "\"glued\""),
        inJson(
            "host_port", [](json& j) { j["host_links"][0]["port"] = 9; }, "host_links[0].port", "found 9"),
        inJson(
            "millimetres",
            [](json& j) {
                j["module_types"][0]["led"] = {7.9, 0, 0};
            },
            "module_types[0].led", "millimetres"),
        inJson(
            "clockwise",
            [](json& j) {
                j["module_types"][0]["outline"] = {{0.015, 0}, {-0.015, 0}, {0, 0.015}};
            },
            "module_types[0].outline", "counter-clockwise, it is clockwise"),
        inJson(
            "no_area",
            [](json& j) {
                j["module_types"][0]["outline"] = {{0.015, 0}, {-0.015, 0}, {0, 0}};
            },
            "module_types[0].outline", "encloses an area"),
        inJson(
            "two_kinds_of_one_link",
            [](json& j) {
                j["links"] = {{{"a", 17}, {"a_port", 0}, {"b", 23}, {"b_port", 1}, {"kind", "cable"}},
                              {{"a", 23}, {"a_port", 1}, {"b", 17}, {"b_port", 0}, {"kind", "adjacent"}}};
            },
            "links[1].kind", "one kind for each link"),
        inJson(
            "two_verdicts",
            [](json& j) {
                j["decisions"].push_back({{"view", "view0"}, {"module", 17}, {"verdict", "accepted"}});
            },
            "decisions[1].verdict", "one verdict for each view and module"),
        inJson(
            "no_gravity_key", [](json& j) { j.erase("gravity"); }, "", "expected a key 'gravity'"),
        inJson(
            "no_frame", [](json& j) { j["views"][0]["frames"][0]["file"] = "views/1.png"; }, "views[0].frames[0].file",
            "no such file 'views/1.png'"),
        inJson(
            "frame_is_a_directory", [](json& j) { j["views"][0]["frames"][0]["file"] = "views"; },
            "views[0].frames[0].file", "expected a regular file, 'views' is none"),
        inJson(
            "two_coordinates",
            [](json& j) {
                j["module_types"][0]["led"] = {0, 0};
            },
            "module_types[0].led", "expected 3 numbers, found 2"),
        inJson(
            "outline_of_two", [](json& j) { j["module_types"][0]["outline"].erase(0); }, "module_types[0].outline",
            "at least 3"),
        inJson(
            "absurd_width", [](json& j) { j["camera"]["width"] = 1000000; }, "camera.width", "from 1 to 16384"),
        inJson(
            "no_focal_length", [](json& j) { j["camera"]["fx"] = 0; }, "camera.fx",
            "expected a number from 3.2 to 3200"),
        inJson(
            "focal_length_of_another_unit", [](json& j) { j["camera"]["fy"] = 60000; }, "camera.fy",
            "from 3.2 to 3200"),
        inJson(
            "too_many_pixels",
            [](json& j) {
                j["camera"]["width"] = 10000;
                j["camera"]["height"] = 6401;
            },
            "camera.height", "at most 64 megapixels, found 10000x6401"),
        inJson(
            "camera_model", [](json& j) { j["camera"]["model"] = "omni"; }, "camera.model", "\"omni\""),
        inJson(
            "distortion_model", [](json& j) { j["camera"]["distortion_model"] = "fov"; }, "camera.distortion_model",
            "\"fov\""),
        inJson(
            "distortion_count",
            [](json& j) {
                j["camera"]["distortion"] = {0, 0, 0, 0};
            },
            "camera.distortion", "expected 5 coefficients"),
        inJson(
            "distortion_null", [](json& j) { j["camera"]["distortion"][2] = nullptr; }, "camera.distortion[2]",
            "expected a number"),
        inJson(
            "duplicate_view", [](json& j) { j["views"][1]["name"] = "view0"; }, "views[1].name", "taken"),
        inJson(
            "empty_view_name", [](json& j) { j["views"][1]["name"] = ""; }, "views[1].name", "not empty"),
        inJson(
            "unknown_lit", [](json& j) { j["views"][0]["frames"][0]["lit"] = {5}; }, "views[0].frames[0].lit[0]",
            "5 is none"),
        inJson(
            "lit_twice",
            [](json& j) {
                j["views"][0]["frames"][0]["lit"] = {17, 17};
            },
            "views[0].frames[0].lit[1]", "twice"),
        inJson(
            "bad_colour",
            [](json& j) {
                j["views"][0]["frames"][0]["lit"] = {{{"module", 17}, {"colour", {1, 2, 0}}}};
            },
            "views[0].frames[0].lit[0].colour[1]", "from 0 to 1"),
        inJson(
            "negative_look", [](json& j) { j["views"][0]["frames"][0]["look"] = -1; }, "views[0].frames[0].look",
            "from 0 to 1000"),
        inJson(
            "looks_out_of_order",
            [](json& j) {
                auto& frames = j["views"][0]["frames"];
                frames.push_back(frames[0]);
                frames[0]["look"] = 2;
                frames[1]["look"] = 1;
            },
            "views[0].frames[1].look", "2 or more"),
        inJson(
            "absolute_path", [](json& j) { j["views"][0]["frames"][0]["file"] = "/etc/passwd"; },
            "views[0].frames[0].file", "inside the recording"),
        inJson(
            "path_out", [](json& j) { j["gravity"] = "../gravity.csv"; }, "gravity", "inside the recording"),
        inJson(
            "path_empty", [](json& j) { j["detections"] = ""; }, "detections", "inside the recording"),
        inJson(
            "decision_view", [](json& j) { j["decisions"][0]["view"] = "nowhere"; }, "decisions[0].view", "'nowhere'"),
        inJson(
            "decision_verdict", [](json& j) { j["decisions"][0]["verdict"] = "maybe"; }, "decisions[0].verdict",
            "\"maybe\""),
        inJson(
            "views_no_array", [](json& j) { j["views"] = 3; }, "views", "expected an array, found 3"),
        {"malformed_json", [](Files& f) { f.text = "{\n \"format\": \"skincal-recording\",\n oops}"; },
         "recording.json", "line 3, column 2", "well-formed JSON"},
        {"empty_json", [](Files& f) { f.text = " "; }, "recording.json", "line 1, column 2", "well-formed JSON"},
        {"infinite_json", [](Files& f) { f.text = "{\"format\": 1e999}"; }, "recording.json", "line 1, column 12",
         "range of a double"},
        {"nan_json", [](Files& f) { f.text = "{\"format\": NaN}"; }, "recording.json", "line 1, column 12",
         "well-formed"},
        {"deep_json", [](Files& f) { f.text = std::string(100000, '['); }, "recording.json", "", "levels of nesting"},
        {"no_gravity_file", [](Files& f) { f.recording["gravity"] = "none.csv"; }, "none.csv", "", "there is none"},
        {"gravity_is_a_directory", [](Files& f) { f.recording["gravity"] = "views"; }, "views", "", "regular file"},
        {"gravity_header", [](Files& f) { f.gravity = "pose,module,x,y,z\n"; }, "gravity.csv", "row 1",
         "expected the header pose,module,ax,ay,az"},
        {"gravity_empty", [](Files& f) { f.gravity = ""; }, "gravity.csv", "row 1", "expected a header"},
        inGravity("gravity_text", "2,17,a,0,0\n", "row 4, column ax", "expected a number, found 'a'"),
        inGravity("gravity_nan", "2,17,0,nan,0\n", "row 4, column ay", "finite"),
        inGravity("gravity_inf", "2,17,0,0,inf\n", "row 4, column az", "finite"),
        inGravity("gravity_overflow", "2,17,0,0,1e999\n", "row 4, column az", "range of a double"),
        inGravity("gravity_absurd", "2,17,0,0,1e9\n", "row 4, column ax", "below 1000"),
        inGravity("gravity_columns", "2,17,0,0\n", "row 4", "expected 5 columns, found 4"),
        inGravity("gravity_unknown", "2,99,0,0,1\n", "row 4, column module", "99 is none"),
        inGravity("gravity_twice", "\n1,17,0,0,1\n", "row 5, column module", "has two"),
        inGravity("gravity_pose", "-1,17,0,0,1\n", "row 4, column pose", "integer from 0"),
        inGravity("gravity_locale", "2,17,\"0,5\",0,1\n", "row 4", "expected 5 columns"),
        inDetections("detection_view", "viewX,17,1,1,0.1\n", "row 3, column view", "'viewX' is none"),
        inDetections("detection_outside", "view0,17,64,1,0.1\n", "row 3, column x", "inside the picture"),
        inDetections("detection_sigma", "view0,17,1,1,0\n", "row 3, column sigma", "above 0"),
        inDetections("detection_twice", "view1,17,1,1,0.1\n", "row 3, column module", "has two"),
        inDetections("detection_nan", "view0,17,nan,1,0.1\n", "row 3, column x", "finite"),
        {"frame_size", [](Files& f) { f.picture = cv::Mat::zeros(48, 65, CV_8UC1); }, "0.png", "",
         "expected a picture of the camera's size 64x48, found 65x48"},
        {"frame_16_bit", [](Files& f) { f.picture = cv::Mat::zeros(48, 64, CV_16UC1); }, "0.png", "", "8 bits"},
        {"frame_missing", [](Files& f) { f.then = [](const auto& d) { std::filesystem::remove(d / "views/0.png"); }; },
         "recording.json", "views[0].frames[0].file", "no such file 'views/0.png'"},
        {"frame_is_a_pipe",
         [](Files& f) {
             f.then = [](const auto& d) {
                 std::filesystem::remove(d / "views/0.png");
                 ::mkfifo((d / "views/0.png").c_str(), 0600);
             };
         },
         "recording.json", "views[0].frames[0].file", "expected a regular file"},
        {"frame_with_a_flipped_bit", [](Files& f) { f.then = [](const auto& d) { flip(d / "views/0.png", 50); }; },
         "0.png", "", "damaged"},
        {"key_twice", [](Files& f) { f.text = R"({"format": "skincal-recording", "x": {"a": 1, "b": {}, "a": 2}})"; },
         "recording.json", "", "each key of an object once, 'a' is there twice"},
        {"frame_is_text", [](Files& f) { f.then = [](const auto& d) { writeText(d / "views/0.png", "hello"); }; },
         "0.png", "", "PNG or JPEG"},
        {"frame_is_cut_off",
         [](Files& f) {
             f.then = [](const auto& d) {
                 writeText(d / "views/0.png", test::readText(d / "views/0.png").substr(0, 20));
             };
         },
         "0.png", "", "ends within its header"},
        {"frame_is_damaged",
         [](Files& f) {
             f.then = [](const auto& d) {
                 writeText(d / "views/0.png", test::readText(d / "views/0.png").substr(0, 45));
             };
         },
         "0.png", "", "damaged"},
        {"frame_is_a_cut_off_jpeg",
         [](Files& f) { f.then = [](const auto& d) { writeText(d / "views/0.png", cutOff(noisyJpeg(64, 48))); }; },
         "0.png", "", "damaged"},
        {"frame_is_cut_off_after_its_thumbnail",
         [](Files& f) {
             f.then = [](const auto& d) {
                 writeText(d / "views/0.png", withThumbnail(cutOff(noisyJpeg(64, 48)), noisyJpeg(8, 8)));
             };
         },
         "0.png", "", "damaged"},
        {"frame_links_out",
         [](Files& f) {
             f.then = [](const auto& d) {
                 std::filesystem::remove(d / "views/0.png");
                 std::filesystem::create_symlink("/etc/passwd", d / "views/0.png");
             };
         },
         "recording.json", "views[0].frames[0].file", "a symbolic link in 'views/0.png' leads out"},
    };
    Defect sigma{"gravity_sigma",
                 [](Files& f) { f.gravity = "pose,module,ax,ay,az,sigma,samples\n0,17,0,0,9.8,-1,5\n"; }, "gravity.csv",
                 "row 2, column sigma", "above 0"};
    Defect samples{"gravity_samples",
                   [](Files& f) { f.gravity = "pose,module,ax,ay,az,sigma,samples\n0,17,0,0,9.8,1,0\n"; },
                   "gravity.csv", "row 2, column samples", "at least 1"};
    Defect fraction{"gravity_half_a_sample",
                    [](Files& f) { f.gravity = "pose,module,ax,ay,az,samples\n0,17,0,0,9.8,1.5\n"; }, "gravity.csv",
                    "row 2, column samples", "a whole number of at least 1, found 1.5"};
    all.push_back(sigma);
    all.push_back(samples);
    all.push_back(fraction);
    return all;
}

INSTANTIATE_TEST_SUITE_P(Defects, BadRecording, testing::ValuesIn(defects()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(BadRecordingDirectory, MissingOrAFileOrEmpty) {
    const TemporaryDirectory directory;
    EXPECT_THAT(readRecording(directory / "none").error().problem, testing::HasSubstr("expected a recording"));
    EXPECT_THAT(readRecording(directory.path()).error().problem, testing::HasSubstr("there is none"));
    writeText(directory / "file", "x");
    EXPECT_FALSE(readRecording(directory / "file"));
}

TEST(BadRecordingDirectory, SaysWhyItCanNotBeRead) {
    const TemporaryDirectory directory;
    std::filesystem::create_symlink(directory / "loop", directory / "loop");
    EXPECT_THAT(readRecording(directory / "loop").error().problem, testing::HasSubstr("symbolic links"));
}

TEST(Recording, GravityMayBeEmptyAndALinkMayLeadToItsOwnModule) {
    const TemporaryDirectory directory;
    Files files;
    files.gravity = "pose,module,ax,ay,az\n";
    files.recording["links"].push_back({{"a", 17}, {"a_port", 0}, {"b", 17}, {"b_port", 1}});
    write(files, directory);
    const auto recording = readRecording(directory.path());
    ASSERT_TRUE(recording) << recording.error().message();
    EXPECT_TRUE(recording->gravity.empty());
}

TEST(Recording, AJpegWithAThumbnailIsReadWhole) {
    const TemporaryDirectory directory;
    Files files;
    files.then = [](const auto& d) { writeText(d / "views/0.png", withThumbnail(noisyJpeg(64, 48), noisyJpeg(8, 8))); };
    write(files, directory);
    const auto complaint = complaintOf(directory.path());
    EXPECT_FALSE(complaint) << complaint->message();
}

TEST(Recording, ToleratesByteOrderMarksCarriageReturnsAndUnknownKeys) {
    const TemporaryDirectory directory;
    Files files;
    files.recording["something new"] = {{"a", 1}};
    files.text = "\xEF\xBB\xBF" + files.recording.dump();
    files.gravity = "\xEF\xBB\xBFpose,module,ax,ay,az\r\n0,17,1,2,3\r\n\r\n";
    write(files, directory);
    const auto recording = readRecording(directory.path());
    ASSERT_TRUE(recording) << recording.error().message();
    EXPECT_EQ(recording->gravity[0].acceleration, Vector3d(1, 2, 3));
}

}  // namespace
}  // namespace skincal
