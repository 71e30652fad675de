// A whole calibration, with a tester on every model that checks each of its signals.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QAbstractItemModelTester>
#include <QRegularExpression>
#include <QSignalSpy>
#include <QSortFilterProxyModel>

#include "core/formats/body_json.h"
#include "core/workflow/simulated_recording.h"
#include "tests/ui/presenters/desk.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

using test::Desk;
using test::waitFor;

TEST(Models, AreSoundDuringAWholeCalibration) {
    Desk desk;
    constexpr auto kFatal = QAbstractItemModelTester::FailureReportingMode::Fatal;
    const QAbstractItemModelTester links(&desk.connection.links(), kFatal);
    const QAbstractItemModelTester poses(&desk.pose.poses(), kFatal);
    const QAbstractItemModelTester detections(&desk.scan.detections(), kFatal);
    // As the table of the Scan page shows them.
    QSortFilterProxyModel sortedDetections;
    sortedDetections.setSourceModel(&desk.scan.detections());
    sortedDetections.setSortRole(DetectionModel::kSortRole);
    sortedDetections.sort(DetectionModel::Residual, Qt::DescendingOrder);
    const QAbstractItemModelTester sorted(&sortedDetections, kFatal);
    const QAbstractItemModelTester steps(&desk.steps, kFatal);
    const QAbstractItemModelTester problems(&desk.problems, kFatal);
    EXPECT_TRUE(desk.previewOf(0, 5).isEmpty());
    EXPECT_FALSE(desk.write(0, "nowhere").isEmpty());

    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(6));
    EXPECT_EQ(desk.pose.poses().rowCount(), 6);
    ASSERT_TRUE(desk.startCamera());
    EXPECT_FALSE(desk.views.instruction().isEmpty());
    const auto placed = [&] { return desk.session().solution()->body.quality.modulesPlaced; };
    const QRegularExpression gainsNothing(R"(known to ([\d.]+) instead of \1 mm)");
    for (int view = 0; view < 6; ++view) {
        ASSERT_TRUE(desk.scanHere());
        ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
        EXPECT_EQ(desk.scan.detections().rowCount(), static_cast<int>(desk.rig.world().skin.modules.size()));
        EXPECT_EQ(desk.views.views().size(), static_cast<std::size_t>(view) + 1);
        EXPECT_FALSE(desk.views.instruction().isEmpty());
        EXPECT_EQ(desk.views.target().has_value(), !desk.views.reason().isEmpty());
        EXPECT_FALSE(desk.views.reason().contains(gainsNothing)) << desk.views.reason().toStdString();
        if (placed() == desk.rig.world().skin.modules.size() && view > 1)
            break;
        ASSERT_TRUE(desk.moveCamera());
    }
    EXPECT_EQ(placed(), desk.rig.world().skin.modules.size());
    for (const PatchState& patch : desk.views.patches()) {
        EXPECT_TRUE(patch.isPlaced);
        EXPECT_FALSE(patch.views.empty());
    }

    // Decisions, and all of them taken back.
    const int measured = desk.session().undoStack().index();
    const auto kindOf = [&](const LinkKey& key) {
        for (const JudgedLink& link : desk.connection.links().links()) {
            if (LinkKey::of(link.link) == key)
                return link;
        }
        return JudgedLink{};
    };
    const int lastLink = desk.connection.links().rowCount() - 1;
    const LinkKey key = LinkKey::of(desk.connection.links().links().back().link);
    ASSERT_EQ(kindOf(key).kind, LinkKind::Adjacent);
    desk.connection.links().overrule(lastLink, LinkKind::Cable);
    EXPECT_EQ(kindOf(key).kind, LinkKind::Cable) << "at once, not with the next solution";
    EXPECT_TRUE(kindOf(key).isOperatorsWord);
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(kindOf(key).kind, LinkKind::Cable);
    desk.pose.poses().setDropped(0, true);
    const ModuleId module = desk.session().findView(desk.scan.shownView())->decoded.found.front().module;
    desk.scan.detections().reject({module}, "a lamp");
    const auto row = [&] {
        return desk.scan.detections().rows()[static_cast<std::size_t>(desk.scan.detections().rowOf(module).value())];
    };
    EXPECT_EQ(row().state, DetectionRow::State::Rejected);
    EXPECT_EQ(row().reason, "a lamp");
    desk.scan.setDropped(desk.scan.shownView(), true);
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_TRUE(desk.views.views().back().isDropped);
    desk.session().undoStack().setIndex(measured);
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_NE(row().state, DetectionRow::State::Rejected);
    EXPECT_FALSE(kindOf(key).isOperatorsWord);
    desk.problems.setNotice("a file could not be read", Step::Export);
    EXPECT_EQ(desk.problems.problemAt(0).text, "a file could not be read");
    desk.problems.clearNotice();

    // Written files are what the preview began with.
    const test::TemporaryDirectory directory;
    const QSignalSpy written(&desk.exporter, &ExportPresenter::written);
    for (std::size_t format = 0; format < desk.exporter.formats().size(); ++format) {
        const auto file = directory / ("body" + desk.exporter.formats()[format].suffix.toStdString());
        EXPECT_EQ(desk.write(format, file), QString());
        const std::string text = test::readText(file);
        EXPECT_FALSE(text.empty());
        // A file where a folder should be: nothing is written.
        EXPECT_FALSE(desk.write(format, file / "body").isEmpty());
        EXPECT_EQ(test::readText(file), text);
        if (desk.exporter.formats()[format].isReport) {
            if (text.starts_with("<!DOCTYPE")) {
                // As the Result page does.
                for (const Shortfall& shortfall : desk.session().solution()->shortfalls)
                    EXPECT_TRUE(QString::fromStdString(text).contains(
                        QString::fromStdString(shortfall.text.english()).toHtmlEscaped()));
                EXPECT_EQ(text.find("Nothing is missing") == std::string::npos,
                          !desk.session().solution()->shortfalls.empty() ||
                              !desk.session().solution()->body.quality.warnings.empty());
            }
            continue;
        }
        for (const int lines : {1, 7}) {
            QString preview = desk.previewOf(format, lines);
            EXPECT_EQ(preview.count('\n'), lines);
            EXPECT_TRUE(preview.endsWith(QStringLiteral("…")));
            preview.chop(1);
            EXPECT_EQ(text.substr(0, preview.toStdString().size()), preview.toStdString());
        }
        EXPECT_EQ(desk.previewOf(format, 1'000'000).toStdString(), text);
    }
    EXPECT_EQ(static_cast<std::size_t>(written.count()), desk.exporter.formats().size());
    const auto read = readBody(directory / "body.body.json");
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->modules.size(), desk.rig.world().skin.modules.size());
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory.path()))
        ++files;
    EXPECT_EQ(files, desk.exporter.formats().size()) << "no half-written file is left";

    // Unplugged, and another skin's file opened.
    desk.rig.pullSkin();
    desk.rig.pullCamera();
    ASSERT_TRUE(waitFor([&] { return desk.connection.state().phase == Connection::Phase::Lost; }));
    desk.session().load({});
    EXPECT_EQ(desk.connection.links().rowCount() + desk.pose.poses().rowCount(), 0);
    EXPECT_EQ(desk.scan.detections().rowCount(), 0);
    EXPECT_EQ(desk.exporter.body(), nullptr);
}

// What the picture left open and the body decided is a detection like any other, with its reason; it can be rejected
// and accepted again.
TEST(DetectionModel, TellsWhichOfSeveralSpotsTheBodyTook) {
    Desk desk;
    Scenario scenario = *findScenario("coded");
    scenario.views.scan = ScanKind::Detections;
    OpenedRecording opened = openedFrom(recordingOf(buildWorld(scenario, 1)));
    ViewDetections& decoded = opened.measured.views.front().decoded;
    const auto doubt = [&](const Vector2d& offset, bool isLedSeen) {
        const LedDetection led = decoded.found.back();
        decoded.found.pop_back();
        Undetected several{led.module, DetectionVerdict::Ambiguous, Sentence::verbatim("two spots blink its word")};
        several.cause = Undetected::Cause::Reflected;
        several.spots = {{led.pixel + Vector2d(50, 20), led.sigma_px, 1},
                         {led.pixel + offset, led.sigma_px, isLedSeen ? 0.9 : 0.8}};
        decoded.undetected.push_back(several);
        return led;
    };
    const LedDetection told = doubt({0, 0}, true);
    const LedDetection open = doubt({-60, 40}, false);
    desk.session().load(opened);
    desk.scan.detections().setView(decoded.name);
    const auto rowOf = [&](const LedDetection& led) {
        return desk.scan.detections()
            .rows()[static_cast<std::size_t>(desk.scan.detections().rowOf(led.module).value())];
    };
    EXPECT_EQ(rowOf(told).state, DetectionRow::State::Reflected) << "nothing is known of the body yet";
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(rowOf(told).state, DetectionRow::State::Used);
    EXPECT_EQ(rowOf(told).pixel, told.pixel);
    EXPECT_EQ(rowOf(told).sigma_px, told.sigma_px);
    EXPECT_LT(rowOf(told).residual_px.value_or(99), 1);
    EXPECT_TRUE(rowOf(told).reason.contains(QStringLiteral("this one lies where the body has it")));
    EXPECT_EQ(rowOf(open).state, DetectionRow::State::Reflected);
    EXPECT_FALSE(rowOf(open).pixel);
    EXPECT_TRUE(rowOf(open).reason.contains(QStringLiteral("none lies where the body has it")));

    desk.scan.detections().reject({told.module}, "a reflection");
    EXPECT_EQ(rowOf(told).state, DetectionRow::State::Rejected);
    EXPECT_TRUE(rowOf(told).isOperatorsWord);
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(rowOf(told).state, DetectionRow::State::Rejected);
    EXPECT_EQ(rowOf(told).reason, "a reflection");
    desk.scan.detections().accept({told.module});
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(rowOf(told).state, DetectionRow::State::Used);
}

TEST(ExportPresenter, TheNewestPreviewAloneArrives) {
    Desk desk;
    desk.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    const QSignalSpy previewed(&desk.exporter, &ExportPresenter::previewed);
    desk.exporter.preview(0, 3);
    desk.exporter.preview(1, 3);
    desk.exporter.preview(2, 1);
    ASSERT_TRUE(waitFor([&] { return previewed.count() > 0; }));
    EXPECT_EQ(previewed.count(), 1);
    EXPECT_TRUE(previewed.front().front().toString().startsWith(QStringLiteral("id,")));
}

TEST(ExportPresenter, ABodyThatChangesWhileItIsWrittenIsNotTakenForWritten) {
    Desk desk;
    desk.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    QObject::connect(&desk.exporter, &ExportPresenter::written, &desk.steps,
                     [&](const QString&, const std::shared_ptr<const Solution>& of) { desk.steps.noteExport(of); });
    const test::TemporaryDirectory directory;
    desk.exporter.write(0, directory / "arm.body.json");
    EXPECT_TRUE(desk.exporter.isWriting());
    desk.pose.poses().setDropped(1, true);
    ASSERT_TRUE(waitFor([&] { return desk.isSolved() && !desk.exporter.isWriting(); }));
    EXPECT_EQ(desk.steps.states()[static_cast<std::size_t>(Step::Export)].reason, StepReason::Changed);
}

TEST(ExportPresenter, WhatIsBeingWrittenIsWrittenThoughTheWindowCloses) {
    const test::TemporaryDirectory directory;
    {
        Desk desk;
        desk.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
        ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
        desk.exporter.write(0, directory / "arm.body.json");
    }
    EXPECT_TRUE(readBody(directory / "arm.body.json"));
}

TEST(StepModel, WhatIsUndoneLeavesAnExportUpToDate) {
    Desk desk;
    desk.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    const auto state = [&] { return desk.steps.states()[static_cast<std::size_t>(Step::Export)]; };
    EXPECT_EQ(state().status, StepStatus::ToDo);
    desk.steps.noteExport(desk.session().solution());
    EXPECT_EQ(state().status, StepStatus::Done);
    desk.pose.poses().setDropped(1, true);
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(state().reason, StepReason::Changed);
    desk.session().undoStack().undo();
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(state().status, StepStatus::Done) << "the body is the one that was exported";
    desk.session().undoStack().redo();
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(state().reason, StepReason::Changed);
}

TEST(LinkModel, ShowsNoLinksOfAnOlderNetwork) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(3));
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    Skin skin = desk.session().measured().skin;
    // As many links as before, one of them another.
    std::swap(skin.links.front(), skin.links.back());
    skin.links.back().a_port = (skin.links.back().a_port + 1) % 3;
    desk.session().adoptSkin(skin);
    std::set<LinkKey> expected;
    for (const Link& link : skin.links)
        expected.insert(LinkKey::of(link));
    for (const JudgedLink& link : desk.connection.links().links())
        EXPECT_TRUE(expected.contains(LinkKey::of(link.link)));
}

}  // namespace
}  // namespace skincal
