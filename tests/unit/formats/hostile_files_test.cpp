// What the table of bad recordings does not reach: links, limits, pictures that lie about themselves, hostile names.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

#include "core/formats/files.h"
#include "core/formats/json_cursor.h"
#include "core/formats/picture_decode.h"
#include "core/formats/recording_parse.h"
#include "core/formats/truth_json.h"
#include "core/geometry/random.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using test::readText;
using test::TemporaryDirectory;
using test::writeText;

TEST(Sha256, KnownLongVectors) {
    // FIPS 180-2, appendix B.
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(ReadFile, DoesNotWaitForAPipe) {
    const TemporaryDirectory directory;
    ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
    EXPECT_THAT(readFile(directory / "pipe", 10).error().message(), testing::HasSubstr("regular file"));
}

TEST(WriteFileAtomically, MakesFilesAsReadableAsAnyOther) {
    const TemporaryDirectory directory;
    const mode_t before = ::umask(027);
    const auto written = writeFileAtomically(directory / "f", "x");
    EXPECT_EQ(::umask(before), mode_t{027}) << "the mask must be left as it was";
    ASSERT_TRUE(written);
    EXPECT_EQ(static_cast<unsigned>(fs::status(directory / "f").permissions()), 0640U);
}

/// Ends the process: 7 where writing failed as it should.
void writeBeyondLimit(const fs::path& file) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const auto result = writeFileAtomically(file, std::string(100'000, 'x'));
    // Not exit(): under this limit a coverage build would cut its own counters short.
    std::_Exit(!result && result.error().problem.find("can't write the file") == 0 ? 7 : 1);
}

TEST(WriteFileAtomically, KeepsTheOldFileWhenTheDiskIsFull) {
    // A limit on the size of files fails a write half way, as a full disk does.
    const TemporaryDirectory directory;
    writeText(directory / "f", "old");
    EXPECT_EXIT(writeBeyondLimit(directory / "f"), testing::ExitedWithCode(7), "");
    EXPECT_EQ(readText(directory / "f"), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator()), 1);
}

TEST(ResolveInside, FollowsLinksOnlyWithin) {
    const TemporaryDirectory temporary;
    const fs::path outer = fs::canonical(temporary.path());
    const fs::path root = outer / "rec";
    fs::create_directories(root / "views");
    fs::create_directories(outer / "rec-twin");
    writeText(root / "a.csv", "");
    fs::create_symlink(root / "a.csv", root / "views" / "inner");
    fs::create_symlink(outer / "rec-twin", root / "out");
    fs::create_symlink(root / "loop", root / "loop");
    EXPECT_EQ(resolveInside(root, "views/inner").value(), root / "a.csv");
    EXPECT_EQ(resolveInside(root, "views/new/not yet.png").value(), root / "views/new/not yet.png");
    EXPECT_EQ(resolveInside(root, "..a").value(), root / "..a");
    for (const char* bad : {"../rec-twin/b.csv", "out/b.csv", "out", "out/../a.csv", "loop", "none/../../x"}) {
        const auto result = resolveInside(root, bad);
        ASSERT_FALSE(result) << bad;
        EXPECT_THAT(result.error(), testing::HasSubstr("'"s + bad + "'"));
    }
    EXPECT_FALSE(resolveInside(root, std::string(5000, 'a')));
}

std::string encoded(const cv::Mat& image, const std::string& kind, const std::vector<int>& options = {}) {
    std::vector<unsigned char> bytes;
    EXPECT_TRUE(cv::imencode(kind, image, bytes, options));
    return {bytes.begin(), bytes.end()};
}

TEST(ImageHeader, AgreesWithTheEncoder) {
    Random random(1, "ImageHeader");
    for (int i = 0; i < 30; ++i) {
        const int width = static_cast<int>(1 + random.index(300));
        const int height = static_cast<int>(1 + random.index(300));
        const cv::Mat grey = cv::Mat::zeros(height, width, CV_8UC1);
        const cv::Mat colour = cv::Mat::zeros(height, width, CV_8UC3);
        for (const std::string& bytes : {encoded(grey, ".png"), encoded(colour, ".png"), encoded(grey, ".jpg"),
                                         encoded(colour, ".jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1})}) {
            const auto header = parseImageHeader(bytes);
            ASSERT_TRUE(header) << header.error();
            EXPECT_EQ(header->width, width);
            EXPECT_EQ(header->height, height);
            EXPECT_EQ(header->bitsPerSample, 8);
        }
    }
}

TEST(ImageHeader, SeesTheFrameThatADecoderSees) {
    // Where the two differ, a picture of any size could pass for a small one.
    const std::string frame = "\xFF\xC0\x00\x11\x08\x00\x02\x00\x03"s;
    const auto width = [](const std::string& bytes) {
        const auto header = parseImageHeader("\xFF\xD8" + bytes);
        return header ? header->width : -1;
    };
    EXPECT_EQ(width(frame), 3);
    EXPECT_EQ(width("\xFF\xFF\xFF" + frame), 3) << "fill bytes";
    EXPECT_EQ(width("\xFF\xE0\x00\x04\xFF\xC0"s + frame), 3) << "a marker inside of a segment is none";
    EXPECT_EQ(width("\xFF\xC4\x00\x02"s + frame), 3) << "C4 is a table";
    EXPECT_EQ(width("\xFF\x01\xFF\xD3" + frame), 3) << "markers without a length";
    EXPECT_EQ(width("\xFF\x00\x00\x02"s + frame), -1) << "a stuffed zero is no marker";
    EXPECT_EQ(width("\xFF\xDA\x00\x02"s + frame), -1) << "data before the frame header";
    EXPECT_EQ(width("\xFF\xD9" + frame), -1) << "the end";
    EXPECT_EQ(width("x" + frame), -1);
    EXPECT_EQ(width("\xFF\xE0\xFF\xFF" + frame), -1) << "a segment that never ends";
}

TEST(Frames, AJpegIsReadWholeOrNotAtAll) {
    // The decoder itself fills with grey what a cut-off file lacks.
    const TemporaryDirectory directory;
    CameraModel camera;
    camera.width = 32;
    camera.height = 24;
    cv::Mat image(camera.height, camera.width, CV_8UC3);
    cv::RNG(3).fill(image, cv::RNG::UNIFORM, 0, 256);
    const std::string bytes = encoded(image, ".jpg");
    writeText(directory / "a.jpg", bytes);
    const auto whole = loadFrame(directory.path(), {"a.jpg", {}, {}}, camera);
    ASSERT_TRUE(whole) << whole.error().message();
    EXPECT_EQ(whole->size(), cv::Size(32, 24));
    for (const double share : {0.6, 0.8, 0.95}) {
        writeText(directory / "a.jpg", bytes.substr(0, static_cast<std::size_t>(share * double(bytes.size()))));
        const auto cut = loadFrame(directory.path(), {"a.jpg", {}, {}}, camera);
        ASSERT_FALSE(cut) << share;
        EXPECT_THAT(cut.error().problem, testing::AnyOf(testing::HasSubstr("damaged"), testing::HasSubstr("header")));
    }
}

TEST(Frames, DamageOfAnyKindIsSaidOnceAndByUs) {
    // Libraries print their own complaints, or none and make something up.
    const TemporaryDirectory directory;
    CameraModel camera;
    camera.width = 32;
    camera.height = 24;
    cv::Mat image(camera.height, camera.width, CV_8UC3);
    cv::RNG(3).fill(image, cv::RNG::UNIFORM, 0, 256);
    const std::string png = encoded(image, ".png");
    const std::string jpeg = encoded(image, ".jpg");
    const std::string extraHeader = png.substr(0, 33) + png.substr(8, 25) + png.substr(33);
    const auto scan = jpeg.find("\xFF\xDA");
    for (const std::string& bytes : {
             png.substr(0, png.size() - 12),                                        // no IEND
             png.substr(0, 33) + png.substr(png.size() - 12),                       // no IDAT
             png.substr(0, png.size() / 2) + "x" + png.substr(png.size() / 2 + 1),  // checksum
             png.substr(0, 33) + "\x7F\xFF\xFF\xFF" + png.substr(37),               // length
             extraHeader,                                                           // IHDR twice
             jpeg.substr(0, jpeg.size() / 2) + "\xFF\xD9",                          // cut off, and closed again
             jpeg.substr(0, scan + 100) + std::string(200, '\x7F') + "\xFF\xD0" + jpeg.substr(scan + 300),
             jpeg.substr(0, jpeg.size() - 2),  // no end
         }) {
        writeText(directory / "a", bytes);
        testing::internal::CaptureStderr();
        const auto frame = loadFrame(directory.path(), {"a", {}, {}}, camera);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        ASSERT_FALSE(frame);
        EXPECT_THAT(frame.error().problem, testing::HasSubstr("damaged"));
    }
}

TEST(Frames, AreDecodedAsTheEncoderMadeThem) {
    Random random(1, "Frames");
    for (int i = 0; i < 20; ++i) {
        const cv::Size size(static_cast<int>(1 + random.index(90)), static_cast<int>(1 + random.index(90)));
        for (const int channels : {1, 3, 4}) {
            cv::Mat image(size, CV_8UC(channels));
            cv::RNG(static_cast<std::uint64_t>(i)).fill(image, cv::RNG::UNIFORM, 0, 256);
            for (const char* kind : {".png", ".jpg"}) {
                const std::string bytes = encoded(image, kind);
                const auto picture = decodePicture(bytes, *parseImageHeader(bytes));
                ASSERT_TRUE(picture) << picture.error();
                const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
                const cv::Mat expected = cv::imdecode(raw, cv::IMREAD_ANYCOLOR);
                ASSERT_EQ(picture->type(), expected.type());
                EXPECT_EQ(cv::norm(*picture, expected, cv::NORM_INF), 0) << kind << channels;
            }
        }
    }
}

TEST(Json, MemoryAndKeysAreLimited) {
    std::string many = "{\"x\": [[]";
    for (std::size_t i = 0; i < kMaxJsonValues; ++i)
        many += ",[]";
    const auto refused = parseRecordingJson(many + "]}", "r.json");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message(), testing::HasSubstr("expected at most 10000000 values"));
    const auto twice = parseTruthJson(R"({"modules": [], "views": [{"b\n": 1, "b\n": 2}]})", "t.json");
    EXPECT_EQ(twice.error().message(), "t.json: expected each key of an object once, 'b ' is there twice");
    EXPECT_TRUE(parseTruthJson(R"({"modules": [], "x": [{"b": 1}, {"b": {"b": 2}}]})", "t.json"));
}

TEST(FileErrorMessage, IsOneLineThatATerminalCanShow) {
    const FileError hostile{"a.json", "modules[0]", "found '\x1B[2J\nhex'"};
    EXPECT_EQ(hostile.message(), "a.json: modules[0]: found ' [2J hex'");
    EXPECT_EQ(printable("a\xC2\x9B"
                        "2Jü\x7F"),
              "a 2Jü ")
        << "an escape sequence of eight bits";
    EXPECT_EQ((FileError{"a\n.json", "", "x"}).message(), "a .json: x");
    std::string endless;
    for (int i = 0; i < 1000; ++i)
        endless += "ü";
    const std::string message = FileError{"a.json", "", "x" + endless}.message();
    EXPECT_LT(message.size(), 500U);
    EXPECT_THAT(message, testing::EndsWith("üü…")) << "cut between characters, not within one";
}

TEST(Csv, ColumnsAreLimited) {
    Recording recording;
    const auto header = parseGravityCsv("pose,module,ax,ay,az" + std::string(5000, ','), "g.csv", recording);
    EXPECT_EQ(header.error().message(), "g.csv: row 1: expected at most 1000 columns");
    const auto row = parseGravityCsv("pose,module,ax,ay,az\n" + std::string(5000, ','), "g.csv", recording);
    EXPECT_THAT(row.error().message(), testing::StartsWith("g.csv: row 2: expected 5 columns"));
}

TEST(Csv, SigmasThatWouldSwampEverythingAreRefused) {
    Recording recording;
    recording.skin.templates = {paperHexagon()};
    recording.skin.modules = {{ModuleId(17), 0}};
    recording.camera.width = recording.camera.height = 100;
    recording.views.resize(1);
    recording.views[0].name = "v";
    for (const char* sigma : {"1e-300", "1e-7", "1e7", "1e300"}) {
        const auto gravity =
            parseGravityCsv("pose,module,ax,ay,az,sigma\n0,17,1,2,3,"s + sigma + "\n", "g.csv", recording);
        EXPECT_EQ(gravity.error().place, "row 2, column sigma");
        const auto found = parseDetectionsCsv("view,module,x,y,sigma\nv,17,1,2,"s + sigma + "\n", "d.csv", recording);
        EXPECT_EQ(found.error().place, "row 2, column sigma");
        EXPECT_THAT(found.error().problem, testing::HasSubstr("from 1e-06 to 1e+06"));
    }
}

TEST(Truth, DefectsAreNamed) {
    const std::string pose = "\"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": [0,0,0]}";
    const auto module = [](const std::string& rest) { return "{\"modules\": [{\"id\": 1, " + rest + "]}"; };
    for (const auto& [text, place, words] : {
             std::tuple("[}"s, "line 1, column 2", "well-formed JSON"),
             std::tuple("{}"s, "", "a key 'modules'"),
             std::tuple("{\"modules\": [{\"id\": 0, " + pose + "]}", "modules[0].id", "an integer from 1"),
             std::tuple(module("\"t\": [0,0,0]}"), "modules[0]", "a key 'R'"),
             std::tuple(module("\"R\": [[1,0,0]], \"t\": [0,0,0]}"), "modules[0].R", "3 rows, found 1"),
             std::tuple(module("\"R\": [[1,0,0],[0,1,0],[0,0,-1]], \"t\": [0,0,0]}"), "modules[0].R", "a rotation"),
             std::tuple("{\"modules\": [{\"id\": 1, " + pose + ", {\"id\": 1, " + pose + "]}", "modules[1].id",
                        "1 is taken"),
             std::tuple(module("\"R\": [[1,0,0],[0,1,0],[0,0,1]], \"t\": [0,2e3,0]}"), "modules[0].t", "within 1000 m"),
             std::tuple("{\"modules\": [], \"pixels\": [[\"v\", 1, 2]]}"s, "pixels[0]", "found 3 entries"),
             std::tuple("{\"modules\": [], \"views\": [{\"name\": 3}]}"s, "views[0].name", "a string"),
         }) {
        const auto truth = parseTruthJson(text, "truth.json");
        ASSERT_FALSE(truth) << text;
        EXPECT_EQ(truth.error().place, place);
        EXPECT_THAT(truth.error().problem, testing::HasSubstr(words));
    }
    EXPECT_TRUE(parseTruthJson(module(pose), "truth.json"));
}

/// Number of modules and of views with measurements in the recordings of another program.
class ForeignRecording : public testing::TestWithParam<std::tuple<const char*, std::size_t, std::size_t>> {};

TEST_P(ForeignRecording, IsReadWithAllItsPictures) {
    const auto& [name, modules, views] = GetParam();
    const fs::path directory = fs::path(SKINCAL_TEST_DATA) / "recordings" / (name + ".skinrec"s);
    const auto recording = readRecording(directory);
    ASSERT_TRUE(recording) << recording.error().message();
    EXPECT_EQ(recording->skin.modules.size(), modules);
    EXPECT_EQ(recording->views.size(), views);
    for (const RecordedView& view : recording->views) {
        EXPECT_NE(view.frames.empty(), view.detections.empty());
        for (const FrameInfo& frame : view.frames) {
            const auto picture = loadFrame(directory, frame, recording->camera);
            EXPECT_TRUE(picture) << picture.error().message();
        }
    }
    const auto truth = readTruth(directory / "truth.json");
    ASSERT_TRUE(truth) << truth.error().message();
    EXPECT_EQ(truth->modules.size(), modules);
    EXPECT_EQ(truth->views.size(), views);
}

INSTANTIATE_TEST_SUITE_P(
    All, ForeignRecording,
    testing::Values(std::tuple("flat-detections", 37U, 8U), std::tuple("freeform-detections", 75U, 10U),
                    std::tuple("cylinder-cables-detections", 55U, 16U), std::tuple("outliers-detections", 59U, 10U),
                    std::tuple("freeform-single-images", 11U, 3U), std::tuple("freeform-coded-one-view", 30U, 1U)));

}  // namespace
}  // namespace skincal
