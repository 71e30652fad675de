#include "ui/presenters/mesh_presenter.h"

#include <gtest/gtest.h>

#include <set>

#include "core/formats/stl_file.h"
#include "core/simulation/body_surface.h"
#include "core/workflow/simulated_recording.h"
#include "tests/unit/formats/temporary_directory.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::waitFor;

class MeshPresenterTest : public ::testing::Test {
  protected:
    void open() {
        workbench_.session().load(openedFrom(recordingOf(world_)));
        ASSERT_TRUE(waitFor([&] { return workbench_.session().solution() && !workbench_.session().isSolving(); }));
    }
    [[nodiscard]] QString file(const std::string& name, const std::string& bytes) {
        test::writeText(directory_ / name, bytes);
        return QString::fromStdString((directory_ / name).string());
    }
    [[nodiscard]] bool isDone() { return presenter_.comparison() || !presenter_.complaint().isEmpty(); }

    test::TemporaryDirectory directory_;
    World world_ = buildWorld(*findScenario("cylinder"), 1);
    Workbench workbench_;
    MeshPresenter presenter_{workbench_};
};

TEST_F(MeshPresenterTest, ComparesOnlyWhileSomebodyLooks) {
    open();
    presenter_.open(file("body.stl", stlBytes(scaled(bodySurface(world_), 1e3))));
    EXPECT_TRUE(presenter_.hasMesh());
    EXPECT_EQ(presenter_.name(), "body.stl");
    EXPECT_FALSE(presenter_.isBusy());
    presenter_.setActive(true);
    EXPECT_TRUE(presenter_.isBusy());
    presenter_.setActive(false);
    ASSERT_TRUE(waitFor([&] { return !presenter_.isBusy(); }));
    EXPECT_FALSE(presenter_.comparison());
    presenter_.setActive(true);
    ASSERT_TRUE(waitFor([&] { return isDone(); }));
    ASSERT_TRUE(presenter_.comparison()) << presenter_.complaint().toStdString();
    EXPECT_EQ(presenter_.usedUnit(), MeshUnit::Millimetre);
    EXPECT_LT(presenter_.comparison()->rms, 1.5e-3);

    presenter_.setOffsetFitted(false);
    EXPECT_FALSE(presenter_.comparison()) << "what is shown is of what is chosen";
    ASSERT_TRUE(waitFor([&] { return isDone(); }));
    EXPECT_EQ(presenter_.comparison()->offset, 0);
    presenter_.remove();
    EXPECT_FALSE(presenter_.hasMesh());
    EXPECT_FALSE(presenter_.comparison());
}

TEST_F(MeshPresenterTest, RemovedWhileItIsComparedItStaysAway) {
    open();
    presenter_.setActive(true);
    presenter_.open(file("body.stl", stlBytes(bodySurface(world_))));
    presenter_.remove();
    ASSERT_TRUE(waitFor([&] { return !presenter_.isBusy(); }));
    EXPECT_FALSE(presenter_.hasMesh());
    EXPECT_FALSE(presenter_.comparison());
    EXPECT_TRUE(presenter_.complaint().isEmpty());
}

TEST_F(MeshPresenterTest, LeftInTheMiddleAFileIsNotReadAgain) {
    open();
    const QString name = file("body.stl", stlBytes(bodySurface(world_)));
    presenter_.setActive(true);
    presenter_.open(name);
    presenter_.setActive(false);
    ASSERT_TRUE(waitFor([&] { return !presenter_.isBusy(); }));
    EXPECT_FALSE(presenter_.comparison());
    ASSERT_TRUE(std::filesystem::remove(name.toStdString()));
    presenter_.setActive(true);
    ASSERT_TRUE(waitFor([&] { return isDone(); }));
    EXPECT_TRUE(presenter_.comparison()) << presenter_.complaint().toStdString();
    // Another mesh is read, and the first one again where it is asked for again.
    presenter_.open(name);
    ASSERT_TRUE(waitFor([&] { return isDone(); }));
    EXPECT_TRUE(presenter_.complaint().startsWith("This mesh can't be read: ")) << presenter_.complaint().toStdString();
}

TEST_F(MeshPresenterTest, AnotherMeshIsNotTakenForTheOneBefore) {
    open();
    presenter_.setActive(true);
    presenter_.open(file("body.stl", stlBytes(bodySurface(world_))));
    presenter_.open(file("body.stl", stlBytes(scaled(bodySurface(world_), 1e3))));
    ASSERT_TRUE(waitFor([&] { return isDone(); }));
    ASSERT_TRUE(presenter_.comparison()) << presenter_.complaint().toStdString();
    EXPECT_EQ(presenter_.usedUnit(), MeshUnit::Millimetre);
}

TEST_F(MeshPresenterTest, GoneInTheMiddleOfReadingOrComparingItLetsGo) {
    open();
    const QString name = file("body.stl", stlBytes(bodySurface(world_)));
    for (int turns = 0; turns < 20; ++turns) {
        MeshPresenter other(workbench_);
        other.setActive(true);
        other.open(name);
        for (int i = 0; i < turns; ++i)
            QCoreApplication::processEvents();
        if (turns % 2)
            other.setUnit(MeshUnit::Metre);
    }
}

TEST_F(MeshPresenterTest, SaysWhatIsWrongWithAMeshOrABody) {
    presenter_.setActive(true);
    presenter_.open(file("body.stl", stlBytes(bodySurface(world_))));
    ASSERT_TRUE(waitFor([&] { return isDone(); }));
    EXPECT_TRUE(presenter_.complaint().contains("placed modules are needed")) << presenter_.complaint().toStdString();
    presenter_.open(file("empty.stl", ""));
    ASSERT_TRUE(waitFor([&] { return isDone(); }));
    EXPECT_TRUE(presenter_.complaint().startsWith("This mesh can't be read: "));
    EXPECT_TRUE(presenter_.complaint().contains("empty.stl")) << presenter_.complaint().toStdString();
    EXPECT_FALSE(presenter_.hasSimulatedBody());
}

TEST_F(MeshPresenterTest, WhatIsShownStaysUntilTheNewBodyIsComparedWhoeverLooks) {
    open();
    presenter_.setActive(true);
    presenter_.open(file("body.stl", stlBytes(scaled(bodySurface(world_), 1e3))));
    ASSERT_TRUE(waitFor([&] { return presenter_.comparison() != nullptr; }));
    EXPECT_FALSE(presenter_.isStale());
    presenter_.setActive(false);
    const auto before = presenter_.comparison();
    bool wasGone = false;
    bool wasStale = false;
    QObject::connect(&presenter_, &MeshPresenter::changed, &presenter_, [&] {
        wasGone = wasGone || !presenter_.comparison();
        wasStale = wasStale || presenter_.isStale();
    });
    workbench_.session().decide("drop a pose", [](Decisions& decisions) { decisions.droppedPoses.insert(1); });
    ASSERT_TRUE(waitFor([&] { return presenter_.comparison() != before; }));
    EXPECT_FALSE(wasGone);
    EXPECT_TRUE(wasStale);
    EXPECT_TRUE(presenter_.comparison());
    EXPECT_FALSE(presenter_.isStale());
    // Without a body there is nothing to compare.
    workbench_.session().load({});
    EXPECT_FALSE(presenter_.comparison());
}

TEST(AlignmentDoubts, HaveASentenceEachWithItsNumber) {
    using Kind = AlignmentDoubt::Kind;
    std::set<QString> sentences;
    for (const Kind kind : {Kind::OtherPoseFits, Kind::Slides, Kind::OffsetUnknown, Kind::FewCovered, Kind::SizesDiffer,
                            Kind::FitsBadly, Kind::Unmatched}) {
        // Modules are counted, the rest is measured.
        const double value = kind == Kind::Unmatched ? 12 : 0.123;
        const QString sentence = MeshPresenter::sentenceOf({kind, value, 0.004});
        EXPECT_FALSE(sentence.contains("%1") || sentence.contains("%n"));
        EXPECT_TRUE(sentence.contains("12") || sentence.contains("1.2")) << sentence.toStdString();
        sentences.insert(sentence);
    }
    EXPECT_EQ(sentences.size(), 7U);
}

TEST(MeshComplaints, HaveASentenceEach) {
    std::set<QString> sentences;
    const std::vector<CalibrationError> errors{{ErrorCode::TooFewPoints, {{"found", 3}, {"needed", 8}}},
                                               {ErrorCode::NoConsensus, {}},
                                               {ErrorCode::DegeneratePoints, {}},
                                               {ErrorCode::NotFinite, {}},
                                               {ErrorCode::InvalidOptions, {}}};
    for (const CalibrationError& error : errors) {
        const QString sentence = MeshPresenter::sentenceOf(error);
        EXPECT_TRUE(sentence.endsWith('.') || sentence.endsWith('?')) << sentence.toStdString();
        EXPECT_FALSE(sentence.contains(QString::fromStdString(error.message()))) << sentence.toStdString();
        sentences.insert(sentence);
    }
    EXPECT_EQ(sentences.size(), errors.size());
    EXPECT_TRUE(MeshPresenter::sentenceOf(CalibrationError{ErrorCode::Cancelled, {}}).isEmpty());
}

}  // namespace
}  // namespace skincal
