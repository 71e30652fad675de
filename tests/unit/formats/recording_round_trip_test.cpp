#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "core/formats/body_json.h"
#include "core/formats/json_cursor.h"
#include "core/formats/truth_json.h"
#include "core/geometry/random.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

Recording randomRecording(std::uint64_t seed) {
    Random random(seed, "random recording");
    Recording r;
    r.skin.templates = {paperHexagon(), triangleTemplate()};
    for (std::uint32_t i = 0; i < 12; ++i)
        r.skin.modules.push_back({ModuleId(3 * i + 1), random.index(2), i % 3 == 0 ? "" : "00ff" + std::to_string(i)});
    for (std::uint32_t i = 0; i + 1 < 12; ++i) {
        Link link{ModuleId(3 * i + 1), 0, ModuleId(3 * i + 4), 1};
        if (random.uniform() < 0.5)
            link.decided = random.uniform() < 0.5 ? LinkKind::Adjacent : LinkKind::Cable;
        r.skin.links.push_back(link);
    }
    r.skin.hostLinks = {{ModuleId(1), 2}};
    for (int p = 0; p < 3; ++p) {
        for (const SkinModule& m : r.skin.modules) {
            GravityReading reading{p, m.id, random.normal3(), std::nullopt, std::nullopt};
            if (random.uniform() < 0.5)
                reading.sigma = random.uniform(0.01, 1);
            if (random.uniform() < 0.5)
                reading.samples = static_cast<int>(1 + random.index(100));
            r.gravity.push_back(reading);
        }
    }
    r.camera = {640, 480, 500.25, 501.125, 320.1, 239.9, DistortionModel::Equidistant, {0.1, 0.01, -0.002, 1e-5}};
    RecordedView frames{"pictures", {}, {}};
    frames.frames.push_back({"views/0.png", {}, 0.0});
    frames.frames.push_back(
        {"views/1.png", {{ModuleId(1), std::nullopt}, {ModuleId(4), std::array<int, 3>{1, 0, 1}}}, {}, 3});
    RecordedView detections{"detections", {}, {}};
    for (const SkinModule& m : r.skin.modules)
        detections.detections.push_back(
            {m.id, {random.uniform(0, 639), random.uniform(0, 479)}, random.uniform(0.01, 1)});
    r.views = {frames, detections};
    r.decisions = {{"detections", ModuleId(4), "rejected", "a lamp"}};
    return r;
}

TEST(RecordingRoundTrip, KeepsEverythingToTheLastBit) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const test::TemporaryDirectory directory;
        const Recording a = randomRecording(seed);
        ASSERT_TRUE(writeRecording(a, directory.path()));
        ASSERT_TRUE(writeFrame(directory.path(), "views/0.png", cv::Mat::zeros(480, 640, CV_8UC1)));
        ASSERT_TRUE(writeFrame(directory.path(), "views/1.png", cv::Mat::zeros(480, 640, CV_8UC3)));
        const auto b = readRecording(directory.path());
        ASSERT_TRUE(b) << b.error().message();
        ASSERT_EQ(b->skin.modules.size(), a.skin.modules.size());
        for (std::size_t i = 0; i < a.skin.modules.size(); ++i) {
            EXPECT_EQ(b->skin.modules[i].id, a.skin.modules[i].id);
            EXPECT_EQ(b->skin.modules[i].type, a.skin.modules[i].type);
            EXPECT_EQ(b->skin.modules[i].uniqueId, a.skin.modules[i].uniqueId);
        }
        for (std::size_t t = 0; t < 2; ++t) {
            EXPECT_EQ(b->skin.templates[t].ports, a.skin.templates[t].ports);
            EXPECT_EQ(b->skin.templates[t].outline, a.skin.templates[t].outline);
            EXPECT_EQ(b->skin.templates[t].sensors.size(), a.skin.templates[t].sensors.size());
        }
        for (std::size_t l = 0; l < a.skin.links.size(); ++l)
            EXPECT_EQ(b->skin.links[l].decided, a.skin.links[l].decided);
        EXPECT_EQ(b->skin.hostLinks[0].port, 2);
        ASSERT_EQ(b->gravity.size(), a.gravity.size());
        for (std::size_t g = 0; g < a.gravity.size(); ++g) {
            EXPECT_EQ(b->gravity[g].acceleration, a.gravity[g].acceleration);
            EXPECT_EQ(b->gravity[g].sigma, a.gravity[g].sigma);
            EXPECT_EQ(b->gravity[g].samples, a.gravity[g].samples);
        }
        EXPECT_EQ(b->camera.distortion, a.camera.distortion);
        EXPECT_EQ(b->views[0].frames[1].lit[1].colour, a.views[0].frames[1].lit[1].colour);
        EXPECT_EQ(b->views[0].frames[0].time_s, 0.0);
        EXPECT_EQ(b->views[0].frames[0].look, 0U);
        EXPECT_EQ(b->views[0].frames[1].look, 3U);
        for (std::size_t d = 0; d < a.views[1].detections.size(); ++d)
            EXPECT_EQ(b->views[1].detections[d].pixel, a.views[1].detections[d].pixel);
        EXPECT_EQ(b->decisions[0].reason, "a lamp");
        const auto digests = digestRecording(directory.path(), *b);
        ASSERT_TRUE(digests);
        EXPECT_EQ(digests->size(), 5U);
    }
}

TEST(RecordingRoundTrip, KeepsWhatItDoesNotKnow) {
    const test::TemporaryDirectory directory;
    Recording a = randomRecording(1);
    a.views.erase(a.views.begin());  // pictures
    ASSERT_TRUE(writeRecording(a, directory / "a"));
    auto json = nlohmann::json::parse(test::readText(directory / "a/recording.json"));
    json["operator"] = {{"name", "K\u00e4the"}, {"shift", 2}};
    json["module_types"][1]["vendor_mass"] = 0.25;
    test::writeText(directory / "a/recording.json", json.dump());
    const auto read = readRecording(directory / "a");
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_TRUE(writeRecording(*read, directory / "b"));
    EXPECT_EQ(nlohmann::json::parse(test::readText(directory / "b/recording.json")), json);

    BodyModel body;
    body.templates = read->skin.templates;
    const auto written = nlohmann::json::parse(bodyToJson(body, read->unknownOfTypes));
    EXPECT_EQ(written["module_types"], json["module_types"]);
}

TEST(RecordingRoundTrip, KeepsWhereTheIntrinsicsComeFrom) {
    Recording recording = randomRecording(3);
    // Its pictures are not on the disk.
    recording.views.erase(recording.views.begin());
    CameraOrigin file{CameraOrigin::Kind::File, "cam.yaml", 0, 0, "2026-11-26"};
    CameraOrigin calibrated{CameraOrigin::Kind::Calibrated, "", 14, 0.1125, "2026-11-25"};
    CameraOrigin nominal{CameraOrigin::Kind::Nominal, "", 0, 0, ""};
    for (const CameraOrigin& origin : {CameraOrigin{}, file, calibrated, nominal}) {
        recording.cameraOrigin = origin;
        const test::TemporaryDirectory directory;
        ASSERT_TRUE(writeRecording(recording, directory.path()));
        const std::string text = test::readText(directory / "recording.json");
        EXPECT_EQ(text.find("\"origin\"") != std::string::npos, origin.kind != CameraOrigin::Kind::Unknown);
        const auto back = readRecording(directory.path());
        ASSERT_TRUE(back) << back.error().message();
        EXPECT_EQ(back->cameraOrigin, origin);
    }
    // What can't be is refused, with its place.
    for (const char* bad : {R"({"kind": "guessed"})", R"({"kind": "file"})", R"({"kind": "calibrated", "boards": 0,
                            "rms_px": 1})",
                            R"({"kind": "calibrated", "boards": 3, "rms_px": -1})", R"({})", "7"}) {
        const auto json = nlohmann::json::parse(bad);
        EXPECT_THROW((void)readCameraOrigin(JsonCursor(json, "recording.json")), FileErrorException) << bad;
    }
}

TEST(RecordingRoundTrip, DoesNotOverwriteUnasked) {
    const test::TemporaryDirectory directory;
    const Recording a = randomRecording(1);
    ASSERT_TRUE(writeRecording(a, directory.path()));
    EXPECT_FALSE(writeRecording(a, directory.path()));
    EXPECT_TRUE(writeRecording(a, directory.path(), true));
}

TEST(RecordingRoundTrip, LoadsGreyAndColour) {
    const test::TemporaryDirectory directory;
    CameraModel camera = randomRecording(1).camera;
    cv::Mat colour(480, 640, CV_8UC3, cv::Scalar(1, 2, 3));
    ASSERT_TRUE(writeFrame(directory.path(), "a/b/c.png", colour));
    const auto loaded = loadFrame(directory.path(), {"a/b/c.png", {}, {}}, camera);
    ASSERT_TRUE(loaded);
    EXPECT_EQ(loaded->channels(), 3);
    EXPECT_EQ(cv::norm(*loaded, colour, cv::NORM_INF), 0);
}

TEST(TruthRoundTrip, KeepsPosesAndPixels) {
    Random random(3, "truth");
    Truth truth;
    truth.modules.push_back({ModuleId(9), 2, makeIsometry(random.rotation(), random.normal3())});
    truth.views.push_back({"view0", makeIsometry(random.rotation(), random.normal3())});
    truth.pixels.push_back({"view0", ModuleId(9), {1.5, 2.25}});
    const test::TemporaryDirectory directory;
    ASSERT_TRUE(writeTruth(truth, directory / "truth.json"));
    const auto back = readTruth(directory / "truth.json");
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_TRUE(back->modules[0].T_body_module.matrix() == truth.modules[0].T_body_module.matrix());
    EXPECT_TRUE(back->views[0].T_body_camera.matrix() == truth.views[0].T_body_camera.matrix());
    EXPECT_EQ(back->pixels[0].pixel, truth.pixels[0].pixel);
    test::writeText(directory / "bad.json",
                    R"({"modules": [{"id": 1, "R": [[1,0,0],[0,1,0],[0,0,2]], "t": [0,0,0]}]})");
    EXPECT_EQ(readTruth(directory / "bad.json").error().place, "modules[0].R");
    EXPECT_FALSE(readTruth(directory / "none.json"));
}

}  // namespace
}  // namespace skincal
