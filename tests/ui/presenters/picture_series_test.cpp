#include "ui/presenters/picture_series.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <iostream>
#include <set>

#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using Time = std::chrono::microseconds;

class PatientSkin : public SkinDevice {
  public:
    [[nodiscard]] QString name() const override { return QStringLiteral("skin"); }
    void open() override {}
    void close() override {}
    void explore() override {}
    void streamAcceleration(bool) override {}
    void streamTactile(bool) override {}
    std::uint64_t light(const std::vector<LitModule>&) override { return ++token_; }
    void show() { emit lightShown(token_); }

  private:
    std::uint64_t token_ = 0;
};

/// Its pictures come when the test says, with the time that the test says.
class LateCamera : public FrameSource {
  public:
    [[nodiscard]] QString name() const override { return QStringLiteral("camera"); }
    [[nodiscard]] std::vector<FrameFormat> formats() const override { return {format()}; }
    [[nodiscard]] FrameFormat format() const override { return {8, 6, 30}; }
    void setFormat(const FrameFormat&) override {}
    [[nodiscard]] std::optional<std::pair<double, double>> exposureRange() const override { return std::nullopt; }
    [[nodiscard]] std::optional<double> exposure() const override { return std::nullopt; }
    void setExposure(double) override {}
    [[nodiscard]] Time now() const override { return now_; }
    void start() override {}
    void stop() override {}
    void deliver(Time exposed) {
        emit frameArrived({cv::Mat(6, 8, CV_8U, cv::Scalar(static_cast<double>(exposed / 1ms % 256))), exposed, 0});
    }
    Time now_{10s};
};

/// A video, in which nothing moves.
class StillVideo : public LateCamera {
  public:
    [[nodiscard]] bool mayStandStill() const override { return true; }
    void deliver(Time exposed) { emit frameArrived({cv::Mat(6, 8, CV_8U, cv::Scalar(7)), exposed, 0}); }
};

TEST(PictureSeries, KeepsPicturesOfAVideoThoughNothingMoves) {
    Workbench workbench;
    workbench.skinOffers.push_back({"skin", "", [] { return std::make_unique<PatientSkin>(); }});
    workbench.cameraOffers.push_back({"video", "", [] { return std::make_unique<StillVideo>(); }});
    workbench.chooseSkin(0);
    workbench.chooseCamera(0);
    workbench.noteCameraLag(50ms);  // as a scan before found
    auto& skin = static_cast<PatientSkin&>(*workbench.skin());
    auto& video = static_cast<StillVideo&>(*workbench.camera());
    PictureSeries series(workbench);
    const QSignalSpy kept(&series, &PictureSeries::kept);
    series.start({{}, {{ModuleId(1), {}}}});
    for (int frame = 0; frame < 2; ++frame) {
        video.now_ += 1s;
        skin.show();
        video.deliver(video.now_);
        video.deliver(video.now_ + 150ms);
        EXPECT_EQ(kept.count(), frame + 1);
    }
    series.finish();
}

TEST(PictureSeries, KeepsNoPictureThatWasExposedBeforeItsLightShowed) {
    Workbench workbench;
    workbench.skinOffers.push_back({"skin", "", [] { return std::make_unique<PatientSkin>(); }});
    workbench.cameraOffers.push_back({"camera", "", [] { return std::make_unique<LateCamera>(); }});
    workbench.chooseSkin(0);
    workbench.chooseCamera(0);
    workbench.noteCameraLag(50ms);  // as a scan before found
    auto& skin = static_cast<PatientSkin&>(*workbench.skin());
    auto& camera = static_cast<LateCamera&>(*workbench.camera());
    PictureSeries series(workbench);
    const QSignalSpy kept(&series, &PictureSeries::kept);
    const QSignalSpy complete(&series, &PictureSeries::complete);
    series.start({{}, {{ModuleId(1), {}}}});
    for (int frame = 0; frame < 2; ++frame) {
        camera.now_ += 1s;
        skin.show();
        // On their way for long: what comes now was exposed before, the newest just as the light began to show.
        for (const Time late : {Time(900ms), Time(300ms), Time(40ms), Time(0ms)}) {
            camera.deliver(camera.now_ - late);
            EXPECT_EQ(kept.count(), frame);
        }
        camera.deliver(camera.now_ + 150ms);
        EXPECT_EQ(kept.count(), frame + 1);
    }
    EXPECT_EQ(complete.count(), 1);
    EXPECT_TRUE(series.isBusy());
    series.finish();
    EXPECT_FALSE(series.isBusy());
}

TEST(PictureSeries, TimeLeftIsThePaceOfThePicturesWithoutPauses) {
    Workbench workbench;
    workbench.skinOffers.push_back({"skin", "", [] { return std::make_unique<PatientSkin>(); }});
    workbench.cameraOffers.push_back({"camera", "", [] { return std::make_unique<LateCamera>(); }});
    workbench.chooseSkin(0);
    workbench.chooseCamera(0);
    workbench.noteCameraLag(50ms);  // as a scan before found
    auto& skin = static_cast<PatientSkin&>(*workbench.skin());
    auto& camera = static_cast<LateCamera&>(*workbench.camera());
    PictureSeries series(workbench);
    series.start({{}, {{ModuleId(1), {}}}, {}, {{ModuleId(2), {}}}, {}});
    EXPECT_FALSE(series.timeLeft()) << "there is no pace yet";
    const auto takeOne = [&] {
        camera.now_ += 1s;
        skin.show();
        camera.now_ += 150ms;
        camera.deliver(camera.now_);
    };
    takeOne();
    ASSERT_TRUE(series.timeLeft());
    EXPECT_EQ(*series.timeLeft(), 4 * 1150ms);
    takeOne();
    EXPECT_EQ(*series.timeLeft(), 3 * 1150ms);
    for (int pause = 0; pause < 2; ++pause) {
        series.pause();
        EXPECT_FALSE(series.timeLeft()) << "nobody knows when it goes on";
        camera.now_ += 1h;
        series.resume();
        EXPECT_EQ(*series.timeLeft(), 3 * 1150ms) << "the hour is no part of the pace";
    }
    takeOne();
    EXPECT_EQ(*series.timeLeft(), 2 * 1150ms);
    // The next one has a pace of its own.
    series.pause();
    camera.now_ += 1h;
    series.cancel();
    series.start({{}, {{ModuleId(1), {}}}, {}});
    takeOne();
    EXPECT_EQ(*series.timeLeft(), 2 * 1150ms);
}

/// Takes all pictures of a coded scan and looks whether each shows its pattern, and nothing of another.
class TimedSeries {
  public:
    explicit TimedSeries(const char* scenario, std::uint64_t seed = 1) : desk(*findScenario(scenario), seed) {
        EXPECT_TRUE(desk.connectSkin());
        EXPECT_TRUE(desk.startCamera());
        series = std::make_unique<PictureSeries>(desk.workbench);
        QObject::connect(desk.workbench.camera(), &FrameSource::frameArrived, series.get(), [this] {
            if (series->state().phase == ScanRun::Phase::Streaming)
                periods = series->state().plan->periods;
        });
        QObject::connect(series.get(), &PictureSeries::kept, series.get(),
                         [this](std::size_t k) { order.push_back(k); });
    }
    /// How long it takes by the rig's clock; nothing where it fails.
    [[nodiscard]] std::optional<Time> take(std::uint64_t words) {
        const Time began = desk.rig.now();
        order.clear();
        periods = 0;
        series->start(codedScan(modules(), words));
        const auto phase = [&] { return series->state().phase; };
        if (!test::waitFor([&] { return !series->state().isRunning(); }) || phase() != ScanRun::Phase::Decoding)
            return std::nullopt;
        const Time took = desk.rig.now() - began;
        compare();
        if (!isExtended)
            series->finish();
        return took;
    }
    [[nodiscard]] std::vector<ModuleId> modules() const {
        std::vector<ModuleId> modules;
        for (const SkinModule& module : desk.rig.world().skin.modules)
            modules.push_back(module.id);
        return modules;
    }
    /// After a first scan that is not finished yet.
    [[nodiscard]] bool takeMore(const LitSets& more) {
        series->extend(more);
        const auto phase = [&] { return series->state().phase; };
        if (!test::waitFor([&] { return !series->state().isRunning(); }) || phase() != ScanRun::Phase::Decoding)
            return false;
        compare();
        return true;
    }
    void compare() {
        auto taken = series->taken();
        frames = std::move(taken.frames);
        pictures = std::move(taken.pictures);
        for (const FrameInfo& frame : frames) {
            const auto time = std::chrono::round<Time>(std::chrono::duration<double>(*frame.time_s));
            const auto during = desk.rig.litDuring(time);
            wrong += during.size() == 1 && sameLit(during.front().lit, frame.lit) ? 0 : 1;
        }
    }

    test::Desk desk;
    std::unique_ptr<PictureSeries> series;
    bool isExtended = false;  ///< the scan is not over after take()
    int wrong = 0;
    int periods = 0;
    std::vector<std::size_t> order;
    std::vector<FrameInfo> frames;
    std::shared_ptr<const Pictures> pictures;

  private:
    static bool sameLit(const std::vector<LitModule>& a, const std::vector<LitModule>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](const LitModule& x, const LitModule& y) { return x.module == y.module; });
    }
};

TEST(PictureSeries, TakesThreeSecondsForAThousandModules) {
    TimedSeries timed("thousand");
    const auto took = timed.take(0);
    ASSERT_TRUE(took);
    EXPECT_EQ(timed.frames.size(), 32U);
    EXPECT_EQ(timed.wrong, 0);
    EXPECT_EQ(timed.periods, 2);
    EXPECT_LE(*took, 3s);
    std::cout << "32 pictures of 1,000 modules in " << *took / 1ms << " ms of the camera's time\n";
}

TEST(PictureSeries, HowLateACameraIsSaysNothingOfAnother) {
    TimedSeries timed("coded");
    EXPECT_EQ(timed.desk.workbench.cameraLag(), 0us) << "nothing has told yet";
    ASSERT_TRUE(timed.take(0));
    EXPECT_GT(timed.desk.workbench.cameraLag(), 50ms);
    timed.desk.workbench.chooseCamera(1);
    timed.series->cancel();
    EXPECT_EQ(timed.desk.workbench.cameraLag(), 0us);
}

TEST(PictureSeries, TakesMoreWithoutTimingLightAgain) {
    TimedSeries timed("coded");
    timed.isExtended = true;
    ASSERT_TRUE(timed.take(0));
    const std::size_t first = timed.frames.size();
    const int timings = timed.series->state().timings;
    const std::vector<ModuleId> modules = timed.modules();
    const LitSets more = codedScan(std::span(modules).first(9), 1);
    ASSERT_TRUE(timed.takeMore(more));
    EXPECT_EQ(timed.wrong, 0);
    EXPECT_EQ(timed.frames.size(), first + more.size());
    EXPECT_EQ(timed.series->state().timings, timings);
    EXPECT_EQ(timed.series->state().phase, ScanRun::Phase::Decoding);
    EXPECT_EQ(timed.order.size(), first + more.size());
    EXPECT_TRUE(std::is_sorted(timed.order.begin(), timed.order.end()));
    for (std::size_t k = 1; k < timed.frames.size(); ++k)
        EXPECT_LT(*timed.frames[k - 1].time_s, *timed.frames[k].time_s);
    timed.series->finish();
    timed.series->extend(more);
    EXPECT_EQ(timed.series->state().phase, ScanRun::Phase::Done) << "what is done is not taken up again";
}

TEST(PictureSeries, TakesNoPictureForAnotherWhateverTheCameraIsLike) {
    Random random(1, "cameras");
    TimedSeries timed("coded");
    auto& camera = static_cast<SimulatedCamera&>(*timed.desk.workbench.camera());
    for (int run = 0; run < 12; ++run) {
        const auto ms = [&](int low, int high) {
            return std::chrono::milliseconds(low +
                                             static_cast<int>(random.index(static_cast<std::size_t>(high - low))));
        };
        timed.desk.rig.setShutter({});
        timed.desk.rig.setCameraLatency(ms(20, 250));
        const auto longest = static_cast<int>(std::min<Time>(timed.desk.rig.cameraLatency(), 50ms) / 1ms);
        const auto length = ms(1, longest);
        const auto open = ms(0, static_cast<int>(length.count()));
        timed.desk.rig.setShutter({open, length - open});
        camera.setLosses(run % 2 == 0 ? 0 : 0.05, run % 3 == 0 ? 0 : 0.05);
        // Another latency is another camera: what the last one saw is over.
        pass(timed.desk.rig.clock(), 500ms);
        const auto took = timed.take(static_cast<std::uint64_t>(run));
        ASSERT_TRUE(took) << run;
        EXPECT_GE(timed.periods, 2) << "it was light that could not be timed";
        EXPECT_EQ(timed.wrong, 0) << run;
        // Live spots need them in order, recordings as they were taken.
        EXPECT_TRUE(std::is_sorted(timed.order.begin(), timed.order.end()));
        EXPECT_EQ(timed.order.size(), timed.frames.size());
        for (std::size_t k = 1; k < timed.frames.size(); ++k)
            EXPECT_LT(*timed.frames[k - 1].time_s, *timed.frames[k].time_s);
        // What was repeated shows by its pixels alone.
        const World& world = timed.desk.rig.world();
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const auto pixel = visiblePixel(world, 0, u);
            if (!pixel)
                continue;
            const cv::Point place(cvRound(pixel->x()), cvRound(pixel->y()));
            int dimmest = 255;
            int brightest = 0;
            for (std::size_t k = 0; k < timed.frames.size(); ++k) {
                const auto& lit = timed.frames[k].lit;
                const bool on = std::any_of(lit.begin(), lit.end(), [&](const LitModule& one) {
                    return one.module == world.skin.modules[u].id;
                });
                const int level = (*timed.pictures)[k].at<unsigned char>(place);
                if (on)
                    dimmest = std::min(dimmest, level);
                else
                    brightest = std::max(brightest, level);
            }
            EXPECT_GT(dimmest, brightest + 10) << run;
        }
    }
}

TEST(PictureSeries, HasASentenceForEveryFault) {
    using Fault = ScanRun::Fault;
    ScanRun run;
    EXPECT_TRUE(sentenceOf(run, "late words").isEmpty());
    std::set<QString> sentences;
    for (const Fault fault : {Fault::SkinSilent, Fault::CameraSilent, Fault::SkinGone, Fault::OtherSkin,
                              Fault::OtherCamera, Fault::CameraFailed, Fault::NotDecoded}) {
        run.fault = fault;
        sentences.insert(sentenceOf(run, {}));
    }
    EXPECT_EQ(sentences.size(), 7U);
    EXPECT_FALSE(sentences.contains(QString()));
    EXPECT_EQ(sentenceOf(run, "no spots"), "no spots");
}

}  // namespace
}  // namespace skincal
