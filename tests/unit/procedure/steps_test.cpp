#include "core/procedure/steps.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"

namespace skincal {
namespace {

using enum StepStatus;
using Reason = StepReason;

/// A calibration that is through.
Progress complete() {
    Progress p;
    p.hasSkin = true;
    p.neighbourLinks = 20;
    p.modules = 12;
    p.poses = 6;
    p.hasIntrinsics = true;
    p.hasPictures = true;
    p.views = 4;
    p.hasBody = true;
    p.patches = 3;
    p.patchesPlaced = 3;
    p.modulesPlaced = 12;
    p.isTrusted = true;
    p.isExported = true;
    p.isExportNewest = true;
    return p;
}

StepState stateOf(const StepStates& states, Step step) {
    return states.at(static_cast<std::size_t>(step));
}

/// What the step's state is where a complete calibration, or an empty one, has this changed.
struct StepRow {
    const char* what = "";
    Step step{};
    void (*change)(Progress&) = nullptr;
    StepState expected{};
    Progress from = complete();
};

TEST(Steps, HaveTheStatesOfTheTable) {
    const Progress empty;
    const StepRow table[] = {
        {"complete", Step::Connect, [](Progress&) {}, {Done, Reason::None}},
        {"empty", Step::Connect, [](Progress&) {}, {ToDo, Reason::None}, empty},
        {"lost", Step::Connect, [](Progress& p) { p.isSkinLost = true; }, {NeedsAttention, Reason::SkinLost}},
        {"cables", Step::Connect, [](Progress& p) { p.neighbourLinks = 0; }, {NeedsAttention, Reason::NoNeighbours}},
        {"one module", Step::Connect, [](Progress& p) { p.neighbourLinks = 0, p.modules = 1; }, {Done, Reason::None}},
        {"no module",
         Step::Connect,
         [](Progress& p) { p.neighbourLinks = p.modules = 0; },
         {NeedsAttention, Reason::NoNeighbours}},

        {"complete", Step::Pose, [](Progress&) {}, {Done, Reason::None}},
        {"empty", Step::Pose, [](Progress&) {}, {Blocked, Reason::NoSkin}, empty},
        {"none", Step::Pose, [](Progress& p) { p.poses = 0; }, {ToDo, Reason::NoPoses}},
        {"one", Step::Pose, [](Progress& p) { p.poses = 1; }, {InProgress, Reason::TooFewPoses}},
        {"two", Step::Pose, [](Progress& p) { p.poses = 2; }, {InProgress, Reason::TooFewPoses}},
        {"three", Step::Pose, [](Progress& p) { p.poses = 3; }, {Done, Reason::None}},
        {"alike", Step::Pose, [](Progress& p) { p.arePosesAlike = true; }, {NeedsAttention, Reason::PosesAlike}},
        {"two alike",
         Step::Pose,
         [](Progress& p) { p.poses = 2, p.arePosesAlike = true; },
         {InProgress, Reason::TooFewPoses}},
        {"lost before", Step::Pose, [](Progress& p) { p.poses = 0, p.isSkinLost = true; }, {Blocked, Reason::SkinLost}},
        {"lost alike",
         Step::Pose,
         [](Progress& p) { p.arePosesAlike = p.isSkinLost = true; },
         {Blocked, Reason::SkinLost}},
        {"lost after", Step::Pose, [](Progress& p) { p.isSkinLost = true; }, {Done, Reason::None}},

        {"complete", Step::Camera, [](Progress&) {}, {Done, Reason::None}},
        {"empty", Step::Camera, [](Progress&) {}, {ToDo, Reason::NoCamera}, empty},
        {"chosen", Step::Camera, [](Progress& p) { p.hasCamera = true; }, {ToDo, Reason::NoPictures}, empty},
        {"known and chosen",
         Step::Camera,
         [](Progress& p) { p.hasIntrinsics = p.hasCamera = true; },
         {ToDo, Reason::NoPictures},
         empty},
        {"runs", Step::Camera, [](Progress& p) { p.hasPictures = true; }, {InProgress, Reason::NoIntrinsics}, empty},
        {"lost", Step::Camera, [](Progress& p) { p.isCameraLost = true; }, {NeedsAttention, Reason::CameraLost}},
        {"known but off", Step::Camera, [](Progress& p) { p.hasIntrinsics = true; }, {ToDo, Reason::NoCamera}, empty},
        {"known and on",
         Step::Camera,
         [](Progress& p) { p.hasIntrinsics = p.hasPictures = true; },
         {Done, Reason::None},
         empty},
        {"off after scans", Step::Camera, [](Progress& p) { p.hasPictures = false; }, {Done, Reason::None}},

        {"complete", Step::Scan, [](Progress&) {}, {Done, Reason::None}},
        {"empty", Step::Scan, [](Progress&) {}, {Blocked, Reason::NoSkin}, empty},
        {"no camera yet", Step::Scan, [](Progress& p) { p.hasIntrinsics = false; }, {Blocked, Reason::NoIntrinsics}},
        {"none", Step::Scan, [](Progress& p) { p.views = 0; }, {ToDo, Reason::FirstView}},
        {"one", Step::Scan, [](Progress& p) { p.views = 1; }, {Done, Reason::None}},
        {"skin lost", Step::Scan, [](Progress& p) { p.views = 0, p.isSkinLost = true; }, {Blocked, Reason::SkinLost}},
        {"camera lost",
         Step::Scan,
         [](Progress& p) { p.views = 0, p.isCameraLost = true; },
         {Blocked, Reason::CameraLost}},
        {"camera off",
         Step::Scan,
         [](Progress& p) { p.views = 0, p.hasPictures = false; },
         {Blocked, Reason::NoCamera}},
        {"no picture yet",
         Step::Scan,
         [](Progress& p) { p.views = 0, p.hasCamera = true, p.hasPictures = false; },
         {Blocked, Reason::NoPictures}},
        {"lost after", Step::Scan, [](Progress& p) { p.isSkinLost = p.isCameraLost = true; }, {Done, Reason::None}},

        {"complete", Step::Views, [](Progress&) {}, {Done, Reason::None}},
        {"empty", Step::Views, [](Progress&) {}, {Blocked, Reason::NoViews}, empty},
        {"solving",
         Step::Views,
         [](Progress& p) { p.hasBody = false, p.isSolving = true; },
         {InProgress, Reason::Solving}},
        {"unsolved", Step::Views, [](Progress& p) { p.hasBody = false; }, {NeedsAttention, Reason::PatchesNotPlaced}},
        {"not solved",
         Step::Views,
         [](Progress& p) { p.hasBody = false, p.isUnsolved = true; },
         {NeedsAttention, Reason::NotSolved}},
        {"some placed", Step::Views, [](Progress& p) { p.patchesPlaced = 2; }, {InProgress, Reason::PatchesNotPlaced}},
        {"no module", Step::Views, [](Progress& p) { p.modulesPlaced = 0; }, {InProgress, Reason::PatchesNotPlaced}},

        {"complete", Step::Result, [](Progress&) {}, {Done, Reason::None}},
        {"empty", Step::Result, [](Progress&) {}, {Blocked, Reason::NoViews}, empty},
        {"solving",
         Step::Result,
         [](Progress& p) { p.hasBody = false, p.isSolving = true; },
         {Blocked, Reason::Solving}},
        {"unsolved", Step::Result, [](Progress& p) { p.hasBody = false; }, {Blocked, Reason::PatchesNotPlaced}},
        {"again", Step::Result, [](Progress& p) { p.isSolving = true; }, {InProgress, Reason::Solving}},
        {"not solved", Step::Result, [](Progress& p) { p.isUnsolved = true; }, {NeedsAttention, Reason::NotSolved}},
        {"none placed", Step::Result, [](Progress& p) { p.modulesPlaced = 0; }, {Blocked, Reason::PatchesNotPlaced}},
        {"doubtful", Step::Result, [](Progress& p) { p.isTrusted = false; }, {NeedsAttention, Reason::NotTrusted}},
        {"some placed",
         Step::Result,
         [](Progress& p) { p.modulesPlaced = 11; },
         {InProgress, Reason::ModulesNotPlaced}},

        {"complete", Step::Export, [](Progress&) {}, {Done, Reason::None}},
        {"empty", Step::Export, [](Progress&) {}, {Blocked, Reason::PatchesNotPlaced}, empty},
        {"none placed", Step::Export, [](Progress& p) { p.modulesPlaced = 0; }, {Blocked, Reason::PatchesNotPlaced}},
        {"not yet", Step::Export, [](Progress& p) { p.isExported = false; }, {ToDo, Reason::None}},
        {"changed", Step::Export, [](Progress& p) { p.isExportNewest = false; }, {NeedsAttention, Reason::Changed}},
        {"not solved", Step::Export, [](Progress& p) { p.isUnsolved = true; }, {NeedsAttention, Reason::Changed}},

        {"complete", Step::Demo, [](Progress&) {}, {ToDo, Reason::None}},
        {"empty", Step::Demo, [](Progress&) {}, {Blocked, Reason::PatchesNotPlaced}, empty},
        {"none placed", Step::Demo, [](Progress& p) { p.modulesPlaced = 0; }, {Blocked, Reason::PatchesNotPlaced}},
        {"no skin", Step::Demo, [](Progress& p) { p.hasSkin = false; }, {Blocked, Reason::NoSkin}},
        {"lost", Step::Demo, [](Progress& p) { p.isSkinLost = true; }, {Blocked, Reason::SkinLost}},
    };
    for (const StepRow& row : table) {
        Progress progress = row.from;
        row.change(progress);
        const StepState state = stateOf(stepStates(progress), row.step);
        const auto where = testing::Message() << "step " << static_cast<int>(row.step) << ", " << row.what;
        EXPECT_EQ(state.status, row.expected.status) << where;
        EXPECT_EQ(state.reason, row.expected.reason) << where;
    }
}

TEST(Steps, LeadThroughAWholeCalibration) {
    Progress p;
    const auto next = [&] { return nextStep(stepStates(p)); };
    EXPECT_EQ(next(), Step::Connect);
    p.hasSkin = true;
    p.modules = 12;
    p.neighbourLinks = 20;
    EXPECT_EQ(next(), Step::Pose);
    p.poses = 3;
    EXPECT_EQ(next(), Step::Camera);
    p.hasPictures = true;
    EXPECT_EQ(next(), Step::Camera);
    p.hasIntrinsics = true;
    EXPECT_EQ(next(), Step::Scan);
    p.views = 1;
    p.isSolving = true;
    EXPECT_EQ(next(), Step::Views);
    p.isSolving = false;
    p.hasBody = true;
    p.patches = 2;
    p.patchesPlaced = 1;
    p.modulesPlaced = 8;
    EXPECT_EQ(next(), Step::Views);
    p.patchesPlaced = 2;
    EXPECT_EQ(next(), Step::Result);
    p.isTrusted = true;
    EXPECT_EQ(next(), Step::Result);
    p.modulesPlaced = 12;
    EXPECT_EQ(next(), Step::Export);
    p.isExported = p.isExportNewest = true;
    EXPECT_EQ(next(), Step::Demo);
    p.isSkinLost = true;
    EXPECT_EQ(next(), Step::Connect);
}

Progress randomProgress(Random& random) {
    const auto coin = [&] { return random.uniform() < 0.5; };
    Progress p;
    p.hasSkin = random.uniform() < 0.8;
    p.isSkinLost = random.uniform() < 0.2;
    p.modules = random.index(4);
    p.neighbourLinks = p.modules < 2 ? 0 : random.index(3);
    p.poses = random.index(6);
    p.arePosesAlike = coin();
    p.hasIntrinsics = random.uniform() < 0.7;
    p.hasCamera = random.uniform() < 0.8;
    p.hasPictures = p.hasCamera && coin();
    p.isCameraLost = random.uniform() < 0.2;
    p.views = random.index(3);
    p.isSolving = coin();
    p.isUnsolved = !p.isSolving && coin();
    p.hasBody = coin();
    p.patches = random.index(3);
    p.patchesPlaced = random.index(p.patches + 1);
    p.modulesPlaced = random.index(p.modules + 1);
    p.isTrusted = coin();
    p.isExported = coin();
    p.isExportNewest = p.isExported && coin();
    return p;
}

TEST(Steps, AreNotDoneWhileWhatTheyNeedIsMissing) {
    Random random(1, "steps");
    std::array<int, kSteps.size()> done{};
    for (int run = 0; run < 20000; ++run) {
        const Progress p = randomProgress(random);
        const StepStates states = stepStates(p);
        const auto isDone = [&](Step step) { return stateOf(states, step).status == Done; };
        for (const Step step : kSteps)
            done.at(static_cast<std::size_t>(step)) += isDone(step) ? 1 : 0;
        EXPECT_TRUE(!isDone(Step::Connect) || (p.hasSkin && !p.isSkinLost && p.modules > 0));
        EXPECT_TRUE(!isDone(Step::Pose) || (p.hasSkin && p.poses >= 3 && !p.arePosesAlike));
        EXPECT_TRUE(!isDone(Step::Camera) || (p.hasIntrinsics && !p.isCameraLost));
        EXPECT_TRUE(!isDone(Step::Scan) || (p.hasSkin && p.hasIntrinsics && p.views > 0));
        EXPECT_TRUE(!isDone(Step::Views) ||
                    (p.views > 0 && p.hasBody && p.modulesPlaced > 0 && p.patchesPlaced == p.patches));
        EXPECT_TRUE(!isDone(Step::Result) || (p.hasBody && !p.isSolving && !p.isUnsolved && p.isTrusted &&
                                              p.modules > 0 && p.modulesPlaced == p.modules));
        EXPECT_TRUE(!isDone(Step::Export) ||
                    (p.hasBody && !p.isUnsolved && p.modulesPlaced > 0 && p.isExported && p.isExportNewest));
        EXPECT_FALSE(isDone(Step::Demo)) << "it can always be played with again";
        // What can be begun has what it needs, the devices included.
        const auto isOpen = [&](Step step) { return stateOf(states, step).status != Blocked && !isDone(step); };
        EXPECT_TRUE(!isOpen(Step::Pose) || (p.hasSkin && !p.isSkinLost));
        EXPECT_TRUE(!isOpen(Step::Scan) ||
                    (p.hasSkin && !p.isSkinLost && p.hasIntrinsics && p.hasPictures && !p.isCameraLost));
        EXPECT_TRUE(!isOpen(Step::Demo) || (p.hasSkin && !p.isSkinLost && p.hasBody));
    }
    for (const Step step : kSteps)
        EXPECT_TRUE(step == Step::Demo || done.at(static_cast<std::size_t>(step)) > 100);
}

TEST(Steps, HaveAReasonWhereSomethingIsWrong) {
    Random random(2, "reasons");
    for (int run = 0; run < 20000; ++run) {
        for (const StepState& state : stepStates(randomProgress(random))) {
            if (state.status == Blocked || state.status == NeedsAttention || state.status == InProgress) {
                EXPECT_NE(state.reason, Reason::None);
            }
            if (state.status == Done) {
                EXPECT_EQ(state.reason, Reason::None);
            }
        }
    }
}

TEST(Steps, TheNextOneIsTheFirstThatCanBeWorkedOn) {
    Random random(3, "next");
    for (int run = 0; run < 20000; ++run) {
        const StepStates states = stepStates(randomProgress(random));
        const Step next = nextStep(states);
        EXPECT_NE(stateOf(states, next).status, Blocked);
        EXPECT_NE(stateOf(states, next).status, Done) << "the demonstration never is";
        for (std::size_t i = 0; i < static_cast<std::size_t>(next); ++i)
            EXPECT_TRUE(states.at(i).status == Done || states.at(i).status == Blocked);
    }
    for (const StepStatus status : {Blocked, Done}) {
        StepStates states;
        states.fill({status, Reason::None});
        EXPECT_EQ(nextStep(states), Step::Export);
    }
}

}  // namespace
}  // namespace skincal
