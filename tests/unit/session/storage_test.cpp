#include "core/session/session_storage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QSignalSpy>
#include <opencv2/core.hpp>

#include "core/vision/decoder.h"
#include "tests/unit/formats/temporary_directory.h"
#include "tests/unit/session/session_samples.h"

namespace skincal {
namespace {

using test::smallRecording;
using test::TemporaryDirectory;
using test::textOf;
using test::waitFor;

QString folderOf(const TemporaryDirectory& directory) {
    return QString::fromStdString(directory.path().string());
}

/// A session with pictures in memory that have no file yet, as a scan leaves them.
OpenedRecording scannedRecording(std::uint64_t seed) {
    Scenario scenario = *findScenario("coded");
    CameraModel& camera = scenario.camera;
    camera.width /= 2;  // small pictures are quick
    camera.height /= 2;
    for (double* pixels : {&camera.fx, &camera.fy, &camera.cx, &camera.cy})
        *pixels /= 2;
    const World world = buildWorld(scenario, seed);
    const Recording recording = recordingOf(world);
    const RecordingFrameLoader load = framesOf(world, recording);
    OpenedRecording opened = openedFrom(recording);
    std::vector<ModuleId> modules;
    for (const SkinModule& module : world.skin.modules)
        modules.push_back(module.id);
    opened.measured.views.resize(2);
    for (std::size_t v = 0; v < opened.measured.views.size(); ++v) {
        ScannedView& view = opened.measured.views[v];
        auto pictures = std::make_shared<Pictures>();
        for (std::size_t k = 0; k < view.frames.size(); ++k) {
            pictures->push_back(load(v, k).value().clone());
            view.frames[k].file.clear();
        }
        view.decoded =
            decodeView(view.name, modules, view.frames, [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
                return (*pictures)[k];
            }).value();
        view.pictures = std::move(pictures);
    }
    return opened;
}

std::size_t filesIn(const std::filesystem::path& folder) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        files += entry.is_regular_file() ? 1U : 0U;
    return files;
}

void expectSame(const OpenedRecording& read, const Measured& measured, const Decisions& decisions) {
    EXPECT_EQ(textOf(measurementsOf(read.measured, read.decisions)), textOf(measurementsOf(measured, decisions)));
    for (const ScannedView& view : read.measured.views) {
        const auto original = std::find_if(measured.views.begin(), measured.views.end(),
                                           [&](const ScannedView& other) { return other.name == view.name; });
        ASSERT_NE(original, measured.views.end());
        ASSERT_EQ(view.pictures->size(), original->pictures->size());
        for (std::size_t k = 0; k < view.pictures->size(); ++k)
            EXPECT_EQ(cv::norm((*view.pictures)[k], (*original->pictures)[k], cv::NORM_INF), 0);
    }
}

TEST(SessionStorage, ReadsWhatItWroteAndWritesNoPictureTwice) {
    const OpenedRecording scanned = scannedRecording(1);
    const TemporaryDirectory directory;
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
    const auto read = readSession(directory.path());
    ASSERT_TRUE(read) << read.error();
    expectSame(*read, scanned.measured, scanned.decisions);
    const std::size_t files = filesIn(directory.path());
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
    ASSERT_TRUE(writeSession(read->measured, read->decisions, directory.path()));
    EXPECT_EQ(filesIn(directory.path()), files);
    const TemporaryDirectory copy;
    ASSERT_TRUE(writeSession(read->measured, read->decisions, copy.path()));
    EXPECT_EQ(filesIn(copy.path()), files);
}

TEST(SessionStorage, DigestsAreThoseOfTheFilesThatAreWritten) {
    OpenedRecording scanned = scannedRecording(1);
    PictureDigests known;
    for (const bool isDropped : {false, true}) {
        if (isDropped)
            scanned.decisions.droppedViews.insert(scanned.measured.views.front().name);
        const TemporaryDirectory directory;
        ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
        const auto written = readRecording(directory.path());
        ASSERT_TRUE(written);
        const auto digests = digestSession(scanned.measured, scanned.decisions, known);
        ASSERT_TRUE(digests);
        EXPECT_EQ(*digests, digestRecording(directory.path(), *written).value());
    }
    EXPECT_EQ(known.size(), scanned.measured.views.size()) << "the pictures of each are encoded once";
    const auto before = digestSession(scanned.measured, scanned.decisions, known);
    scanned.measured.gravity.front().acceleration.x() += 1e-9;
    EXPECT_NE(digestSession(scanned.measured, scanned.decisions, known), before) << "whatever changes shows";
}

TEST(SessionStorage, NothingIsDigestedOfWhatCantBeWrittenNorWhenCancelled) {
    OpenedRecording scanned = scannedRecording(1);
    PictureDigests known;
    RunContext context;
    context.isCancelled = [] { return true; };
    EXPECT_FALSE(digestSession(scanned.measured, scanned.decisions, known, context));
    scanned.decisions.camera.reset();
    EXPECT_FALSE(digestSession(scanned.measured, scanned.decisions, known));
}

TEST(SessionStorage, AViewThatWasScannedAgainIsWrittenAnew) {
    OpenedRecording scanned = scannedRecording(1);
    const TemporaryDirectory directory;
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
    const ScannedView other = scanned.measured.views.back();
    scanned.measured.views.front().pictures = other.pictures;
    scanned.measured.views.front().frames = other.frames;
    scanned.measured.views.front().decoded.found = other.decoded.found;
    scanned.measured.views.front().decoded.undetected = other.decoded.undetected;
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
    const auto read = readSession(directory.path());
    ASSERT_TRUE(read) << read.error();
    expectSame(*read, scanned.measured, scanned.decisions);
}

TEST(SessionStorage, PicturesOfAnotherRecordingInTheFolderAreNotTakenForItsOwn) {
    const OpenedRecording first = scannedRecording(1);
    const OpenedRecording second = scannedRecording(2);
    const TemporaryDirectory directory;
    const TemporaryDirectory elsewhere;
    ASSERT_TRUE(writeSession(first.measured, first.decisions, directory.path()));
    ASSERT_TRUE(writeSession(second.measured, second.decisions, elsewhere.path()));
    const auto named = readSession(elsewhere.path());
    ASSERT_TRUE(named) << named.error();
    ASSERT_TRUE(writeSession(named->measured, named->decisions, directory.path()));
    const auto read = readSession(directory.path());
    ASSERT_TRUE(read) << read.error();
    expectSame(*read, second.measured, second.decisions);
}

TEST(SessionStorage, DroppedViewsAreNotWritten) {
    OpenedRecording scanned = scannedRecording(1);
    scanned.decisions.droppedViews.insert(scanned.measured.views.front().name);
    const TemporaryDirectory directory;
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
    const auto read = readSession(directory.path());
    ASSERT_TRUE(read) << read.error();
    ASSERT_EQ(read->measured.views.size(), 1U);
    expectSame(*read, scanned.measured, scanned.decisions);
    EXPECT_EQ(filesIn(directory.path() / "views"), scanned.measured.views.back().frames.size());
}

TEST(SessionStorage, CancelledReadingGivesNoComplaint) {
    const OpenedRecording scanned = scannedRecording(1);
    const TemporaryDirectory directory;
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto read = readSession(directory.path(), context);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error(), "");
}

TEST(SessionFiles, OpenGivesTheSameDecisionsMeasurementsAndBody) {
    Random random(3);
    Session session;
    session.load(smallRecording(3));
    for (int i = 0; i < 12; ++i)
        session.decide("something", [&](Decisions& d) { test::decideSomething(session.measured(), random, d); });
    ASSERT_TRUE(waitFor([&] { return session.solution() && session.solution()->revision == session.revision(); }));
    const TemporaryDirectory directory;
    const QSignalSpy saved(&session, &Session::saved);
    session.save(folderOf(directory));
    ASSERT_TRUE(waitFor([&] { return saved.count() == 1; }));
    EXPECT_FALSE(session.isModified());

    Session other;
    const QSignalSpy opened(&other, &Session::opened);
    other.open(folderOf(directory));
    ASSERT_TRUE(waitFor([&] { return other.solution() && other.solution()->revision == other.revision(); }));
    EXPECT_EQ(opened.count(), 1);
    EXPECT_FALSE(other.isModified());
    EXPECT_FALSE(other.undoStack().canUndo());
    EXPECT_EQ(textOf(measurementsOf(other.measured(), other.decisions())),
              textOf(measurementsOf(session.measured(), session.decisions())));
    EXPECT_EQ(textOf(other.solution()->body), textOf(session.solution()->body));
}

TEST(SessionFiles, WhatChangesWhileItIsSavedStaysToBeSaved) {
    Session session;
    session.load(smallRecording(1));
    const TemporaryDirectory directory;
    const QSignalSpy saved(&session, &Session::saved);
    session.save(folderOf(directory));
    session.decide("drop", [](Decisions& decisions) { decisions.droppedPoses.insert(0); });
    ASSERT_TRUE(waitFor([&] { return saved.count() == 1; }));
    EXPECT_TRUE(session.isModified());
    EXPECT_EQ(posesOf(readSession(directory.path())->measured, {}).front(), 0);
}

TEST(SessionFiles, SavingThatFailsIsOneClearMessage) {
    Session session;
    const QSignalSpy saved(&session, &Session::saved);
    const QSignalSpy failed(&session, &Session::fileFailed);
    const TemporaryDirectory directory;
    OpenedRecording recording = scannedRecording(1);
    session.load(recording);
    session.decide("drop", [](Decisions& decisions) { decisions.droppedPoses.insert(0); });
    // A file where a folder should be is in everybody's way, the administrator's, too.
    test::writeText(directory / "file", "");
    session.save(folderOf(directory) + "/file/arm.skinrec");
    ASSERT_TRUE(waitFor([&] { return failed.count() == 1; }));
    EXPECT_THAT(failed.at(0).at(0).toString().toStdString(), testing::HasSubstr("file/arm.skinrec"));
    EXPECT_TRUE(session.isModified());

    session.decide("forget the camera", [](Decisions& decisions) { decisions.camera.reset(); });
    session.save(folderOf(directory) + "/arm.skinrec");
    ASSERT_TRUE(waitFor([&] { return failed.count() == 2; }));
    EXPECT_THAT(failed.at(1).at(0).toString().toStdString(), testing::HasSubstr("intrinsics"));
    EXPECT_FALSE(std::filesystem::exists(directory / "arm.skinrec")) << "nothing is left behind";
    EXPECT_EQ(saved.count(), 0);
}

TEST(SessionFiles, ABrokenRecordingLeavesTheSessionAsItWas) {
    Session session;
    session.load(smallRecording(1));
    session.decide("drop", [](Decisions& decisions) { decisions.droppedPoses.insert(0); });
    const std::string before = textOf(session.measured()) + textOf(session.decisions());
    const std::uint64_t revision = session.revision();
    const QSignalSpy failed(&session, &Session::fileFailed);
    const QSignalSpy opened(&session, &Session::opened);
    const TemporaryDirectory directory;
    test::writeText(directory / "recording.json", "{\"format\": 3}");
    session.open(folderOf(directory));
    ASSERT_TRUE(waitFor([&] { return failed.count() == 1; }));
    EXPECT_EQ(failed.at(0).at(0).toString().toStdString(), readRecording(directory.path()).error().message());
    session.open(folderOf(directory) + "/nowhere");
    ASSERT_TRUE(waitFor([&] { return failed.count() == 2; }));
    // A picture that is broken, in a recording that is not.
    const TemporaryDirectory pictures;
    const OpenedRecording scanned = scannedRecording(1);
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, pictures.path()));
    test::writeText(pictures / "views/001/00003.png", "no picture");
    session.open(folderOf(pictures));
    ASSERT_TRUE(waitFor([&] { return failed.count() == 3; }));
    EXPECT_THAT(failed.at(2).at(0).toString().toStdString(), testing::HasSubstr("00003.png"));
    EXPECT_EQ(opened.count(), 0);
    EXPECT_EQ(session.revision(), revision);
    EXPECT_EQ(textOf(session.measured()) + textOf(session.decisions()), before);
    EXPECT_TRUE(session.undoStack().canUndo());
}

TEST(SessionFiles, TheRecordingThatWasOpenedLastIsTheOneThatIsThere) {
    const TemporaryDirectory one;
    const TemporaryDirectory two;
    const OpenedRecording first = smallRecording(1);
    const OpenedRecording second = smallRecording(2);
    ASSERT_TRUE(writeSession(first.measured, first.decisions, one.path()));
    ASSERT_TRUE(writeSession(second.measured, second.decisions, two.path()));
    Session session;
    const QSignalSpy opened(&session, &Session::opened);
    session.open(folderOf(one));
    session.open(folderOf(two));
    ASSERT_TRUE(waitFor([&] { return opened.count() == 1; }));
    EXPECT_EQ(opened.at(0).at(0).toString(), folderOf(two));
    EXPECT_EQ(textOf(session.measured()), textOf(second.measured));
}

TEST(SessionFiles, MayBeDestroyedWhileItReadsAndWrites) {
    const OpenedRecording scanned = scannedRecording(1);
    const TemporaryDirectory directory;
    ASSERT_TRUE(writeSession(scanned.measured, scanned.decisions, directory.path()));
    for (int moment = 0; moment < 6; ++moment) {
        Session session;
        session.open(folderOf(directory));
        for (int turn = 0; turn < 20 * moment; ++turn)
            QCoreApplication::processEvents();
    }
    const TemporaryDirectory copy;
    {
        Session session;
        session.load(scanned);
        session.save(folderOf(copy));
    }
    EXPECT_TRUE(readSession(copy.path())) << "what is being written is written to its end";
}

}  // namespace
}  // namespace skincal
