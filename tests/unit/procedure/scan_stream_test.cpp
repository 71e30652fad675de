// The scan's machine against skins and cameras that are late, each in its own way: no picture may ever be taken for
// that of another pattern.

#include <gtest/gtest.h>

#include <functional>
#include <iostream>
#include <map>
#include <set>

#include "core/geometry/random.h"
#include "core/procedure/scan_run.h"

namespace skincal {
namespace {

using namespace scan_run;
using namespace std::chrono_literals;
using Phase = ScanRun::Phase;

struct Desk {
    Toggles toggles = Toggles::GivenTime;
    Time period = 33'333us;
    Time latency = 80ms;   ///< a picture of time t is exposed from t - latency on
    Time exposed = 0ms;    ///< from the beginning of the first row to the end of the last
    Time stampJitter{};    ///< times are off by as much, this way or that
    Time delivery = 1ms;   ///< pictures come as late as this after their time, or a little more
    double dropped = 0;    ///< share of pictures that never come
    Time wire = 500us;     ///< from a command to the first cell that hears of it
    Time latch = 0ms;      ///< from the first LED to the last, at most
    Time answer = 4ms;     ///< from then to the acknowledgement, at most
    bool isHasty = false;  ///< the skin lights at once whenever it is told to
    double deaf = 0;       ///< share of commands that are never acknowledged
    double visible = 1;    ///< share of the LEDs' light that the camera sees
    Time known{};          ///< how late the camera was in an earlier scan
};

/// Carries out what the machine asks for, in simulated time.
class Bench {
  public:
    Bench(const Desk& desk, std::uint64_t seed) : desk_(desk), random_(seed, "bench") {}

    /// Until it is over, one way or the other.
    void run(std::size_t frames) {
        frames_ = frames;
        const Time began = now_;
        send(Start{frames, desk_.toggles, desk_.known});
        expose(between(0us, desk_.period));
        while (state.isRunning() || state.phase == Phase::Paused) {
            ASSERT_LT(now_ - began, 300s) << "hangs";
            auto next = due_.begin();
            now_ = next->first;
            const auto what = std::move(next->second);
            due_.erase(next);
            what();
        }
        took = now_ - began;
    }
    void at(Time when, std::function<void()> what) { due_.emplace(std::max(when, now_), std::move(what)); }
    void send(const Event& event) {
        const auto next = step(state, event);
        state = next.state;
        for (const Effect& effect : next.effects)
            std::visit([&](const auto& what) { carryOut(what); }, effect);
        streamed = streamed || state.phase == Phase::Streaming;
        periods = state.plan ? state.plan->periods : periods;
    }
    [[nodiscard]] Time now() const { return now_; }

    ScanRun state;
    Time took{};
    bool streamed = false;
    int periods = 0;
    int wrong = 0;
    std::map<std::size_t, int> kept;  ///< how often
    std::map<std::size_t, int> lit;   ///< how often

  private:
    static constexpr std::size_t kNothing = 1'000'000;
    struct Change {
        Time from{};
        Time until{};  ///< until all LEDs have changed
        std::size_t frame = kNothing;
    };
    struct Picture {
        std::set<std::size_t> frames;  ///< that it shows
        double light = 0;
    };

    Time between(Time low, Time high) {
        return low + Time(static_cast<Time::rep>(random_.uniform() * static_cast<double>((high - low).count())));
    }
    [[nodiscard]] static double lightOf(std::size_t frame) {
        return frame == 0 || frame == kNothing ? 0 : frame == 1 ? 1 : 0.5;
    }

    void expose(Time first) {
        for (int n = 0; n < 10'000; ++n) {
            const Time begin = now_ + first + n * desk_.period;
            const Time time = begin + desk_.latency + between(-desk_.stampJitter, desk_.stampJitter);
            const Time comes = std::max(time + desk_.delivery, begin + desk_.exposed) + between(0ms, 2ms);
            if (random_.uniform() >= desk_.dropped)
                at(comes, [this, begin, time] { deliver(begin, time); });
        }
    }
    [[nodiscard]] Picture look(Time begin) const {
        Picture picture;
        const Time end = begin + std::max(desk_.exposed, 1us);
        for (std::size_t i = 0; i < changes_.size(); ++i) {
            // What was lit before goes on until the last LED has changed.
            const Time from = std::max(begin, changes_[i].from);
            const Time until = i + 1 < changes_.size() ? std::min(end, changes_[i + 1].until) : end;
            if (from >= end || until <= begin || from >= until)
                continue;
            picture.frames.insert(changes_[i].frame);
            const Time ends = i + 1 < changes_.size() ? std::min(end, changes_[i + 1].from) : end;
            picture.light += lightOf(changes_[i].frame) * std::max(0.0, static_cast<double>((ends - from).count())) /
                             static_cast<double>((end - begin).count());
        }
        return picture;
    }
    void deliver(Time begin, Time time) {
        if (isGone)
            return;
        picture_ = look(begin);
        send(PictureTaken{time, now_, 1e4 * desk_.visible * (picture_.light - reference_.light)});
    }
    void change(std::size_t frame, Time when) {
        const Time from = std::max({when, now_ + desk_.wire, changes_.back().until});
        changes_.push_back({from, from + between(0us, desk_.latch + 1us), frame});
        ++token_;
        if (random_.uniform() < desk_.deaf)
            return;
        at(changes_.back().until + between(1ms, desk_.answer), [this, token = token_] {
            if (token == token_ && !isDeaf)
                send(LightShown{token, now_});
        });
    }

    void carryOut(const Light& light) {
        ++lit[light.frame];
        EXPECT_TRUE(!light.at || desk_.toggles == Toggles::GivenTime);
        const Time now = now_;
        change(light.frame, desk_.isHasty ? now_ : light.at.value_or(now_));
        const auto next = step(state, LightCommanded{token_, now});
        EXPECT_TRUE(next.effects.empty());
        state = next.state;
    }
    void carryOut(TakeReference) { reference_ = picture_; }
    void carryOut(const KeepPicture& keep) {
        ++kept[keep.frame];
        wrong += picture_.frames == std::set<std::size_t>{keep.frame} ? 0 : 1;
    }
    void carryOut(LightsOff) { change(kNothing, now_); }
    void carryOut(Decode) {
        EXPECT_EQ(kept.size(), frames_);
        EXPECT_TRUE(state.left.empty());
    }
    void carryOut(Discard) {}
    void carryOut(const StartTimer& timer) {
        at(now_ + timer.after, [this, count = ++timers_] {
            if (count == timers_)
                send(TimedOut{});
        });
    }
    void carryOut(StopTimer) { ++timers_; }

  public:
    bool isGone = false;  ///< the camera
    bool isDeaf = false;  ///< the skin

  private:
    Desk desk_;
    Random random_;
    Time now_ = 100s;
    std::size_t frames_ = 0;
    std::uint64_t token_ = 0;
    std::uint64_t timers_ = 0;
    std::multimap<Time, std::function<void()>> due_;
    std::vector<Change> changes_{{0s, 0s, kNothing}};
    Picture picture_;
    Picture reference_;
};

constexpr std::size_t kThousand = 32;  ///< pictures of a scan of 1,000 modules

/// The longest of some scans, none of which may go wrong.
Time slowestScan(const char* what, const Desk& desk, int mostPeriods) {
    Time slowest{};
    int periods = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        Bench bench(desk, seed);
        bench.run(kThousand);
        EXPECT_EQ(bench.state.phase, Phase::Decoding);
        EXPECT_EQ(bench.wrong, 0);
        slowest = std::max(slowest, bench.took);
        periods = std::max(periods, bench.periods);
    }
    EXPECT_LE(periods, mostPeriods);
    std::cout << "32 pictures at 30/s, " << what << ": " << slowest / 1ms << " ms at most, a pattern lit for "
              << periods << " pictures\n";
    return slowest;
}

TEST(ScanStream, AThousandModulesTakeThreeSecondsWithAUsualWebcam) {
    EXPECT_LE(slowestScan("latency 80 ms", {}, 2), 3s);
    Desk lossy;
    lossy.dropped = 0.05;
    slowestScan("5 % of them dropped", lossy, 3);
    Desk rolling;
    rolling.exposed = 36ms;
    slowestScan("rolling shutter, 16 ms open and 20 ms read", rolling, 3);
    Desk late;
    late.latency = 250ms;
    EXPECT_LE(slowestScan("latency 250 ms", late, 2), 4s);
    Desk atOnce;
    atOnce.toggles = Toggles::AtOnce;
    slowestScan("a skin that lights at once", atOnce, 4);
}

TEST(ScanStream, NoPictureIsEverTakenForAnother) {
    Random random(1, "desks");
    const auto between = [&](Time low, Time high) {
        return low + Time(static_cast<Time::rep>(random.uniform() * static_cast<double>((high - low).count())));
    };
    int streams = 0;
    int pictures = 0;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        Desk desk;
        desk.toggles = seed % 4 == 3 ? Toggles::AtOnce : Toggles::GivenTime;
        desk.period = random.uniform() < 0.5 ? desk.period : between(15ms, 70ms);
        desk.latency = between(20ms, 250ms);
        desk.exposed = between(1ms, std::min<Time>(desk.period + 16ms, 60ms));
        desk.stampJitter = between(0ms, 8ms);
        desk.delivery = between(1ms, 60ms);
        desk.dropped = seed % 2 == 0 ? 0 : 0.05;
        desk.latch = between(0ms, 5ms);
        desk.answer = between(2ms, 30ms);
        desk.deaf = seed % 5 == 0 ? 0.03 : 0;
        Bench bench(desk, seed);
        bench.run(2 + random.index(40));
        ASSERT_EQ(bench.state.phase, Phase::Decoding) << seed;
        EXPECT_EQ(bench.wrong, 0) << seed;
        streams += bench.streamed ? 1 : 0;
        pictures += static_cast<int>(bench.state.frames);
    }
    EXPECT_GT(streams, 1700);
    RecordProperty("streams", streams);
    RecordProperty("pictures", pictures);
}

TEST(ScanStream, PausedAnywhereItGoesOnWithWhatIsLeft) {
    Random random(2, "breaks");
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        Desk desk;
        desk.latency = std::chrono::milliseconds(20 + random.index(230));
        desk.dropped = 0.05;
        Bench bench(desk, seed);
        for (int breaks = 0; breaks < 3; ++breaks) {
            const Time when = bench.now() + Time(static_cast<Time::rep>(random.uniform() * 2.5e6));
            bench.at(when, [&] { bench.send(Pause{}); });
            bench.at(when + std::chrono::milliseconds(random.index(1000)), [&] { bench.send(Resume{}); });
        }
        bench.run(20);
        ASSERT_EQ(bench.state.phase, Phase::Decoding);
        EXPECT_EQ(bench.wrong, 0) << seed;
        EXPECT_TRUE(bench.state.plan);
    }
}

TEST(ScanStream, WhatIsSilentEndsIt) {
    Random random(3, "silence");
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        for (const bool isCamera : {true, false}) {
            Bench bench({}, seed);
            const Time when = bench.now() + Time(static_cast<Time::rep>(random.uniform() * 2e6));
            bench.at(when, [&] { (isCamera ? bench.isGone : bench.isDeaf) = true; });
            bench.run(kThousand);
            ASSERT_EQ(bench.state.phase, Phase::Failed);
            EXPECT_EQ(bench.state.fault, isCamera ? ScanRun::Fault::CameraSilent : ScanRun::Fault::SkinSilent);
            EXPECT_LT(bench.took, when - 100s + 15s);
            // Nothing is lit for nobody.
            if (isCamera) {
                EXPECT_LT(bench.lit.size(), kThousand);
            }
        }
    }
}

TEST(ScanStream, OneByOneWhereLightCannotBeTimed) {
    // No LED is in sight.
    Desk dark;
    dark.visible = 0;
    Bench unseen(dark, 1);
    unseen.run(8);
    EXPECT_EQ(unseen.state.phase, Phase::Decoding);
    EXPECT_FALSE(unseen.streamed);
    EXPECT_FALSE(unseen.state.timing);
    // Too slow to answer, and times that are good for nothing.
    Desk slow;
    slow.answer = 400ms;
    slow.stampJitter = 60ms;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Bench bench(slow, seed);
        bench.run(8);
        EXPECT_EQ(bench.state.phase, Phase::Decoding);
        EXPECT_EQ(bench.wrong, 0) << seed;
        EXPECT_FALSE(bench.streamed) << seed;
    }
}

// Neither too little light to time it by nor a list that is too short for it makes a late camera's picture another's.
TEST(ScanStream, WhatCannotBeTimedIsWaitedForAsLongAsAnyCameraTakes) {
    Random random(9, "late");
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Desk desk;
        desk.visible = 0.04;
        desk.latency = std::chrono::milliseconds(20 + random.index(600));
        desk.toggles = std::array{Toggles::None, Toggles::AtOnce, Toggles::GivenTime}.at(seed % 3);
        Bench bench(desk, seed);
        bench.run(10);
        ASSERT_EQ(bench.state.phase, Phase::Decoding) << seed;
        EXPECT_EQ(bench.wrong, 0) << seed << ", latency " << desk.latency.count();
        EXPECT_FALSE(bench.streamed);
        // An earlier scan knew better.
        desk.known = desk.latency + 50ms;
        Bench again(desk, seed);
        again.run(10);
        EXPECT_EQ(again.wrong, 0) << seed;
        if (desk.latency < 300ms) {
            EXPECT_LT(again.took, bench.took) << seed;
        }
    }
}

TEST(ScanStream, PicturesMayComeLongAfterTheyWereTaken) {
    Random random(5, "delivery");
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Desk desk;
        desk.latency = 5ms;  // times are of the exposure itself
        desk.delivery = std::chrono::milliseconds(150 + random.index(200));
        Bench bench(desk, seed);
        bench.run(20);
        ASSERT_EQ(bench.state.phase, Phase::Decoding) << seed;
        EXPECT_EQ(bench.wrong, 0) << seed;
        EXPECT_TRUE(bench.streamed) << seed;
    }
}

TEST(ScanStream, ASkinThatDoesNotHeedTheTimeIsLitAtOnce) {
    Random random(4, "haste");
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Desk desk;
        desk.isHasty = true;
        desk.latency = std::chrono::milliseconds(20 + random.index(230));
        desk.exposed = std::chrono::milliseconds(random.index(20));
        Bench bench(desk, seed);
        bench.run(kThousand);
        ASSERT_EQ(bench.state.phase, Phase::Decoding);
        EXPECT_EQ(bench.wrong, 0) << seed;
        EXPECT_FALSE(bench.state.keepsTime);
        EXPECT_TRUE(bench.streamed);
    }
}

}  // namespace
}  // namespace skincal
