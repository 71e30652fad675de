// What a report says of modules that were not found.

#include "ui/presenters/report_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skincal {
namespace {

using ::testing::ElementsAre;
using Cause = Undetected::Cause;

Undetected missing(std::uint32_t module, Cause cause, double margin = 0) {
    Undetected one{ModuleId{module}, DetectionVerdict::Ambiguous, Sentence::verbatim("why"), {}, cause};
    if (cause != Cause::OutOfSight && cause != Cause::NeverBlinked)
        one.nearest = NearestSpot{{100, 50}, WordReading{2, false, {0}, {0}, {}, 9, margin}};
    return one;
}

ReportedScan reported(const std::vector<Undetected>& undetected, const Decisions& decisions = {}) {
    ScannedView view;
    view.name = "view";
    view.decoded.undetected = undetected;
    Measured measured;
    measured.views = {view};
    ReportFacts facts;
    addData(facts, measured, decisions, 100);
    return facts.scans.at(0);
}

TEST(ReportFacts, WhatIsOutOfSightIsListedAndNothingElse) {
    const ReportedScan scan = reported({missing(9, Cause::OutOfSight), missing(7, Cause::NeverBlinked),
                                        missing(4, Cause::OutOfSight), missing(5, Cause::NotAnLed, 30)});
    EXPECT_THAT(scan.unseen, ElementsAre(ModuleId{4}, ModuleId{9}));
    ASSERT_EQ(scan.detections.size(), 2U);
    EXPECT_EQ(scan.detections[0].module, ModuleId{5});
    EXPECT_EQ(scan.detections[0].pixel, Vector2d(100, 50));
    EXPECT_EQ(scan.detections[0].sigma_px, 0);
    EXPECT_EQ(scan.detections[0].reading->margin, 30);
    EXPECT_EQ(scan.detections[1].module, ModuleId{7}) << "it was never lit: nothing could blink like it";
    EXPECT_FALSE(scan.detections[1].pixel);
    EXPECT_EQ(scan.detections[1].whyNot, "why");
}

TEST(ReportFacts, OfSeveralSpotsAllAreThere) {
    Undetected two = missing(3, Cause::Reflected, 300);
    two.spots = {{{100.25, 50.5}, 0.02, 1, {}}, {{100.5, 90.5}, 0.04, 0.6, {}}};
    const ReportedScan scan = reported({two});
    ASSERT_EQ(scan.detections.size(), 1U);
    EXPECT_EQ(scan.detections[0].pixel, Vector2d(100.25, 50.5));
    EXPECT_EQ(scan.detections[0].sigma_px, 0.02);
    EXPECT_EQ(scan.detections[0].choices.size(), 2U);
    EXPECT_FALSE(scan.detections[0].isRejected);
    Decisions decisions;
    decisions.detections[{"view", ModuleId{3}}] = {"view", ModuleId{3}, "rejected", ""};
    EXPECT_TRUE(reported({two}, decisions).detections.at(0).isRejected);
}

}  // namespace
}  // namespace skincal
