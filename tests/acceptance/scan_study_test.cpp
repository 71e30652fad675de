#include "core/study/scan_study.h"

#include <gtest/gtest.h>

#include "core/vision/decoder.h"

namespace skincal::testing {
namespace {

/// The sum over some seeds of everything that the study has of a disturbance up to a strength (or down to a spacing).
ScanScore scoreUpTo(Disturbance disturbance, double strongest, std::size_t modules = 55,
                    ScanMethod method = ScanMethod::Coded) {
    ScanScore sum;
    for (const double strength : strengthsOf(disturbance)) {
        const bool isCrowding = disturbance == Disturbance::Crowding;
        if (isCrowding ? strength < strongest : strength > strongest)
            continue;
        for (std::uint64_t seed = 1; seed <= 2; ++seed)
            sum.add(scoreScan({disturbance, strength, modules, 0.8, method}, seed));
    }
    return sum;
}

struct Expectation {
    Disturbance disturbance;
    double strongest;
    double found;  ///< share at least
};

class ScansIn : public ::testing::TestWithParam<Expectation> {};

TEST_P(ScansIn, FindWhatIsVisibleAndNothingElse) {
    const ScanScore score = scoreUpTo(GetParam().disturbance, GetParam().strongest);
    EXPECT_GT(score.visible, 100U);
    EXPECT_EQ(score.wrong, 0U);
    EXPECT_GE(score.foundShare(), GetParam().found);
    // Centres are as good as they say.
    EXPECT_GT(score.rmsSigmas(), 0.7);
    EXPECT_LT(score.rmsSigmas(), 1.3);
}

INSTANTIATE_TEST_SUITE_P(
    Rooms, ScansIn,
    ::testing::Values(Expectation{Disturbance::None, 0, 0.995}, Expectation{Disturbance::Ambient, 240, 0.995},
                      Expectation{Disturbance::Reflection, 0.3, 0.995}, Expectation{Disturbance::Screen, 250, 0.995},
                      Expectation{Disturbance::Mains50, 100, 0.995}, Expectation{Disturbance::Mains60, 100, 0.995},
                      Expectation{Disturbance::Sun, 2, 0.995}, Expectation{Disturbance::Person, 1, 0.995},
                      Expectation{Disturbance::Exposure, 0.7, 0.995}, Expectation{Disturbance::Focus, 3.4, 0.995},
                      Expectation{Disturbance::Crowding, 3, 0.995}),
    [](const auto& what) { return std::string(name(what.param.disturbance)); });

TEST(ScanStudy, AKnockedCameraPutsNobodyElsewhere) {
    const ScanScore score = scoreUpTo(Disturbance::Bump, 20);
    EXPECT_EQ(score.wrong, 0U);
    for (const double knock : strengthsOf(Disturbance::Bump)) {
        if (knock <= DecoderOptions{}.maxMotion_px)
            continue;
        // Nothing is taken from a look in which it moved by more than a pixel; the next one finds what there is.
        EXPECT_EQ(scoreScan({Disturbance::Bump, knock, 55, 0.8, ScanMethod::CodedOnce}, 1).found, 0U) << knock;
        EXPECT_GE(scoreScan({Disturbance::Bump, knock, 55, 0.8, ScanMethod::Coded}, 1).foundShare(), 0.98) << knock;
    }
}

TEST(ScanStudy, FurtherLooksTellLedsApartThatOneCannot) {
    for (const auto& [apart, atLeast] : {std::pair(3.0, 0.995), std::pair(2.0, 0.98)}) {
        ScanScore once;
        ScanScore again;
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            once.add(scoreScan({Disturbance::Crowding, apart, 55, 0.8, ScanMethod::CodedOnce}, seed));
            again.add(scoreScan({Disturbance::Crowding, apart, 55, 0.8, ScanMethod::Coded}, seed));
        }
        EXPECT_EQ(again.wrong, 0U);
        EXPECT_LT(once.foundShare(), 0.9);
        EXPECT_GE(again.foundShare(), atLeast);
        std::cout << "LEDs " << apart << " px apart: " << 100 * once.foundShare() << " % found in one look, "
                  << 100 * again.foundShare() << " % in several, of " << again.frames / again.views << " pictures\n";
    }
}

TEST(ScanStudy, WhereNothingIsOpenThereIsOneLook) {
    for (const Disturbance room : {Disturbance::None, Disturbance::Screen, Disturbance::Mains60}) {
        const double strength = strengthsOf(room)[strengthsOf(room).size() / 2];
        const ScanScore once = scoreScan({room, strength, 55, 0.8, ScanMethod::CodedOnce}, 1);
        const ScanScore again = scoreScan({room, strength, 55, 0.8, ScanMethod::Coded}, 1);
        EXPECT_EQ(again.frames, once.frames) << name(room);
    }
}

TEST(ScanStudy, AKnockOfHalfAPixelOnlyWidensSigma) {
    const ScanScore still = scoreUpTo(Disturbance::None, 0);
    const ScanScore knocked = scoreUpTo(Disturbance::Bump, 0.5);
    EXPECT_EQ(knocked.wrong, 0U);
    EXPECT_GE(knocked.found, still.found * 995 / 1000);
    EXPECT_LT(knocked.rmsSigmas(), 1.3);
    EXPECT_GT(knocked.rms_px(), still.rms_px());
}

TEST(ScanStudy, AMirrorLeavesAChoiceThatTheBodyMakes) {
    const ScanScore score = scoreUpTo(Disturbance::Reflection, 0.9);
    EXPECT_EQ(score.wrong, 0U);
    ASSERT_GT(score.visible, 100U);
    EXPECT_LT(score.found, score.visible / 2) << "the picture can't tell";
    EXPECT_GE(score.foundShare(), 0.995);
}

TEST(ScanStudy, AMirrorThatShowsWhatTheCameraDoesNotSeePutsNobodyElsewhere) {
    for (const ScanMethod method : {ScanMethod::Coded, ScanMethod::OneAtATime}) {
        const ScanScore dull = scoreUpTo(Disturbance::Hidden, 0.3, 55, method);
        EXPECT_EQ(dull.wrong, 0U);
        EXPECT_GT(dull.visible, 90U);
        EXPECT_GE(dull.foundShare(), 0.995);
        const ScanScore bright = scoreUpTo(Disturbance::Hidden, 0.9, 55, method);
        EXPECT_EQ(bright.wrong, 0U);
        EXPECT_GE(bright.foundShare(), 0.995);
    }
}

TEST(ScanStudy, SomebodyWhoWalksPastIsNobodysLed) {
    const ScanScore score = scoreUpTo(Disturbance::Person, 1, 55, ScanMethod::OneAtATime);
    EXPECT_EQ(score.wrong, 0U) << "words of a single picture, which a flash can be taken for";
    EXPECT_GE(score.foundShare(), 0.75);
}

TEST(ScanStudy, WhatCannotBeSeenIsNotFoundElsewhere) {
    EXPECT_EQ(scoreUpTo(Disturbance::Ambient, 300).wrong, 0U);
}

// Seeds in which lamps that go black between their flashes were once taken for other modules, or for a camera that is
// late.
TEST(ScanStudy, ALampThatGoesBlackIsNeitherALedNorALateCamera) {
    ScanScore score;
    for (const std::uint64_t seed : {8, 20, 27, 51, 56})
        score.add(scoreScan({Disturbance::Mains50, 100, 55, 0.8, ScanMethod::Coded}, seed));
    EXPECT_EQ(score.wrong, 0U);
    EXPECT_EQ(score.refused, 0U);
    EXPECT_GE(score.foundShare(), 0.995);
}

TEST(ScanStudy, AThousandModulesInOnePicture) {
    const ScanScore score = scoreScan({Disturbance::None, 0, 1000, 0.8, ScanMethod::Coded}, 1);
    EXPECT_LE(score.frames, 32U);
    EXPECT_GT(score.visible, 950U);
    EXPECT_GE(score.foundShare(), 0.995);
    EXPECT_EQ(score.wrong, 0U);
}

TEST(ScanStudy, CodedScansFindWhatThePapersScanLosesToAScreen) {
    const ScanScore paper = scoreUpTo(Disturbance::Screen, 250, 7, ScanMethod::PaperSingle);
    const ScanScore coded = scoreUpTo(Disturbance::Screen, 250, 7);
    EXPECT_LT(paper.foundShare(), 0.5);
    EXPECT_GE(coded.foundShare(), 0.995);
}

TEST(ScanStudy, ComparesThePapersScanWithTheBoundThoughItSkipsPictures) {
    const ScanScore paper = scoreUpTo(Disturbance::Ambient, 0, 7, ScanMethod::PaperSingle);
    EXPECT_GT(paper.found, 0U);
    EXPECT_EQ(paper.wrong, 0U);
}

TEST(ScanStudy, ScansBesideEachOtherSumUpAsOneAfterTheOther) {
    ScanStudyOptions options;
    options.seeds = 3;
    options.firstSeed = 4;
    options.cases = {{Disturbance::Screen, 60, 7, 0.8, ScanMethod::Coded},
                     {Disturbance::Sun, 0.3, 7, 0.8, ScanMethod::Coded}};
    const ScanStudy study = runScanStudy(options);
    ASSERT_EQ(study.rows.size(), options.cases.size());
    EXPECT_FALSE(study.cancelled);
    for (std::size_t k = 0; k < options.cases.size(); ++k) {
        ScanScore sum;
        for (std::uint64_t seed = 4; seed < 7; ++seed)
            sum.add(scoreScan(options.cases[k], seed));
        EXPECT_EQ(study.rows[k].score.views, 3U);
        EXPECT_EQ(study.rows[k].score.frames, sum.frames);
        EXPECT_EQ(study.rows[k].score.found, sum.found);
        EXPECT_EQ(study.rows[k].score.squaredError, sum.squaredError);
        EXPECT_EQ(study.rows[k].score.squaredSigmas, sum.squaredSigmas);
    }
}

TEST(ScanStudy, EndsWhereItIsCancelled) {
    ScanStudyOptions options;
    options.seeds = 1000;
    options.cases = {{Disturbance::None, 0, 7, 0.8, ScanMethod::Coded}};
    RunContext context;
    int asked = 0;
    context.isCancelled = [&] { return ++asked > 5; };
    const ScanStudy study = runScanStudy(options, context);
    EXPECT_TRUE(study.cancelled);
    EXPECT_TRUE(study.rows.empty());
}

TEST(ScanStudy, TablesAndPlotsNameEveryCase) {
    ScanStudyOptions options;
    options.seeds = 1;
    options.cases = {{Disturbance::Sun, 0.1, 7, 0.8, ScanMethod::Coded},
                     {Disturbance::Sun, 0.3, 7, 0.8, ScanMethod::Coded},
                     {Disturbance::Sun, 0.3, 7, 0.8, ScanMethod::PaperSingle}};
    const ScanStudy study = runScanStudy(options);
    ASSERT_EQ(study.rows.size(), 3U);
    const std::string table = scanTable(study);
    EXPECT_NE(table.find("| sun | 0.3 | 7 | 0.8 | paper |"), std::string::npos) << table;
    const std::string plot = scanPlot(study);
    EXPECT_EQ(plot.rfind("<svg", 0), 0U);
    EXPECT_NE(plot.find(">sun<"), std::string::npos);
    EXPECT_THROW((void)runScanStudy({}), std::logic_error);
    EXPECT_EQ(findDisturbance("sun"), Disturbance::Sun);
    EXPECT_FALSE(findDisturbance("rain"));
}

}  // namespace
}  // namespace skincal::testing
