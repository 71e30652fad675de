#include "core/procedure/light_timing.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "core/procedure/light_stream.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using Time = LightTiming::Time;

Time between(Random& random, Time low, Time high) {
    return low + Time(static_cast<Time::rep>(random.uniform() * static_cast<double>((high - low).count())));
}

/// A camera whose pictures of time t are exposed from t - latency on, for a while.
struct Camera {
    Time period = 33'333us;
    Time latency = 80ms;
    Time exposed = 0ms;  ///< from the beginning of the first row to the end of the last
    Time jitter = 0ms;   ///< times are off by as much, this way or that
    double dropped = 0;

    /// @param commanded  the LEDs change within `latch`, are acknowledged within `answer`
    [[nodiscard]] LightToggle watch(Random& random, Time commanded, Time latch, Time answer) const {
        LightToggle toggle;
        toggle.commanded = commanded;
        const Time changed = between(random, commanded, commanded + latch);
        toggle.acknowledged = between(random, changed, commanded + answer);
        int whole = 0;
        for (Time begin = commanded - period - commanded % period - latency; whole < 2; begin += period) {
            if (!toggle.pictures.empty() && random.uniform() < dropped)
                continue;
            const Time shown = std::clamp(begin + exposed - changed, 0us, std::max(exposed, 1us));
            const double share =
                static_cast<double>(shown.count()) / static_cast<double>(std::max(exposed, 1us).count());
            const Time time = begin + latency + between(random, -jitter, jitter);
            toggle.pictures.push_back({time, share});
            whole += share == 1 ? 1 : 0;
        }
        return toggle;
    }
    [[nodiscard]] std::vector<LightToggle> watch(Random& random, int toggles, Time latch, Time answer) const {
        std::vector<LightToggle> all;
        for (int k = 0; k < toggles; ++k)
            all.push_back(watch(random, 100s + k * (30 * period + period / toggles), latch, answer));
        return all;
    }
};

TEST(LightTiming, FindsTheLatencyOfAnyCamera) {
    Random random(1, "latency");
    for (int run = 0; run < 2000; ++run) {
        Camera camera;
        camera.period = between(random, 8ms, 70ms);
        camera.latency = between(random, 20ms, 250ms);
        camera.exposed = between(random, 0ms, std::min(camera.latency, camera.period));
        camera.dropped = run % 2 == 0 ? 0 : 0.05;
        const auto toggles = camera.watch(random, 3, 2ms, 6ms);
        const auto timing = estimateLightTiming(toggles);
        ASSERT_TRUE(timing);
        EXPECT_EQ(timing->jitter, 0us);
        // LEDs that change as late as they are acknowledged, or as early as they are commanded, are bounded, too.
        EXPECT_GE(timing->newFrom + 1us, camera.latency - camera.exposed / 20);
        EXPECT_LE(timing->oldUntil, camera.latency - camera.exposed + camera.exposed / 20 + 1us);
        EXPECT_LE(std::chrono::abs(timing->latency - camera.latency), timing->uncertainty + camera.exposed / 20 + 1us);
        if (camera.dropped == 0) {
            EXPECT_LE(timing->uncertainty, camera.period / 6 + 4ms);
            EXPECT_NEAR(static_cast<double>(timing->period.count()), static_cast<double>(camera.period.count()), 2);
        }
    }
}

TEST(LightTiming, TellsJitterWhereTogglesContradictEachOther) {
    Random random(2, "jitter");
    for (int run = 0; run < 200; ++run) {
        Camera early;
        early.latency = between(random, 50ms, 100ms);
        Camera late = early;
        const Time jitter = between(random, 15ms, 45ms);
        late.latency += jitter;
        auto toggles = early.watch(random, 12, 0ms, 1ms);
        const auto more = late.watch(random, 12, 0ms, 1ms);
        toggles.insert(toggles.end(), more.begin(), more.end());
        const auto timing = estimateLightTiming(toggles);
        ASSERT_TRUE(timing);
        EXPECT_GT(timing->jitter, 0us);
        EXPECT_LE(timing->jitter, jitter);
        EXPECT_GE(timing->jitter, jitter - 8ms);
        // As exact as twelve toggles in a period can be.
        EXPECT_GE(timing->newFrom, late.latency - early.period / 12 - 2ms);
        EXPECT_LE(timing->oldUntil, early.latency + early.period / 12 + 2ms);
    }
}

TEST(LightTiming, TellsJitterOfThePicturesTimes) {
    Random random(7, "unsteady");
    for (int run = 0; run < 200; ++run) {
        Camera camera;
        camera.jitter = between(random, 2ms, 8ms);
        camera.dropped = 0.05;
        const auto timing = estimateLightTiming(camera.watch(random, 3, 0ms, 2ms));
        ASSERT_TRUE(timing);
        EXPECT_GT(timing->jitter, camera.jitter / 4);
        EXPECT_LE(timing->jitter, 4 * camera.jitter);
    }
}

TEST(LightTiming, SaysWhatItCouldNotDo) {
    Random random(3, "failures");
    const Camera camera;
    auto toggles = camera.watch(random, 3, 1ms, 2ms);
    toggles[1].pictures.back().share = 0.5;
    EXPECT_EQ(estimateLightTiming(toggles).error(), LightTimingError::NoChange);
    toggles = camera.watch(random, 3, 1ms, 2ms);
    for (auto& picture : toggles[2].pictures)
        picture.share = 1;
    EXPECT_EQ(estimateLightTiming(toggles).error(), LightTimingError::NoChange);
    toggles = camera.watch(random, 3, 1ms, 2ms);
    for (auto& picture : toggles[2].pictures)
        picture.time += 100ms;
    EXPECT_EQ(estimateLightTiming(toggles).error(), LightTimingError::TooJittery);

    const auto refused = [](const std::vector<LightToggle>& some, const LightTimingOptions& options = {}) {
        EXPECT_THROW(std::ignore = estimateLightTiming(some, options), std::logic_error);
    };
    const auto good = camera.watch(random, 3, 1ms, 2ms);
    refused({good.front()});
    auto bad = good;
    bad[0].pictures.resize(2);
    refused(bad);
    bad = good;
    bad[0].acknowledged = bad[0].commanded - 1us;
    refused(bad);
    bad = good;
    std::swap(bad[0].pictures[0], bad[0].pictures[1]);
    refused(bad);
    LightTimingOptions options;
    options.whole = 0.5;
    refused(good, options);
    EXPECT_THROW(std::ignore = planLights({}, true, options), std::logic_error);
}

TEST(LightPlan, TakesTwoPeriodsForAWebcamOf30PicturesASecond) {
    Random random(4, "usual");
    for (int run = 0; run < 100; ++run) {
        const auto timing = estimateLightTiming(Camera().watch(random, 3, 0ms, 4ms));
        ASSERT_TRUE(timing);
        const auto plan = planLights(*timing, true);
        ASSERT_TRUE(plan);
        EXPECT_EQ(plan->periods, 2);
        const auto atOnce = planLights(*timing, false);
        ASSERT_TRUE(atOnce);
        EXPECT_LT(atOnce->from, plan->from) << "commands may fall anywhere between pictures";
    }
}

TEST(LightPlan, LeavesMarginsOrThereIsNone) {
    Random random(5, "plans");
    int none = 0;
    for (int run = 0; run < 5000; ++run) {
        LightTiming timing;
        timing.period = between(random, 8ms, 70ms);
        timing.newFrom = between(random, -50ms, 250ms);
        timing.oldUntil = timing.newFrom - between(random, 0ms, 100ms);
        timing.answer = between(random, 0ms, 50ms);
        timing.jitter = random.uniform() < 0.5 ? 0ms : between(random, 0ms, 20ms);
        for (const bool keepsTime : {true, false}) {
            const auto plan = planLights(timing, keepsTime);
            if (!plan) {
                ++none;
                continue;
            }
            const Time margin = std::max(6'000us, 2 * timing.jitter);
            EXPECT_GE(plan->from, timing.newFrom + margin);
            EXPECT_LE(plan->until, timing.oldUntil - margin);
            const Time own = plan->periods * plan->period + plan->until - (timing.answer + plan->from);
            EXPECT_GE(own, keepsTime ? 2 * margin - 2us : timing.period - 2us);
            if (keepsTime) {
                EXPECT_GE(plan->aim, timing.answer + plan->from);
                EXPECT_LE(plan->aim, plan->periods * plan->period + plan->until);
            }
        }
    }
    EXPECT_GT(none, 10);
}

TEST(LightStream, APictureHasOneShowAtMost) {
    LightPlan plan;
    plan.period = 33ms;
    plan.periods = 2;
    plan.from = 90ms;
    plan.until = 70ms;
    const std::vector<LightShow> shows{{7, 1000ms, 1004ms}, {8, 1066ms, 1070ms}, {9, 1132ms, std::nullopt}};
    const auto at = [&](Time picture, Time now) { return showIn(shows, picture, now, plan); };
    EXPECT_FALSE(at(1093ms, 1200ms));
    EXPECT_EQ(at(1094ms, 1200ms), 0U);
    EXPECT_EQ(at(1135ms, 1200ms), 0U);
    EXPECT_FALSE(at(1136ms, 1200ms)) << "the next one may show";
    EXPECT_EQ(at(1160ms, 1200ms), 1U);
    EXPECT_FALSE(at(1300ms, 1300ms)) << "not acknowledged";
    EXPECT_EQ(showIn(std::span(shows).first(1), 1100ms, 1100ms, plan), 0U);
    EXPECT_EQ(showIn(std::span(shows).first(1), 5s, 5s, plan), 0U) << "it stays lit";
    EXPECT_EQ(at(1140ms, 1066ms), 0U) << "it came before the next one was lit";
    EXPECT_FALSE(showIn({}, 1100ms, 1100ms, plan));

    EXPECT_EQ(showsOver(shows, 1135ms, plan), 0U);
    EXPECT_EQ(showsOver(shows, 1136ms, plan), 1U);
    EXPECT_EQ(showsOver(shows, 9s, plan), 2U) << "the last stays lit";
    EXPECT_EQ(showsOver({}, 9s, plan), 0U);
}

TEST(LightStream, LightsSoThatPicturesFallWhereThePlanAims) {
    Random random(6, "aims");
    for (int run = 0; run < 1000; ++run) {
        LightPlan plan;
        plan.period = between(random, 8ms, 70ms);
        plan.periods = 2 + static_cast<int>(random.index(4));
        plan.aim = between(random, -30ms, 300ms);
        const Time picture = between(random, 10s, 11s);
        const Time earliest = picture + between(random, 0ms, 100ms);
        const Time first = nextShowAt({}, picture, earliest, plan);
        EXPECT_GE(first, earliest);
        EXPECT_LT(first, earliest + plan.period);
        EXPECT_EQ((first + plan.aim - picture) % plan.period, 0us);
        const std::vector<LightShow> shows{{0, first, first}};
        const Time next = nextShowAt(shows, picture, first, plan);
        EXPECT_EQ(next, first + plan.periods * plan.period);
        EXPECT_TRUE(isNextShowDue(shows, next, plan));
        EXPECT_FALSE(isNextShowDue(shows, next - plan.period, plan));
    }
    EXPECT_TRUE(isNextShowDue({}, 0ms, {}));
}

}  // namespace
}  // namespace skincal
