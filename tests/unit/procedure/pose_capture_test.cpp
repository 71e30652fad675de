#include "core/procedure/pose_capture.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "tests/unit/procedure/machine_table.h"

namespace skincal {
namespace {

using namespace pose_capture;
using namespace std::chrono_literals;
using enum PoseCapture::Phase;
using PoseRow = Row<PoseCapture, Event, Effect>;
using Time = std::chrono::microseconds;

constexpr std::nullopt_t kNothing = std::nullopt;
constexpr Time kSince = 10s;
constexpr PoseCaptureOptions kOptions{};

PoseCapture stateIn(PoseCapture::Phase phase) {
    return {phase, phase == Resting || phase == Captured ? kSince : Time{}};
}

TEST(PoseCapture, DoesWhatTheTableSays) {
    const Time later = kSince + kOptions.rest;
    const PoseRow table[] = {
        {Off, Start{}, Moving, {}},
        {Off, Stop{}, kNothing, {}},
        {Off, Sample{later, true, true}, kNothing, {}},
        {Off, CaptureNow{later}, kNothing, {}},

        {Moving, Start{}, kNothing, {}},
        {Moving, Stop{}, Off, {}},
        {Moving, Sample{later, true, true}, Resting, {}},
        {Moving, CaptureNow{later}, kNothing, {Refuse{}}},

        {Resting, Start{}, kNothing, {}},
        {Resting, Stop{}, Off, {}},
        {Resting, Sample{later, true, true}, Captured, {Capture{kSince}}},
        {Resting, CaptureNow{later}, Captured, {Capture{kSince}}},

        {Captured, Start{}, kNothing, {}},
        {Captured, Stop{}, Off, {}},
        {Captured, Sample{later, true, true}, Resting, {}},
        {Captured, CaptureNow{later}, Captured, {Capture{kSince}}},
    };
    static_assert(std::size(table) == pairs<Event>(Captured));
    expectTable<PoseCapture, Event, Effect>(table, stateIn);
}

/// What a sample does depends on what it says.
TEST(PoseCapture, DoesWhatTheTableOfSamplesSays) {
    const Time early = kSince + kOptions.rest - 1us;
    const Time late = kSince + kOptions.rest + 1s;
    struct SampleRow {
        PoseCapture::Phase from{};
        Sample sample{};
        PoseCapture to{};
        std::vector<Effect> effects{};
    };
    const SampleRow table[] = {
        {Off, {late, false, false}, {Off, {}}, {}},
        {Off, {late, false, true}, {Off, {}}, {}},
        {Off, {late, true, false}, {Off, {}}, {}},
        {Off, {late, true, true}, {Off, {}}, {}},

        {Moving, {late, false, false}, {Moving, {}}, {}},
        {Moving, {late, false, true}, {Moving, {}}, {}},
        {Moving, {late, true, false}, {Captured, late}, {}},
        {Moving, {late, true, true}, {Resting, late}, {}},

        {Resting, {late, false, false}, {Moving, {}}, {}},
        {Resting, {late, false, true}, {Moving, {}}, {}},
        {Resting, {late, true, false}, {Captured, kSince}, {}},
        {Resting, {late, true, true}, {Captured, late}, {Capture{late - kOptions.rest}}},
        {Resting, {early, true, true}, {Resting, kSince}, {}},
        {Resting, {1us, true, true}, {Resting, 1us}, {}},
        {Resting, {1us, true, false}, {Captured, 1us}, {}},

        {Captured, {late, false, false}, {Moving, {}}, {}},
        {Captured, {late, false, true}, {Moving, {}}, {}},
        {Captured, {late, true, false}, {Captured, kSince}, {}},
        {Captured, {late, true, true}, {Resting, late}, {}},
        {Captured, {1us, true, false}, {Captured, 1us}, {}},
    };
    for (const SampleRow& row : table) {
        const auto next = step(stateIn(row.from), row.sample);
        const auto where = testing::Message() << "row " << &row - table;
        EXPECT_TRUE(next.state == row.to) << where;
        EXPECT_TRUE(next.effects == row.effects) << where;
    }
}

TEST(PoseCapture, OnRequestTakesWhatHasRestedForHalfTheTime) {
    for (const auto phase : {Resting, Captured}) {
        const auto early = step(stateIn(phase), CaptureNow{kSince + kOptions.rest / 2 - 1us});
        EXPECT_TRUE(early.effects == std::vector<Effect>{Refuse{}});
        EXPECT_TRUE(early.state == stateIn(phase));
        const auto half = step(stateIn(phase), CaptureNow{kSince + kOptions.rest / 2});
        EXPECT_TRUE(half.effects == std::vector<Effect>{Capture{kSince}});
        const auto late = step(stateIn(phase), CaptureNow{kSince + 5s});
        EXPECT_TRUE(late.effects == std::vector<Effect>{Capture{kSince + 5s - kOptions.rest}});
        EXPECT_TRUE(has<Refuse>(step(late.state, CaptureNow{kSince + 5s}).effects)) << "a double click";
    }
}

/// A body that is turned and let go at random, readings now and then, and a device whose clock begins anew at times.
void expectPromisesKept(Random& random, const PoseCaptureOptions& options, int& captures) {
    PoseCapture state;
    Time now{};
    std::optional<Time> restsSince;  // by the samples alone
    std::optional<Time> usedUpTo;    // during this rest
    std::optional<Time> newSince;
    for (int i = 0; i < 200; ++i) {
        now += Time(1 + random.index(200'000));
        Event event;
        const double what = random.uniform();
        if (what < 0.02) {
            event = Stop{};
        } else if (what < 0.06) {
            event = Start{};
        } else if (what < 0.15) {
            event = CaptureNow{now};
        } else {
            if (random.uniform() < 0.01)
                now = Time(1 + random.index(1000));
            const bool isAtRest = random.uniform() < (restsSince ? 0.97 : 0.4);
            event = Sample{now, isAtRest, random.uniform() < 0.95};
        }
        const PoseCapture before = state;
        const auto next = step(state, event, options);
        state = next.state;
        if (const auto* sample = std::get_if<Sample>(&event)) {
            const bool isAnew = restsSince && sample->time < std::max(*restsSince, usedUpTo.value_or(Time{}));
            if (!sample->isAtRest || before.phase == Off || isAnew)
                restsSince = usedUpTo = newSince = std::nullopt;
            if (sample->isAtRest && before.phase != Off && !restsSince)
                restsSince = sample->time;
            if (!sample->isNew || !sample->isAtRest)
                newSince.reset();
            else if (!newSince || sample->time < *newSince)
                newSince = sample->time;
        }
        if (state.phase == Off || state.phase == Moving)
            restsSince = usedUpTo = newSince = std::nullopt;
        ASSERT_LE(next.effects.size(), 1U);
        if (!has<Capture>(next.effects)) {
            EXPECT_EQ(has<Refuse>(next.effects), std::holds_alternative<CaptureNow>(event) && before.phase != Off);
            continue;
        }
        ++captures;
        const Time from = std::get<Capture>(next.effects[0]).from;
        ASSERT_TRUE(restsSince) << "captured while it moved";
        EXPECT_GE(from, *restsSince);
        if (usedUpTo) {
            EXPECT_GE(from, *usedUpTo) << "readings in two poses";
        }
        EXPECT_LE(now - from, options.rest);
        if (std::holds_alternative<Sample>(event)) {
            EXPECT_TRUE(options.isAutomatic);
            ASSERT_TRUE(newSince) << "captured a pose that is there";
            EXPECT_GE(from, *newSince);
            EXPECT_EQ(now - from, options.rest);
        } else {
            EXPECT_TRUE(std::holds_alternative<CaptureNow>(event));
            EXPECT_GE(now - from, options.rest / 2);
        }
        EXPECT_EQ(state.phase, Captured);
        usedUpTo = now;
        newSince.reset();
    }
}

TEST(PoseCapture, HoldsItsPromisesWhateverComes) {
    Random random(1, "poses");
    for (const bool isAutomatic : {true, false}) {
        int captures = 0;
        for (int run = 0; run < 1000; ++run)
            expectPromisesKept(random, {std::chrono::milliseconds(1 + random.index(1500)), isAutomatic}, captures);
        EXPECT_GT(captures, 1000);
    }
}

TEST(PoseCapture, ABodyTurnedFromPoseToPoseIsCapturedOnceInEach) {
    Random random(2, "turns");
    for (int run = 0; run < 100; ++run) {
        const auto every = Time(2'000 + random.index(50'000));
        Time now{};
        PoseCapture state = step(PoseCapture{}, Start{}).state;
        for (int pose = 0; pose < 10; ++pose) {
            for (std::size_t i = 0; i < 20; ++i, now += every)
                state = step(state, Sample{now, false, true}).state;
            int captures = 0;
            for (const Time until = now + 3s; now < until; now += every) {
                const auto next = step(state, Sample{now, true, captures == 0});
                captures += has<Capture>(next.effects) ? 1 : 0;
                state = next.state;
            }
            EXPECT_EQ(captures, 1);
        }
    }
}

TEST(PoseCapture, RejectsOptionsOutOfRange) {
    for (const auto rest : {0ms, -1ms}) {
        const PoseCaptureOptions options{rest, true};
        EXPECT_FALSE(options.validate());
        EXPECT_THROW(std::ignore = step(PoseCapture{}, Start{}, options), std::logic_error);
    }
}

}  // namespace
}  // namespace skincal
