#include "core/session/session_data.h"

#include <gtest/gtest.h>

#include "core/workflow/calibrate.h"
#include "tests/unit/session/session_samples.h"

namespace skincal {
namespace {

using test::decideSomething;
using test::smallRecording;
using test::textOf;

std::string textOfRecording(const Recording& r) {
    test::Text text;
    text << r.skin << r.gravity << r.camera;
    for (const RecordedView& view : r.views)
        text << view.name << view.frames << view.detections;
    for (const Decision& d : r.decisions)
        text << d.view << d.module.value << d.verdict << d.reason;
    return text.str();
}

/// Three in a row, with or without unique ids.
Skin threeInARow(bool haveUniqueIds) {
    Skin skin;
    skin.templates = {paperHexagon()};
    for (const std::uint32_t id : {5U, 7U, 9U})
        skin.modules.push_back({ModuleId(id), 0, haveUniqueIds ? "cell" + std::to_string(id) : ""});
    skin.links = {{ModuleId(5), 0, ModuleId(7), 3, {}}, {ModuleId(7), 0, ModuleId(9), 3, {}}};
    return skin;
}

TEST(SameSkin, AModuleThatDoesNotAnswerTodayStaysWithItsLinks) {
    const Skin before = threeInARow(true);
    Skin now = before;
    now.modules.pop_back();
    now.links.pop_back();
    const auto same = sameSkin(before, now);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->modules.size(), 3U);
    EXPECT_EQ(same->links.size(), 2U);
    EXPECT_EQ(same->templateOf(2).name, "hex");
    // And is there again as it was.
    EXPECT_EQ(sameSkin(*same, before)->links.size(), 2U);
}

TEST(SameSkin, MayGrow) {
    Skin now = threeInARow(true);
    now.modules.push_back({ModuleId(11), 0, "cell11"});
    const auto same = sameSkin(threeInARow(true), now);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->modules.size(), 4U);
}

TEST(SameSkin, WithoutUniqueIdsAllModulesHaveToBeThere) {
    const Skin before = threeInARow(false);
    EXPECT_TRUE(sameSkin(before, before));
    Skin now = before;
    now.modules.pop_back();
    EXPECT_FALSE(sameSkin(before, now));
}

TEST(SameSkin, AnotherModuleUnderAKnownNumberIsAnotherSkin) {
    Skin now = threeInARow(true);
    now.modules[1].uniqueId = "stranger";
    EXPECT_FALSE(sameSkin(threeInARow(true), now));
    EXPECT_FALSE(sameSkin(Skin{}, now));
}

TEST(SessionData, ARecordingTakenApartIsTheSameAgain) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        for (const ScanKind scan : {ScanKind::Detections, ScanKind::Coded}) {
            const Recording recording = recordingOf(test::smallWorld(seed, scan));
            const OpenedRecording opened = openedFrom(recording);
            EXPECT_EQ(textOfRecording(recordingOf(opened.measured, opened.decisions)), textOfRecording(recording));
        }
    }
}

TEST(SessionData, WhereTheIntrinsicsComeFromIsKeptWithThem) {
    Recording recording = recordingOf(test::smallWorld(1, ScanKind::Detections));
    recording.cameraOrigin = {CameraOrigin::Kind::Calibrated, "", 14, 0.11, "2026-11-26"};
    OpenedRecording opened = openedFrom(recording);
    EXPECT_EQ(opened.decisions.cameraOrigin, recording.cameraOrigin);
    EXPECT_EQ(recordingOf(opened.measured, opened.decisions).cameraOrigin, recording.cameraOrigin);
    Decisions other = opened.decisions;
    other.cameraOrigin.boards = 15;
    EXPECT_FALSE(other == opened.decisions) << "calibrated anew it is another decision";
}

TEST(SessionData, ARecordingKeepsEveryDecisionAndGivesTheSameMeasurements) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        auto [measured, decisions] = smallRecording(seed);
        for (int i = 0; i < 15; ++i)
            decideSomething(measured, random, decisions);
        const Recording recording = recordingOf(measured, decisions);
        const OpenedRecording opened = openedFrom(recording);
        EXPECT_EQ(textOf(measurementsOf(opened.measured, opened.decisions)),
                  textOf(measurementsOf(measured, decisions)));
        EXPECT_EQ(textOfRecording(recordingOf(opened.measured, opened.decisions)), textOfRecording(recording));
        // What was dropped is gone from a file, and what was said of it.
        Decisions left = decisions;
        left.droppedPoses.clear();
        left.droppedViews.clear();
        std::erase_if(left.detections,
                      [&](const auto& entry) { return decisions.droppedViews.contains(entry.first.view); });
        EXPECT_TRUE(opened.decisions == left);
        EXPECT_EQ(textOf(opened.decisions), textOf(left));
    }
}

TEST(SessionData, MeasurementsAreThoseOfTheCommandLine) {
    const RecordingFrameLoader noPictures = [](std::size_t, std::size_t) -> tl::expected<cv::Mat, std::string> {
        return tl::unexpected(std::string("there is none"));
    };
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        auto [measured, decisions] = smallRecording(seed);
        for (int i = 0; i < 15; ++i)
            decideSomething(measured, random, decisions);
        const auto expected = measure(recordingOf(measured, decisions), noPictures, {}, {});
        ASSERT_TRUE(expected);
        EXPECT_EQ(textOf(measurementsOf(measured, decisions)), textOf(*expected));
    }
}

TEST(SessionData, WithoutACameraViewsAreLeftOut) {
    auto [measured, decisions] = smallRecording(1);
    decisions.camera.reset();
    const Measurements measurements = measurementsOf(measured, decisions);
    EXPECT_TRUE(measurements.views.empty());
    EXPECT_EQ(measurements.gravity.size(), measured.gravity.size());
}

TEST(SessionData, ARejectedDetectionCountsAsNotFoundAndSaysWhy) {
    auto [measured, decisions] = smallRecording(2);
    const ScannedView& view = measured.views.front();
    const ModuleId rejected = view.decoded.found.at(0).module;
    const ModuleId accepted = view.decoded.found.at(1).module;
    decisions.detections[{view.name, rejected}] = {view.name, rejected, "rejected", "a lamp"};
    decisions.detections[{view.name, accepted}] = {view.name, accepted, "accepted", ""};
    const ViewDetections counts = measurementsOf(measured, decisions).views.front();
    EXPECT_EQ(counts.found.size() + 1, view.decoded.found.size());
    EXPECT_EQ(counts.found.front().module, accepted);
    ASSERT_EQ(counts.undetected.size(), view.decoded.undetected.size() + 1);
    EXPECT_EQ(counts.undetected.back().module, rejected);
    EXPECT_EQ(counts.undetected.back().reason, "rejected by the operator: a lamp");
}

TEST(SessionData, SeveralSpotsOfARejectedModuleAreNoChoice) {
    auto [measured, decisions] = smallRecording(2);
    ScannedView& view = measured.views.front();
    const LedDetection first = view.decoded.found.front();
    view.decoded.found.erase(view.decoded.found.begin());
    Undetected several{first.module, DetectionVerdict::Ambiguous, Sentence::verbatim("two spots blink its word")};
    several.spots = {{first.pixel, first.sigma_px, 1}, {first.pixel + Vector2d(50, 0), first.sigma_px, 0.8}};
    view.decoded.undetected = {several};
    const ViewDetections before = measurementsOf(measured, decisions).views.front();
    EXPECT_EQ(before.undetected.back().spots.size(), 2U);
    decisions.detections[{view.name, first.module}] = {view.name, first.module, "rejected", ""};
    const ViewDetections after = measurementsOf(measured, decisions).views.front();
    ASSERT_EQ(after.undetected.size(), before.undetected.size());
    EXPECT_TRUE(after.undetected.back().spots.empty());
    EXPECT_EQ(after.undetected.back().reason, "rejected by the operator");
}

TEST(SessionData, ALinkIsTheSameFromEitherEnd) {
    auto [measured, decisions] = smallRecording(3);
    for (const Link& link : measured.skin.links) {
        const Link other{link.b, link.b_port, link.a, link.a_port};
        EXPECT_EQ(LinkKey::of(link), LinkKey::of(other));
        EXPECT_LE(LinkKey::of(link).a, LinkKey::of(link).b);
    }
    // Reported by both ends, the operator's word holds for both reports.
    const Link first = measured.skin.links.front();
    measured.skin.links.push_back({first.b, first.b_port, first.a, first.a_port});
    decisions.links[LinkKey::of(first)] = LinkKind::Cable;
    const Skin skin = measurementsOf(measured, decisions).skin;
    EXPECT_EQ(skin.links.front().decided, LinkKind::Cable);
    EXPECT_EQ(skin.links.back().decided, LinkKind::Cable);
}

TEST(SessionData, PosesThatCountRise) {
    auto [measured, decisions] = smallRecording(4);
    std::reverse(measured.gravity.begin(), measured.gravity.end());
    const std::vector<int> all = posesOf(measured, decisions);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    decisions.droppedPoses = {all.front(), all.back()};
    EXPECT_EQ(posesOf(measured, decisions), std::vector<int>(all.begin() + 1, all.end() - 1));
}

TEST(SessionData, KeysOfAFileThatNobodyKnowsAreKept) {
    Recording recording = recordingOf(test::smallWorld(5));
    recording.unknown["robot"] = "\"left\"";
    recording.unknownOfTypes[recording.skin.templates.front().name]["colour"] = "\"red\"";
    const OpenedRecording opened = openedFrom(recording);
    const Recording again = recordingOf(opened.measured, opened.decisions);
    EXPECT_EQ(again.unknown, recording.unknown);
    EXPECT_EQ(again.unknownOfTypes, recording.unknownOfTypes);
}

}  // namespace
}  // namespace skincal
