#include "core/camera/video_source.h"

#include <gtest/gtest.h>

#include <QImage>
#include <QVideoFrame>
#include <QVideoSink>
#include <cstring>
#include <opencv2/core.hpp>
#include <set>
#include <thread>

#include "core/camera/video_frame_picture.h"
#include "tests/fixtures/virtual_camera/virtual_camera.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::waitFor;

QVideoFrame frameOf(int width, int height, std::uint64_t k, qint64 time = -1) {
    QVideoFrame frame(QVideoFrameFormat({width, height}, QVideoFrameFormat::Format_Y8));
    EXPECT_TRUE(frame.map(QVideoFrame::WriteOnly));
    const auto luma = test::noisyLuma(width, height, k);
    for (int row = 0; row < height; ++row)
        std::memcpy(frame.bits(0) + row * frame.bytesPerLine(0), luma.data() + row * width,
                    static_cast<std::size_t>(width));
    frame.unmap();
    frame.setStartTime(time);
    return frame;
}

/// A source whose frames the test puts into its sink.
struct FedSource : VideoSource {
    FedSource() {
        QObject::connect(this, &FrameSource::frameArrived, this,
                         [this](const CameraFrame& frame) { frames.push_back(frame); });
        QObject::connect(this, &FrameSource::failed, this, [this](const QString& text) {
            why = text;
            heard.emplace_back("failed");
        });
        QObject::connect(this, &FrameSource::stopped, this, [this] { heard.emplace_back("stopped"); });
    }
    ~FedSource() override { stop(); }

    [[nodiscard]] QString name() const override { return {}; }
    [[nodiscard]] std::vector<FrameFormat> formats() const override { return {}; }
    [[nodiscard]] FrameFormat format() const override { return {}; }
    void setFormat(const FrameFormat&) override {}
    [[nodiscard]] std::optional<std::pair<double, double>> exposureRange() const override { return {}; }
    [[nodiscard]] std::optional<double> exposure() const override { return {}; }
    void setExposure(double) override {}
    void start() override { begin(sink, options); }
    void close() override { ++closed; }
    void accepted(const CameraFrame&) override {}
    CameraFailure explained(CameraTrouble trouble) override { return {trouble, QStringLiteral("here")}; }
    using VideoSource::fail;

    QVideoSink sink;
    RunOptions options;
    std::vector<CameraFrame> frames;
    std::vector<std::string> heard;
    QString why;
    int closed = 0;
};

TEST(VideoSource, PassesTheNewestFrameOnAndQueuesNone) {
    FedSource source;
    source.start();
    for (std::uint64_t k = 0; k < 10; ++k)
        source.sink.setVideoFrame(frameOf(64, 48, k));
    ASSERT_TRUE(waitFor([&] { return !source.frames.empty(); }));
    QCoreApplication::processEvents();
    ASSERT_EQ(source.frames.size(), 1U);
    const auto newest = test::noisyLuma(64, 48, 9);
    EXPECT_EQ(std::memcmp(source.frames[0].image.data, newest.data(), newest.size()), 0);
}

TEST(VideoSource, TakesFramesFromAnyThread) {
    FedSource source;
    source.start();
    std::thread other([&] {
        for (std::uint64_t k = 0; k < 500; ++k)
            source.sink.setVideoFrame(frameOf(64, 48, k));
    });
    const auto newest = test::noisyLuma(64, 48, 499);
    EXPECT_TRUE(waitFor([&] {
        return !source.frames.empty() &&
               std::memcmp(source.frames.back().image.data, newest.data(), newest.size()) == 0;
    }));
    other.join();
}

TEST(VideoSource, RefusesFramesOfAnotherSizeAndSaysSoInTheEnd) {
    FedSource source;
    source.options.watchdog.width = 64;
    source.options.watchdog.height = 48;
    source.options.watchdog.firstPicture = std::chrono::milliseconds(300);
    source.start();
    std::uint64_t k = 0;
    QTimer feeder;
    QObject::connect(&feeder, &QTimer::timeout, &feeder, [&] { source.sink.setVideoFrame(frameOf(65, 48, ++k)); });
    feeder.start(10);
    ASSERT_TRUE(waitFor([&] { return source.heard.size() >= 2; }));
    EXPECT_EQ(source.heard, (std::vector<std::string>{"failed", "stopped"}));
    EXPECT_TRUE(source.frames.empty());
    EXPECT_EQ(source.failure()->trouble, CameraTrouble::WrongSize);
    EXPECT_GE(source.refused()[static_cast<std::size_t>(FrameFault::WrongSize)], 1U);
    EXPECT_EQ(source.closed, 1);
    EXPECT_TRUE(source.why.contains("size"));
}

TEST(VideoSource, CountsAndDatesByTheFramesOwnTime) {
    FedSource source;
    source.options.period = std::chrono::milliseconds(40);
    source.options.lead = std::chrono::milliseconds(0);
    source.start();
    std::size_t count = 0;
    for (const int at : {0, 40, 160, 200}) {
        // As real frames come, none before its time; what is early is dated from its arrival.
        source.sink.setVideoFrame(frameOf(64, 48, static_cast<std::uint64_t>(at) + 1, 1000 * at));
        ++count;
        ASSERT_TRUE(waitFor([&] { return source.frames.size() == count; }));
        std::this_thread::sleep_for(std::chrono::milliseconds(at == 40 ? 130 : 50));
    }
    EXPECT_EQ(source.frames[1].sequence, source.frames[0].sequence + 1);
    EXPECT_EQ(source.frames[2].sequence, source.frames[0].sequence + 4);
    EXPECT_EQ(source.frames[3].sequence, source.frames[0].sequence + 5);
    EXPECT_LE(source.frames[3].time, source.now());
}

TEST(VideoSource, KeepsTheFirstToItself) {
    FedSource source;
    source.options.warmUp = 3;
    source.start();
    for (std::uint64_t k = 1; source.frames.empty() && k < 10; ++k) {
        source.sink.setVideoFrame(frameOf(64, 48, k));
        QCoreApplication::processEvents();
    }
    ASSERT_EQ(source.frames.size(), 1U);
    const auto fourth = test::noisyLuma(64, 48, 4);
    EXPECT_EQ(std::memcmp(source.frames[0].image.data, fourth.data(), fourth.size()), 0);
}

TEST(VideoSource, PassesNothingOnOnceItIsStopped) {
    FedSource source;
    source.start();
    source.sink.setVideoFrame(frameOf(64, 48, 1));
    source.stop();
    source.sink.setVideoFrame(frameOf(64, 48, 2));
    ASSERT_TRUE(waitFor([&] { return !source.heard.empty(); }));
    QCoreApplication::processEvents();
    EXPECT_TRUE(source.frames.empty());
    EXPECT_EQ(source.heard, std::vector<std::string>{"stopped"});
    source.stop();
    QCoreApplication::processEvents();
    EXPECT_EQ(source.heard.size(), 1U);
    EXPECT_EQ(source.closed, 1);
}

TEST(VideoSource, StartedAgainDoesNotHearOfTheFailureBefore) {
    FedSource source;
    source.start();
    source.fail({CameraTrouble::Busy, QStringLiteral("/dev/video0"), QStringLiteral("text")});
    source.start();
    EXPECT_FALSE(source.failure());
    QCoreApplication::processEvents();
    EXPECT_TRUE(source.heard.empty());
    source.fail({CameraTrouble::Busy, QStringLiteral("/dev/video0"), QStringLiteral("text")});
    ASSERT_TRUE(waitFor([&] { return source.heard.size() == 2; }));
    EXPECT_EQ(source.why, "another program uses the camera: /dev/video0: text");
}

TEST(VideoSource, HasAShortReasonForEveryTrouble) {
    std::set<QString> reasons;
    for (int trouble = 0; trouble <= static_cast<int>(CameraTrouble::Ended); ++trouble)
        reasons.insert(shortReason({static_cast<CameraTrouble>(trouble)}));
    EXPECT_EQ(reasons.size(), static_cast<std::size_t>(CameraTrouble::Ended) + 1);
}

TEST(VideoFramePicture, IsConvertedWhereItHasNoLuma) {
    QImage image(64, 48, QImage::Format_RGB32);
    image.fill(QColor(10, 20, 30));
    QVideoFrame frame(QVideoFrameFormat({64, 48}, QVideoFrameFormat::Format_BGRA8888));
    ASSERT_TRUE(frame.map(QVideoFrame::WriteOnly));
    for (int row = 0; row < 48; ++row)
        std::memcpy(frame.bits(0) + row * frame.bytesPerLine(0), image.constScanLine(row), 64 * 4);
    frame.unmap();
    const cv::Mat picture = pictureOf(frame);
    ASSERT_EQ(picture.type(), CV_8UC3);
    EXPECT_EQ(picture.at<cv::Vec3b>(47, 63), cv::Vec3b(30, 20, 10));
}

TEST(VideoFramePicture, IsEmptyWhereThereIsNone) {
    EXPECT_TRUE(pictureOf(QVideoFrame()).empty());
}

}  // namespace
}  // namespace skincal
