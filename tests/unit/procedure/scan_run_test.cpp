#include "core/procedure/scan_run.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "tests/unit/procedure/machine_table.h"

namespace skincal {
namespace {

using namespace scan_run;
using namespace std::chrono_literals;
using enum ScanRun::Phase;
using Phase = ScanRun::Phase;
using ScanRow = Row<ScanRun, Event, Effect>;
using Time = std::chrono::microseconds;

constexpr std::nullopt_t kNothing = std::nullopt;
constexpr ScanRunOptions kOptions{};
using Fault = ScanRun::Fault;

constexpr StartTimer kLightTimer{500ms};
constexpr StartTimer kPictureTimer{1700ms};

ScanRun finished(ScanRun state) {
    if (state.phase == Phase::Failed)
        state.fault = Fault::OtherCamera;
    return state;
}

/// The second of three frames, lit by command 7; in Timing all of them.
ScanRun stateIn(Phase phase) {
    ScanRun state;
    state.phase = phase;
    if (phase == Idle)
        return state;
    const bool isWhole = phase == Decoding || phase == Done;
    state.frames = 3;
    state.left = isWhole ? std::vector<std::size_t>() : std::vector<std::size_t>{1, 2};
    state.token = 7;
    state.isAnswered = phase == Settling;
    state.repeats = isWhole ? 0 : 1;
    state.showsFrom = 1s;
    state.newest = 890ms;
    state.newestCame = 895ms;
    state.isTimed = phase == Timing || phase == Streaming;
    state.keepsTime = true;
    if (phase == Timing)
        state.toggles = {{900ms, {}, {{880ms, 0}}}};
    if (phase != Streaming)
        return finished(state);
    state.plan = LightPlan{33ms, 2, 90ms, 70ms, 110ms};
    state.shows = {{1, 900ms, {}}};
    state.queue = {2};
    return finished(state);
}

TEST(ScanRun, DoesWhatTheTableSays) {
    constexpr auto Broken = Phase::Failed;
    const std::vector<Effect> none;
    const std::vector<Effect> stops{StopTimer{}, LightsOff{}, Discard{}};
    const ScanRow table[] = {
        {Idle, Start{3}, Lighting, {Light{0}, kLightTimer}},
        {Idle, Extend{2}, kNothing, none},
        {Idle, LightCommanded{8}, kNothing, none},
        {Idle, LightShown{7, 1s}, kNothing, none},
        {Idle, PictureTaken{2s}, kNothing, none},
        {Idle, Pause{}, kNothing, none},
        {Idle, Resume{}, kNothing, none},
        {Idle, Cancel{}, kNothing, none},
        {Idle, Decoded{}, kNothing, none},
        {Idle, scan_run::Failed{Fault::SkinGone}, kNothing, none},
        {Idle, TimedOut{}, kNothing, none},

        {Timing, Start{3}, kNothing, none},
        {Timing, Extend{2}, kNothing, none},
        {Timing, LightCommanded{8}, Timing, none},
        {Timing, LightShown{7, 1s}, Timing, {StartTimer{1000ms}}},
        {Timing, PictureTaken{2s}, Timing, none},
        {Timing, Pause{}, Paused, {StopTimer{}, LightsOff{}}},
        {Timing, Resume{}, kNothing, none},
        {Timing, Cancel{}, Idle, stops},
        {Timing, Decoded{}, kNothing, none},
        {Timing, scan_run::Failed{Fault::SkinGone}, Broken, stops},
        {Timing, TimedOut{}, Timing, {Light{0}, kLightTimer}},

        {Streaming, Start{3}, kNothing, none},
        {Streaming, Extend{2}, kNothing, none},
        {Streaming, LightCommanded{8}, Streaming, none},
        {Streaming, LightShown{7, 897ms}, Streaming, {StartTimer{1000ms}, Light{2, 978ms}, StartTimer{581ms}}},
        {Streaming, PictureTaken{2s}, Streaming, none},
        {Streaming, Pause{}, Paused, {StopTimer{}, LightsOff{}}},
        {Streaming, Resume{}, kNothing, none},
        {Streaming, Cancel{}, Idle, stops},
        {Streaming, Decoded{}, kNothing, none},
        {Streaming, scan_run::Failed{Fault::SkinGone}, Broken, stops},
        {Streaming, TimedOut{}, Streaming, {StartTimer{1000ms}}},

        {Lighting, Start{3}, kNothing, none},
        {Lighting, Extend{2}, kNothing, none},
        {Lighting, LightCommanded{8}, Lighting, none},
        {Lighting, LightShown{7, 1s}, Settling, {kPictureTimer}},
        {Lighting, PictureTaken{2s}, kNothing, none},
        {Lighting, Pause{}, Paused, {StopTimer{}, LightsOff{}}},
        {Lighting, Resume{}, kNothing, none},
        {Lighting, Cancel{}, Idle, stops},
        {Lighting, Decoded{}, kNothing, none},
        {Lighting, scan_run::Failed{Fault::SkinGone}, Broken, stops},
        {Lighting, TimedOut{}, Lighting, {Light{1}, kLightTimer}},

        {Settling, Start{3}, kNothing, none},
        {Settling, Extend{2}, kNothing, none},
        {Settling, LightCommanded{8}, kNothing, none},
        {Settling, LightShown{7, 1s}, kNothing, none},
        {Settling, PictureTaken{2s}, Lighting, {KeepPicture{1}, Light{2}, kLightTimer}},
        {Settling, Pause{}, Paused, {StopTimer{}, LightsOff{}}},
        {Settling, Resume{}, kNothing, none},
        {Settling, Cancel{}, Idle, stops},
        {Settling, Decoded{}, kNothing, none},
        {Settling, scan_run::Failed{Fault::SkinGone}, Broken, stops},
        {Settling, TimedOut{}, Lighting, {Light{1}, kLightTimer}},

        {Paused, Start{3}, kNothing, none},
        {Paused, Extend{2}, kNothing, none},
        {Paused, LightCommanded{8}, kNothing, none},
        {Paused, LightShown{7, 1s}, kNothing, none},
        {Paused, PictureTaken{2s}, kNothing, none},
        {Paused, Pause{}, kNothing, none},
        {Paused, Resume{}, Lighting, {Light{1}, kLightTimer}},
        {Paused, Cancel{}, Idle, {Discard{}}},
        {Paused, Decoded{}, kNothing, none},
        {Paused, scan_run::Failed{Fault::SkinGone}, Broken, stops},
        {Paused, TimedOut{}, kNothing, none},

        {Decoding, Start{3}, kNothing, none},
        {Decoding, Extend{2}, Lighting, {Light{3}, kLightTimer}},
        {Decoding, LightCommanded{8}, kNothing, none},
        {Decoding, LightShown{7, 1s}, kNothing, none},
        {Decoding, PictureTaken{2s}, kNothing, none},
        {Decoding, Pause{}, kNothing, none},
        {Decoding, Resume{}, kNothing, none},
        {Decoding, Cancel{}, Idle, {Discard{}}},
        {Decoding, Decoded{}, Done, none},
        {Decoding, scan_run::Failed{Fault::NotDecoded}, Broken, stops},
        {Decoding, TimedOut{}, kNothing, none},

        {Done, Start{3}, Lighting, {Light{0}, kLightTimer}},
        {Done, Extend{2}, kNothing, none},
        {Done, LightCommanded{8}, kNothing, none},
        {Done, LightShown{7, 1s}, kNothing, none},
        {Done, PictureTaken{2s}, kNothing, none},
        {Done, Pause{}, kNothing, none},
        {Done, Resume{}, kNothing, none},
        {Done, Cancel{}, Idle, none},
        {Done, Decoded{}, kNothing, none},
        {Done, scan_run::Failed{Fault::SkinGone}, kNothing, none},
        {Done, TimedOut{}, kNothing, none},

        {Broken, Start{3}, Lighting, {Light{0}, kLightTimer}},
        {Broken, Extend{2}, kNothing, none},
        {Broken, LightCommanded{8}, kNothing, none},
        {Broken, LightShown{7, 1s}, kNothing, none},
        {Broken, PictureTaken{2s}, kNothing, none},
        {Broken, Pause{}, kNothing, none},
        {Broken, Resume{}, kNothing, none},
        {Broken, Cancel{}, Idle, none},
        {Broken, Decoded{}, kNothing, none},
        {Broken, scan_run::Failed{Fault::SkinGone}, kNothing, none},
        {Broken, TimedOut{}, kNothing, none},
    };
    static_assert(std::size(table) == pairs<Event>(Phase::Failed));
    expectTable<ScanRun, Event, Effect>(table, stateIn);
}

void expectIgnored(const ScanRun& state, const Event& event) {
    const auto next = step(state, event);
    EXPECT_TRUE(next.state == state);
    EXPECT_TRUE(next.effects.empty());
}

TEST(ScanRun, NeedsSomethingToTake) {
    for (const auto phase : {Idle, Done, Phase::Failed})
        expectIgnored(stateIn(phase), Start{0});
}

TEST(ScanRun, StartsAnewWithoutWhatWasBefore) {
    for (const auto phase : {Done, Phase::Failed}) {
        const auto next = step(stateIn(phase), Start{5});
        EXPECT_TRUE(next.state == step(ScanRun{}, Start{5}).state);
    }
}

TEST(ScanRun, WaitsForTheAcknowledgementOfItsOwnCommand) {
    for (const std::uint64_t token : {0U, 6U, 8U})
        expectIgnored(stateIn(Lighting), LightShown{token, 1s});
    EXPECT_EQ(step(stateIn(Lighting), LightCommanded{8}).state.token, 8U);
    // Between the effect and what the device returned no token is right, 0 neither.
    const ScanRun begun = step(ScanRun{}, Start{3}).state;
    for (const std::uint64_t token : {0U, 1U})
        expectIgnored(begun, LightShown{token, 1s});
    EXPECT_EQ(step(step(begun, LightCommanded{0}).state, LightShown{0, 1s}).state.phase, Settling);
}

TEST(ScanRun, KeepsNoPictureExposedBeforeTheLightShows) {
    const ScanRun settling = step(stateIn(Lighting), LightShown{7, 1s}).state;
    EXPECT_EQ(settling.showsFrom, 1s + kOptions.toggleShows) << "nothing tells how late the camera is";
    ScanRun known = stateIn(Lighting);
    known.slowest = 20ms;
    EXPECT_EQ(step(known, LightShown{7, 1s}).state.showsFrom, 1s + kOptions.settle);
    expectIgnored(settling, PictureTaken{settling.showsFrom - 1us});
    EXPECT_TRUE(has<KeepPicture>(step(settling, PictureTaken{settling.showsFrom}).effects));
}

TEST(ScanRun, DecodesAfterTheLastPicture) {
    ScanRun state = stateIn(Settling);
    state.left = {2};
    const auto next = step(state, PictureTaken{2s});
    EXPECT_EQ(next.state.phase, Decoding);
    EXPECT_TRUE((next.effects == std::vector<Effect>{KeepPicture{2}, StopTimer{}, LightsOff{}, Decode{}}));
}

TEST(ScanRun, GivesUpWhatDoesNotAnswerAfterSomeRepeats) {
    for (const auto phase : {Lighting, Settling}) {
        ScanRun state = stateIn(phase);
        state.repeats = kOptions.maxRepeats - 1;
        EXPECT_EQ(step(state, TimedOut{}).state.phase, Lighting);
        state.repeats = kOptions.maxRepeats;
        const auto next = step(state, TimedOut{});
        EXPECT_EQ(next.state.phase, Phase::Failed);
        EXPECT_TRUE((next.effects == std::vector<Effect>{StopTimer{}, LightsOff{}, Discard{}}));
        EXPECT_EQ(next.state.fault, phase == Lighting ? Fault::SkinSilent : Fault::CameraSilent);
        // The next frame and a break begin counting anew.
        EXPECT_EQ(step(stateIn(Settling), PictureTaken{2s}).state.repeats, 0);
        EXPECT_EQ(step(step(state, Pause{}).state, Resume{}).state.repeats, 0);
    }
    EXPECT_EQ(step(stateIn(Decoding), scan_run::Failed{Fault::NotDecoded}).state.fault, Fault::NotDecoded);
}

TEST(ScanRun, ACameraHasItsTimeFromWhenTheLightShows) {
    ScanRunOptions slow;
    slow.settle = 5s;
    const auto next = step(stateIn(Lighting), LightShown{7, 1s}, slow);
    EXPECT_TRUE((next.effects == std::vector<Effect>{StartTimer{6s}}));
}

TEST(ScanRun, RejectsOptionsOutOfRange) {
    const auto rejected = [](auto change) {
        ScanRunOptions options;
        EXPECT_TRUE(options.validate());
        change(options);
        EXPECT_FALSE(options.validate());
        EXPECT_THROW(std::ignore = step(ScanRun{}, Start{1}, options), std::logic_error);
    };
    rejected([](ScanRunOptions& o) { o.settle = -1ms; });
    rejected([](ScanRunOptions& o) { o.lightAnswers = 0ms; });
    rejected([](ScanRunOptions& o) { o.pictureComes = 0ms; });
    rejected([](ScanRunOptions& o) { o.maxRepeats = -1; });
}

/// Carries effects out the way a caller does and keeps its own books of what was promised.
struct Bench {
    ScanRunOptions options{};
    ScanRun state{};
    std::uint64_t token = 0;  ///< the device's newest
    std::size_t lit = 0;      ///< what it is of
    bool isOn = false;
    bool isTimed = false;
    bool isHolding = false;       ///< pictures, or a scan begun that will give some
    std::optional<Time> shown{};  ///< when the newest light was acknowledged
    std::vector<std::size_t> kept{};
    int decoded = 0;

    void send(const Event& event) {
        const ScanRun before = state;
        const auto next = step(state, event, options);
        state = next.state;
        if (const auto* ack = std::get_if<LightShown>(&event)) {
            if (before.phase != Lighting || ack->token != token) {
                EXPECT_TRUE(state == before && next.effects.empty()) << "heeds a late acknowledgement";
            } else {
                shown = ack->now;
            }
        }
        if (std::holds_alternative<Start>(event) && before.phase != state.phase) {
            kept.clear();
            decoded = 0;
            isHolding = true;
        }
        const bool isOver = before.phase != Idle && before.phase != Done && before.phase != Phase::Failed &&
                            (state.phase == Idle || state.phase == Phase::Failed);
        EXPECT_EQ(has<Discard>(next.effects), isOver);
        for (const Effect& effect : next.effects)
            std::visit([&](const auto& what) { carryOut(what, event); }, effect);
        EXPECT_EQ(isTimed, state.isRunning()) << "hangs, or a timer goes on";
        EXPECT_EQ(isOn, state.isRunning()) << "lights left on, or off while it takes pictures";
        if (state.isRunning()) {
            EXPECT_EQ(lit, state.left.front());
        }
        if (state.phase == Idle || state.phase == Phase::Failed) {
            EXPECT_FALSE(isHolding) << "not discarded";
        }
        EXPECT_EQ(state.fault == Fault::None, state.phase != Phase::Failed);
        if (state.phase == Done) {
            EXPECT_EQ(kept.size(), state.frames);
            EXPECT_EQ(decoded, 1);
            isHolding = false;
        }
    }

    void carryOut(const Light& light, const Event&) {
        lit = light.frame;
        isOn = true;
        shown.reset();
        ++token;
        const auto next = step(state, LightCommanded{token}, options);
        EXPECT_TRUE(next.effects.empty());
        state = next.state;
    }
    void carryOut(const TakeReference&, const Event&) { FAIL() << "nothing is timed"; }
    void carryOut(const LightsOff&, const Event&) {
        ++token;
        isOn = false;
        shown.reset();
    }
    void carryOut(const KeepPicture& keep, const Event& event) {
        const auto* picture = std::get_if<PictureTaken>(&event);
        ASSERT_TRUE(picture && isOn && shown);
        EXPECT_EQ(keep.frame, lit);
        EXPECT_EQ(keep.frame, kept.size()) << "each once, in order";
        EXPECT_GE(picture->time, *shown + options.settle);
        kept.push_back(keep.frame);
    }
    void carryOut(const Decode&, const Event&) {
        EXPECT_EQ(kept.size(), state.frames);
        ++decoded;
    }
    void carryOut(const Discard&, const Event&) {
        EXPECT_TRUE(isHolding);
        isHolding = false;
        kept.clear();
    }
    void carryOut(const StartTimer& timer, const Event&) {
        EXPECT_GT(timer.after.count(), 0);
        isTimed = true;
    }
    void carryOut(const StopTimer&, const Event&) { isTimed = false; }
};

Event randomEvent(Random& random, const Bench& bench, Time now) {
    const double what = random.uniform();
    if (what < 0.02)
        return Pause{};
    if (what < 0.06)
        return Resume{};
    if (what < 0.065)
        return Cancel{};
    if (what < 0.09)
        return Decoded{};
    if (what < 0.095)
        return scan_run::Failed{Fault::SkinGone};
    if (what < 0.15)
        return Start{random.index(6)};
    if (what < 0.45)
        return LightShown{bench.token, now};
    if (what < 0.6)
        return LightShown{random.index(bench.token + 1), now};
    // Late frames may have been exposed long ago.
    return PictureTaken{now - Time(random.index(300'000))};
}

TEST(ScanRun, HoldsItsPromisesWhateverComes) {
    Random random(1, "scans");
    std::array<int, 9> visits{};
    for (int run = 0; run < 3000; ++run) {
        Bench bench;
        bench.options.settle = std::chrono::milliseconds(random.index(200));
        bench.options.toggleShows = bench.options.settle + 1ms;
        bench.options.maxRepeats = static_cast<int>(random.index(4));
        Time now = 1s;
        for (int i = 0; i < 150; ++i) {
            now += Time(random.index(200'000));
            if (bench.isTimed && random.uniform() < 0.05) {
                bench.isTimed = false;
                bench.send(TimedOut{});
            } else {
                bench.send(randomEvent(random, bench, now));
            }
            ++visits.at(static_cast<std::size_t>(bench.state.phase));
        }
        // Where nothing comes any more it gives up by itself.
        for (int i = 0; bench.state.isRunning(); ++i) {
            ASSERT_LE(i, bench.options.maxRepeats);
            bench.isTimed = false;
            bench.send(TimedOut{});
        }
    }
    for (const Phase phase : {Idle, Lighting, Settling, Paused, Decoding, Done, Phase::Failed})
        EXPECT_GT(visits.at(static_cast<std::size_t>(phase)), 1000);
}

TEST(ScanRun, FromAnywhereItCanBeFinished) {
    Random random(2, "finish");
    for (int run = 0; run < 2000; ++run) {
        Bench bench;
        Time now = 1s;
        for (std::size_t i = random.index(100); i > 0; --i)
            bench.send(randomEvent(random, bench, now += 50ms));
        bench.send(Resume{});
        bench.send(Start{1 + random.index(8)});
        const std::size_t left = bench.state.left.size();
        for (std::size_t i = 0; i < left; ++i) {
            bench.send(LightShown{bench.token, now += 10ms});
            bench.send(PictureTaken{now += bench.options.toggleShows});
        }
        bench.send(Decoded{});
        EXPECT_EQ(bench.state.phase, Done);
    }
}

}  // namespace
}  // namespace skincal
