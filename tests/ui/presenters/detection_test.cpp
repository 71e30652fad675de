// The table of detections: states, filter, and what is shown of one.

#include <gtest/gtest.h>

#include <QAbstractItemModelTester>
#include <QSignalSpy>
#include <opencv2/core.hpp>
#include <set>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/presenters/desk.h"
#include "ui/presenters/detection_filter.h"
#include "ui/presenters/spot_evidence.h"

namespace skincal {
namespace {

using State = DetectionRow::State;
using test::Desk;
using test::waitFor;
constexpr auto kFatal = QAbstractItemModelTester::FailureReportingMode::Fatal;

/// A recording of LED positions in which one module of a view has a cause of its own not to be found.
OpenedRecording withCauses(const std::vector<Undetected::Cause>& causes) {
    Scenario scenario = *findScenario("coded");
    scenario.views.scan = ScanKind::Detections;
    OpenedRecording opened = openedFrom(recordingOf(buildWorld(scenario, 1)));
    ViewDetections& decoded = opened.measured.views.front().decoded;
    for (const Undetected::Cause cause : causes) {
        decoded.undetected.push_back(
            {decoded.found.back().module, DetectionVerdict::NotFound, Sentence::verbatim("a reason"), {}, cause});
        decoded.found.pop_back();
    }
    return opened;
}

TEST(DetectionModel, HasAStateOfItsOwnForEveryCause) {
    using Cause = Undetected::Cause;
    const std::vector<std::pair<Cause, State>> expected{
        {Cause::OutOfSight, State::NotVisible},   {Cause::TooWeak, State::TooWeak},
        {Cause::Reflected, State::Reflected},     {Cause::Alike, State::Ambiguous},
        {Cause::NotAnLed, State::NotAnLed},       {Cause::TooBright, State::TooBright},
        {Cause::CameraMoved, State::CameraMoved}, {Cause::NeverBlinked, State::NeverLit}};
    std::set<QString> names;
    for (const auto& [cause, state] : expected) {
        Desk desk;
        OpenedRecording opened = withCauses({cause});
        const Undetected missed = opened.measured.views.front().decoded.undetected.back();
        const std::string view = opened.measured.views.front().name;
        desk.session().load(std::move(opened));
        DetectionModel& model = desk.scan.detections();
        model.setView(view);
        const int row = model.rowOf(missed.module).value();
        EXPECT_EQ(model.rows()[static_cast<std::size_t>(row)].state, state);
        const QModelIndex index = model.index(row, DetectionModel::State);
        EXPECT_EQ(index.data().toString(), nameOf(state));
        EXPECT_EQ(index.data(DetectionModel::kSortRole).toInt(), static_cast<int>(state));
        EXPECT_EQ(index.data(Qt::ToolTipRole).toString(), meaningOf(state));
        EXPECT_EQ(model.index(row, DetectionModel::Reason).data(Qt::ToolTipRole).toString(), "a reason");
        names.insert(nameOf(state));
    }
    EXPECT_EQ(names.size(), expected.size());
}

TEST(DetectionModel, HasARowForModulesOfWhichARecordingSaysNothing) {
    Desk desk;
    OpenedRecording opened = withCauses({});
    const LedDetection unsaid = opened.measured.views.front().decoded.found.back();
    opened.measured.views.front().decoded.found.pop_back();
    const std::string view = opened.measured.views.front().name;
    desk.session().load(std::move(opened));
    DetectionModel& model = desk.scan.detections();
    model.setView(view);
    EXPECT_EQ(model.rowCount(), static_cast<int>(desk.session().measured().skin.modules.size()));
    const DetectionRow& row = model.rows()[static_cast<std::size_t>(model.rowOf(unsaid.module).value())];
    EXPECT_EQ(row.state, State::NotVisible);
    EXPECT_FALSE(row.reason.isEmpty());
}

class Filtered : public ::testing::Test {
  protected:
    void SetUp() override {
        OpenedRecording opened = withCauses({Undetected::Cause::TooWeak});
        view_ = opened.measured.views.front().name;
        weak_ = opened.measured.views.front().decoded.undetected.back().module;
        LedDetection& off = opened.measured.views.front().decoded.found.front();
        off.pixel += Vector2d(1.5, 0);
        off_ = off.module;
        desk_.session().load(std::move(opened));
        desk_.scan.detections().setView(view_);
        ASSERT_TRUE(waitFor([&] { return desk_.isSolved(); }));
    }
    [[nodiscard]] std::set<unsigned> shown() const {
        std::set<unsigned> modules;
        for (int row = 0; row < filter_.rowCount(); ++row) {
            EXPECT_EQ(filter_.rowAt(row).module.value, filter_.index(row, DetectionModel::Module).data().toUInt());
            modules.insert(filter_.rowAt(row).module.value);
        }
        return modules;
    }
    [[nodiscard]] std::set<unsigned> where(const std::function<bool(const DetectionRow&)>& isSo) {
        std::set<unsigned> modules;
        for (const DetectionRow& row : desk_.scan.detections().rows()) {
            if (isSo(row))
                modules.insert(row.module.value);
        }
        return modules;
    }

    Desk desk_;
    DetectionFilter filter_{desk_.scan.detections()};
    QAbstractItemModelTester tester_{&filter_, kFatal};
    std::string view_;
    ModuleId weak_;
    ModuleId off_;
};

TEST_F(Filtered, ShowsAllAtFirstAndWhatIsAskedForLater) {
    const auto all = where([](const DetectionRow&) { return true; });
    EXPECT_FALSE(filter_.isOn());
    EXPECT_EQ(shown(), all);

    filter_.setDoubtfulOnly(true);
    EXPECT_TRUE(filter_.isOn());
    const auto doubtful = where([&](const DetectionRow& row) {
        return row.state != State::Used || row.residual_px.value_or(0) > filter_.limit();
    });
    EXPECT_EQ(shown(), doubtful);
    EXPECT_TRUE(doubtful.contains(weak_.value));
    EXPECT_TRUE(doubtful.contains(off_.value));
    EXPECT_LT(doubtful.size(), all.size());

    filter_.setFarOnly(true);
    for (const double limit : {0.0, 0.01, 0.5, 1.0, 50.0}) {
        filter_.setLimit(limit);
        EXPECT_EQ(shown(), where([&](const DetectionRow& row) { return row.residual_px.value_or(-1) > limit; }));
    }
    filter_.setLimit(0.5);
    EXPECT_FALSE(shown().contains(weak_.value)) << "it has no residual";
    filter_.clear();
    EXPECT_EQ(shown(), all);

    filter_.setNumber(QStringLiteral(" %1 ").arg(off_.value));
    EXPECT_TRUE(shown().contains(off_.value));
    for (const unsigned module : shown())
        EXPECT_TRUE(QString::number(module).contains(QString::number(off_.value)));
    filter_.setNumber(QStringLiteral("no number"));
    EXPECT_TRUE(shown().empty());
    filter_.setNumber({});
    EXPECT_EQ(shown(), all);
}

TEST_F(Filtered, FollowsDecisionsAndSortsByState) {
    filter_.sort(DetectionModel::State, Qt::DescendingOrder);
    for (int row = 1; row < filter_.rowCount(); ++row)
        EXPECT_GE(filter_.rowAt(row - 1).state, filter_.rowAt(row).state);
    filter_.setDoubtfulOnly(true);
    const auto used = where([&](const DetectionRow& row) {
        return row.state == State::Used && row.residual_px.value_or(0) <= filter_.limit();
    });
    ASSERT_FALSE(used.empty());
    const ModuleId module{*used.begin()};
    EXPECT_FALSE(shown().contains(module.value));
    desk_.scan.detections().reject({module}, "a lamp");
    EXPECT_TRUE(shown().contains(module.value));
    desk_.session().undoStack().undo();
    ASSERT_TRUE(waitFor([&] { return desk_.isSolved(); }));
    EXPECT_FALSE(shown().contains(module.value));
    desk_.scan.detections().setView("none");
    EXPECT_TRUE(shown().empty());
}

TEST(SpotEvidence, ShowsTheSpotWhereItIs) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    ASSERT_TRUE(desk.scanHere());
    const ScannedView& view = desk.session().measured().views.front();
    for (const LedDetection& found : view.decoded.found) {
        const auto evidence = evidenceOf(view, found.module, found.pixel);
        ASSERT_TRUE(evidence);
        EXPECT_GT(evidence->contrast, 10);
        for (const cv::Mat& crop : {evidence->lit, evidence->dark, evidence->difference, evidence->threshold}) {
            EXPECT_EQ(crop.size(), cv::Size(21, 21));
            EXPECT_EQ(crop.type(), CV_8U);
        }
        const cv::Point at(cvRound(found.pixel.x()) - evidence->corner.x,
                           cvRound(found.pixel.y()) - evidence->corner.y);
        EXPECT_EQ(at, cv::Point(10, 10));
        EXPECT_EQ(evidence->threshold.at<unsigned char>(at), 255) << "its centre passes";
        EXPECT_LT(cv::countNonZero(evidence->threshold), 21 * 21 / 4) << "most does not";
        ASSERT_TRUE(evidence->width_px) << found.module.value;
        EXPECT_GT(*evidence->width_px, 0.3);
        EXPECT_LT(*evidence->width_px, 4);
    }
    // Beyond the edge there is nothing.
    const ModuleId module = view.decoded.found.front().module;
    const auto corner = evidenceOf(view, module, Vector2d(0, 0));
    ASSERT_TRUE(corner);
    EXPECT_EQ(corner->lit.size(), cv::Size(21, 21));
    EXPECT_EQ(cv::countNonZero(corner->lit(cv::Rect(0, 0, 10, 10))), 0);
    EXPECT_EQ(corner->corner, cv::Point(-10, -10));
    EXPECT_FALSE(evidenceOf(view, module, Vector2d(-500, 10)));
    EXPECT_FALSE(evidenceOf(view, ModuleId{999999}, view.decoded.found.front().pixel)) << "it was never lit";
}

TEST(SpotEvidence, TheBodyTellsWhereAModuleIsThatWasNotFound) {
    Desk desk;
    OpenedRecording opened = withCauses({Undetected::Cause::OutOfSight});
    const std::string view = opened.measured.views.front().name;
    const ModuleId missed = opened.measured.views.front().decoded.undetected.back().module;
    const LedDetection found = opened.measured.views.front().decoded.found.front();
    desk.session().load(std::move(opened));
    EXPECT_FALSE(placeByBody(desk.session(), view, found.module)) << "there is no body yet";
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    const auto place = placeByBody(desk.session(), view, found.module);
    ASSERT_TRUE(place);
    EXPECT_LT((place->led - found.pixel).norm(), 2);
    const auto hidden = placeByBody(desk.session(), view, missed);
    ASSERT_TRUE(hidden);
    EXPECT_EQ(hidden->sight, OverlayModule::Sight::Open) << "it was found in truth";
    EXPECT_FALSE(placeByBody(desk.session(), "none", missed));
}

}  // namespace
}  // namespace skincal
