#include "ui/presenters/picture_series.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <set>

#include "tests/wait_for.h"

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

TEST(PictureSeries, KeepsNoPictureThatWasExposedBeforeItsLightShowed) {
    Workbench workbench;
    workbench.skinOffers.push_back({"skin", "", [] { return std::make_unique<PatientSkin>(); }});
    workbench.cameraOffers.push_back({"camera", "", [] { return std::make_unique<LateCamera>(); }});
    workbench.chooseSkin(0);
    workbench.chooseCamera(0);
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
