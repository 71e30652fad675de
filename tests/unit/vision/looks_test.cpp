#include "core/vision/looks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/geometry/random.h"
#include "core/vision/decoder.h"
#include "core/vision/further_looks.h"

namespace skincal {
namespace {

using testing::ElementsAre;
using Cause = Undetected::Cause;

std::vector<ModuleId> numbered(std::size_t count, std::uint32_t first = 1) {
    std::vector<ModuleId> modules;
    for (std::size_t i = 0; i < count; ++i)
        modules.push_back(ModuleId{static_cast<std::uint32_t>(first + i)});
    return modules;
}

void append(std::vector<FrameInfo>& frames, const LitSets& scan, std::size_t look = 0) {
    for (const auto& lit : scan)
        frames.push_back({{}, lit, {}, look});
}

TEST(Looks, FollowEachOther) {
    std::vector<FrameInfo> frames;
    append(frames, codedScan(numbered(9), 1));
    EXPECT_THAT(beginningsOfLooks(frames), ElementsAre(0U));
    const std::size_t first = frames.size();
    append(frames, codedScan(numbered(1), 2), 1);
    const std::size_t second = frames.size();
    append(frames, codedScan(numbered(9), 3), 4);
    EXPECT_THAT(beginningsOfLooks(frames), ElementsAre(0U, first, second));
    EXPECT_EQ(modulesLitIn(std::span(frames).subspan(first, second - first)), numbered(1));
    EXPECT_THAT(beginningsOfLooks({}), ElementsAre(0U));
}

TEST(Looks, ModulesThatTheSkinHasNotAreAnErrorInAnyLook) {
    std::vector<FrameInfo> frames;
    append(frames, codedScan(numbered(9), 1), 1);
    const FrameLoader load = [](std::size_t) -> tl::expected<cv::Mat, std::string> {
        return tl::unexpected(std::string("no picture"));
    };
    const auto known = numbered(9);
    EXPECT_EQ(decodeFurther({}, 0, known, frames, load).error().message, "no picture");
    const auto fewer = numbered(8);
    EXPECT_THAT(decodeFurther({}, 0, fewer, frames, load).error().message, testing::HasSubstr("9"));
}

LedDetection at(std::uint32_t module, double x, double y) {
    return {ModuleId{module}, {x, y}, 0.03};
}

Undetected missing(std::uint32_t module, Cause cause = Cause::OutOfSight) {
    return {ModuleId{module}, DetectionVerdict::NotFound, Sentence::verbatim("before"), {}, cause};
}

TEST(Looks, AFurtherOneAddsWhatItFoundInThePixelsOfTheFirst) {
    ViewDetections view;
    view.found = {at(1, 100, 100), at(2, 200, 100), at(3, 300, 300)};
    view.readings.resize(3);
    view.undetected = {missing(4), missing(5, Cause::NotAnLed), missing(6)};
    ViewDetections further;
    // The camera has moved by 0.3 px; one anchor is off.
    further.found = {at(1, 100.3, 100), at(2, 207, 100), at(3, 300.3, 300), at(5, 150.3, 250)};
    further.readings.resize(4);
    further.readings[3].sent = {1, 2};
    further.undetected = {missing(4, Cause::TooWeak), missing(6)};
    further.undetected[0].reason = Sentence::verbatim("now");
    further.undetected[0].nearest = NearestSpot{{40.3, 50}, {}};
    further.unexplained = 2;
    EXPECT_TRUE(addLook(view, further));
    sortAs(numbered(6), view);
    ASSERT_EQ(view.found.size(), 4U);
    EXPECT_EQ(view.found[1].pixel, Vector2d(200, 100)) << "what was found before stays";
    EXPECT_EQ(view.found[3].module, ModuleId{5});
    EXPECT_LT((view.found[3].pixel - Vector2d(150, 250)).norm(), 1e-9);
    EXPECT_NEAR(view.found[3].sigma_px, std::hypot(0.03, 0.15), 1e-9);
    EXPECT_THAT(view.readings[3].sent, ElementsAre(1, 2));
    EXPECT_NEAR(view.moved_px.value(), 0.3, 1e-9);
    EXPECT_EQ(view.unexplained, 2U);
    ASSERT_EQ(view.undetected.size(), 2U);
    EXPECT_EQ(view.undetected[0].reason, "now");
    ASSERT_TRUE(view.undetected[0].nearest);
    EXPECT_LT((view.undetected[0].nearest->pixel - Vector2d(40, 50)).norm(), 1e-9);
    EXPECT_EQ(view.undetected[1].reason, "before");
}

TEST(Looks, AfterAKnockAFurtherOneCountsForNothing) {
    ViewDetections view;
    view.found = {at(1, 100, 100), at(2, 200, 100), at(3, 300, 300)};
    view.undetected = {missing(4)};
    ViewDetections further;
    further.found = {at(1, 102, 100), at(2, 202, 100), at(3, 302, 300), at(4, 10, 10)};
    EXPECT_FALSE(addLook(view, further));
    EXPECT_EQ(view.found.size(), 3U);
    EXPECT_EQ(view.undetected.size(), 1U);
    EXPECT_NEAR(view.moved_px.value(), 2, 1e-9) << "who goes on must know";
    view.unexplained = 1;
    EXPECT_FALSE(FurtherLooks(1).next(view));
}

TEST(Looks, SpotsToChooseFromAreNotMixedWithThoseOfACameraThatMayStandElsewhere) {
    ViewDetections view;
    view.undetected = {missing(1, Cause::Reflected), missing(2)};
    view.undetected[0].spots.resize(1);
    ViewDetections further;
    further.found = {at(2, 300, 100)};
    further.look = 1;
    EXPECT_FALSE(addLook(view, further));
    EXPECT_TRUE(view.found.empty());
    EXPECT_EQ(view.look, 0U);
    EXPECT_EQ(view.undetected[0].spots.size(), 1U);
    view.unexplained = 3;
    EXPECT_FALSE(FurtherLooks(1).next(view)) << "it would be of no use";
}

TEST(Looks, OneThatFindsNobodyAgainCannotTellWhereItsCameraStood) {
    ViewDetections view;
    view.found = {at(1, 100, 100)};
    view.undetected = {missing(2)};
    ViewDetections further;
    further.found = {at(2, 300, 100)};
    EXPECT_FALSE(addLook(view, further));
    EXPECT_EQ(view.found.size(), 1U);
    further.found.push_back(at(1, 100.4, 100));
    EXPECT_TRUE(addLook(view, further)) << "one is enough";
    ASSERT_EQ(view.found.size(), 2U);
    EXPECT_NEAR(view.found[1].pixel.x(), 299.6, 1e-9);
}

TEST(Looks, SpotsThatAreHandedOnAreInThePixelsOfTheFirst) {
    ViewDetections view;
    view.found = {at(1, 100, 100)};
    view.undetected = {missing(2)};
    ViewDetections further;
    further.found = {at(1, 100.4, 100)};
    further.undetected = {missing(2, Cause::Reflected)};
    further.undetected[0].spots = {{{50.4, 60}, 0.03, 1}, {{80.4, 60}, 0.03, 0.7}};
    EXPECT_TRUE(addLook(view, further));
    ASSERT_EQ(view.undetected[0].spots.size(), 2U);
    EXPECT_NEAR(view.undetected[0].spots[1].pixel.x(), 80, 1e-9);
    EXPECT_NEAR(view.undetected[0].spots[1].sigma_px, std::hypot(0.03, 0.2), 1e-9);
}

TEST(Looks, SpotsToChooseFromAreMoreThanAReasonWhyThereAreNone) {
    ViewDetections view;
    view.found = {at(1, 100, 100)};
    view.undetected = {missing(2, Cause::TooBright), missing(3, Cause::Reflected), missing(4, Cause::NotAnLed)};
    view.undetected[1].spots = {{{20, 20}, 0.03, 1}};
    ViewDetections further;
    further.found = {at(1, 100, 100)};
    for (const std::uint32_t module : {2U, 3U}) {
        further.undetected.push_back(missing(module, Cause::Reflected));
        further.undetected.back().spots = {{{50, 60}, 0.03, 1}, {{80, 60}, 0.03, 0.7}};
    }
    further.undetected.push_back(missing(4, Cause::TooWeak));
    EXPECT_TRUE(addLook(view, further));
    ASSERT_EQ(view.undetected.size(), 3U);
    EXPECT_EQ(view.undetected[0].spots.size(), 2U);
    EXPECT_EQ(view.undetected[1].spots.size(), 1U) << "what was handed on before stays";
    EXPECT_EQ(view.undetected[2].cause, Cause::NotAnLed);
}

TEST(Looks, ACameraThatStandsStillIsNotMovedByErrors) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed, "anchors");
        ViewDetections view;
        ViewDetections further;
        for (std::uint32_t module = 1; module <= 4; ++module) {
            view.found.push_back(at(module, 100.0 * module, 50));
            // They say 0.03 px, and are off by ten times as much.
            further.found.push_back(at(module, 100.0 * module + 0.3 * random.normal(), 50 + 0.3 * random.normal()));
        }
        view.undetected = {missing(9)};
        further.found.push_back(at(9, 300, 200));
        ASSERT_TRUE(addLook(view, further));
        ASSERT_EQ(view.found.size(), 5U);
        EXPECT_EQ(view.found.back().pixel, Vector2d(300, 200)) << "seed " << seed;
        EXPECT_NEAR(view.found.back().sigma_px, std::hypot(0.03, 0.5 * view.moved_px.value()), 1e-9)
            << "it may have moved all the same, seed " << seed;
    }
}

TEST(Looks, WhatAKnockSpoiltAltogetherIsFoundByTheNext) {
    ViewDetections view;
    view.moved_px = 6;
    view.undetected = {missing(1, Cause::CameraMoved), missing(2, Cause::CameraMoved)};
    ViewDetections further;
    further.found = {at(1, 102, 100)};
    further.undetected = {missing(2)};
    further.moved_px = 0;
    further.look = 1;
    EXPECT_TRUE(addLook(view, further));
    EXPECT_EQ(view.look, 1U);
    EXPECT_EQ(view.found.size(), 1U);
    EXPECT_EQ(view.moved_px, 0) << "nothing is left of the pictures before the knock";
    EXPECT_EQ(view.undetected.front().cause, Cause::OutOfSight);
}

TEST(Looks, TwoModulesAreNotInOnePlace) {
    ViewDetections view;
    view.found = {at(1, 100, 100)};
    view.undetected = {missing(2)};
    ViewDetections further;
    further.found = {at(1, 100, 100), at(2, 101, 100)};
    EXPECT_TRUE(addLook(view, further));
    EXPECT_EQ(view.found.size(), 1U);
    ASSERT_EQ(view.undetected.size(), 1U);
    EXPECT_EQ(view.undetected[0].verdict, DetectionVerdict::Ambiguous);
    EXPECT_THAT(view.undetected[0].reason, testing::HasSubstr("module 1"));
}

/// A crowd in which an LED is told from others where none of the neighbours within `reach` shines with it.
class Crowd {
  public:
    Crowd(std::size_t modules, std::size_t reach, std::uint64_t seed) : reach_(reach) {
        Random random(seed, "crowd");
        for (std::size_t i = 0; i < modules; ++i)
            isVisible_.push_back(random.uniform() < 0.7);
        view.name = "view0";
    }
    void look(const LitSets& scan) {
        std::set<std::size_t> shining;
        for (const auto& lit : scan) {
            for (const LitModule& one : lit) {
                if (isVisible_[one.module.value])
                    shining.insert(one.module.value);
            }
        }
        view.unexplained = 0;
        std::set<ModuleId> found;
        for (const LedDetection& before : view.found)
            found.insert(before.module);
        for (const std::size_t u : shining) {
            bool isAlone = true;
            for (std::size_t v = u - std::min(u, reach_); v <= u + reach_; ++v)
                isAlone = isAlone && (v == u || !shining.contains(v));
            const ModuleId module{static_cast<std::uint32_t>(u)};
            if (isAlone && found.insert(module).second)
                view.found.push_back(at(module.value, 20.0 * static_cast<double>(u), 0));
            else if (!found.contains(module))
                ++view.unexplained;
        }
        view.undetected.clear();
        for (std::size_t u = 0; u < isVisible_.size(); ++u) {
            if (const ModuleId module{static_cast<std::uint32_t>(u)}; !found.contains(module))
                view.undetected.push_back(missing(module.value));
        }
    }
    [[nodiscard]] std::size_t visible() const {
        return static_cast<std::size_t>(std::count(isVisible_.begin(), isVisible_.end(), true));
    }
    ViewDetections view;

  private:
    std::vector<bool> isVisible_;
    std::size_t reach_;
};

std::vector<ModuleId> litIn(const LitSets& look) {
    std::vector<FrameInfo> frames;
    append(frames, look);
    return modulesLitIn(frames);
}

TEST(FurtherLooks, GoOnUntilAllAreFoundOrOutOfSight) {
    for (const std::size_t reach : {0U, 1U, 3U, 8U}) {
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            Crowd crowd(80, reach, seed);
            FurtherLookOptions options;
            options.maxFrames = 2000;
            options.anchors = 1;
            FurtherLooks further(seed, options);
            crowd.look(codedScan(numbered(80, 0), 0));
            std::size_t looks = 0;
            while (const auto look = further.next(crowd.view)) {
                ASSERT_LT(++looks, 100U);
                const auto lit = litIn(*look);
                for (const ModuleId module : further.wanted())
                    EXPECT_THAT(lit, testing::Contains(module));
                crowd.look(*look);
            }
            EXPECT_TRUE(further.wanted().empty());
            EXPECT_GE(crowd.view.found.size(), 0.97 * static_cast<double>(crowd.visible()))
                << "reach " << reach << " seed " << seed;
            EXPECT_TRUE(reach > 0 || looks == 0) << "nothing was left to explain";
        }
    }
}

// Thirty that are looked for at once in vain: in each other's light if it is seen, else behind something.
TEST(FurtherLooks, GoOnWithFewerWhereLightOfAllIsSeen) {
    for (const Cause cause : {Cause::NotAnLed, Cause::OutOfSight}) {
        ViewDetections view;
        for (std::uint32_t module = 0; module < 40; ++module)
            view.found.push_back(at(module, 20.0 * module, 10));
        for (std::uint32_t module = 40; module < 70; ++module)
            view.undetected.push_back(missing(module, cause));
        view.unexplained = 30;
        FurtherLooks further(1);
        ASSERT_TRUE(further.next(view));
        EXPECT_EQ(further.wanted().size(), 30U);
        EXPECT_EQ(further.next(view).has_value(), cause == Cause::NotAnLed);
        EXPECT_LT(further.wanted().size(), 10U);
    }
}

TEST(FurtherLooks, TakeNoMorePicturesThanAreAllowed) {
    Crowd crowd(400, 30, 1);
    FurtherLookOptions options;
    options.maxFrames = 100;
    FurtherLooks further(1, options);
    crowd.look(codedScan(numbered(400, 0), 0));
    std::size_t frames = 0;
    while (const auto look = further.next(crowd.view)) {
        frames += look->size();
        crowd.look(*look);
    }
    EXPECT_GT(frames, 0U);
    EXPECT_LE(frames, 100U);
}

TEST(FurtherLooks, LightSomeThatWereFoundSoThatAKnockShows) {
    ViewDetections view;
    for (std::uint32_t module = 0; module < 40; ++module)
        view.found.push_back(at(module, 10.0 * module, 5.0 * (module % 7)));
    view.undetected = {missing(50), missing(51)};
    view.unexplained = 1;
    FurtherLooks further(1);
    const auto look = further.next(view);
    ASSERT_TRUE(look);
    const auto lit = litIn(*look);
    EXPECT_EQ(lit.size(), FurtherLookOptions{}.anchors + 2);
    EXPECT_THAT(lit, testing::Contains(ModuleId{0}));
    EXPECT_THAT(lit, testing::Contains(ModuleId{39})) << "the ends are farthest apart";
}

TEST(FurtherLooks, FollowAKnockThoughNothingElseIsUnexplained) {
    ViewDetections view;
    view.moved_px = 3;
    for (std::uint32_t module = 0; module < 20; ++module)
        view.undetected.push_back(missing(module, Cause::CameraMoved));
    FurtherLooks further(1);
    const auto look = further.next(view);
    ASSERT_TRUE(look);
    EXPECT_EQ(litIn(*look).size(), 20U) << "all of them: they were not too many for each other";
}

TEST(FurtherLooks, SpotsThatWereHandedOnAreLeftToTheBody) {
    ViewDetections view;
    view.found = {at(1, 0, 0)};
    view.undetected = {missing(2, Cause::Reflected)};
    view.undetected[0].spots.resize(2);
    view.unexplained = 3;
    EXPECT_FALSE(FurtherLooks(1).next(view));
    FurtherLookOptions options;
    options.anchors = 101;
    EXPECT_THROW(FurtherLooks(1, options), std::logic_error);
}

}  // namespace
}  // namespace skincal
