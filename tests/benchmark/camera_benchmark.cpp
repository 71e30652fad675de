#include <benchmark/benchmark.h>

#include <QGuiApplication>
#include <QImage>
#include <QVideoFrame>
#include <cstring>

#include "core/camera/frame_watchdog.h"
#include "core/camera/video_frame_picture.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

QVideoFrame frameOf(QVideoFrameFormat::PixelFormat format, int width, int height) {
    QVideoFrame frame(QVideoFrameFormat({width, height}, format));
    frame.map(QVideoFrame::WriteOnly);
    Random random(1);
    for (int plane = 0; plane < frame.planeCount(); ++plane) {
        for (int byte = 0; byte < frame.mappedBytes(plane); ++byte)
            frame.bits(plane)[byte] = static_cast<std::uint8_t>(random.bits());
    }
    frame.unmap();
    return frame;
}

/// A frame's luma in memory of its own.
void readsLuma(benchmark::State& state, QVideoFrameFormat::PixelFormat format) {
    const auto width = static_cast<int>(state.range(0));
    const QVideoFrame frame = frameOf(format, width, width * 9 / 16);
    for (auto _ : state)
        benchmark::DoNotOptimize(pictureOf(frame));
}
BENCHMARK_CAPTURE(readsLuma, I420, QVideoFrameFormat::Format_YUV420P)->Arg(640)->Arg(1280)->Arg(1920);
BENCHMARK_CAPTURE(readsLuma, YUYV, QVideoFrameFormat::Format_YUYV)->Arg(640)->Arg(1280)->Arg(1920);
BENCHMARK_CAPTURE(readsLuma, BGRA, QVideoFrameFormat::Format_BGRA8888)->Arg(640)->Arg(1280)->Arg(1920);

/// What it would cost by way of Qt's image, which a frame makes once.
void convertsToImage(benchmark::State& state) {
    const auto width = static_cast<int>(state.range(0));
    for (auto _ : state) {
        state.PauseTiming();
        const QVideoFrame frame = frameOf(QVideoFrameFormat::Format_YUV420P, width, width * 9 / 16);
        state.ResumeTiming();
        benchmark::DoNotOptimize(frame.toImage());
    }
}
BENCHMARK(convertsToImage)->Arg(640)->Arg(1280)->Arg(1920)->Iterations(20);

/// Judging a picture, and one that agrees with the one before but for its last pixel: all of it is compared.
void judges(benchmark::State& state, bool isAlike) {
    const auto width = static_cast<int>(state.range(0));
    const cv::Mat first = pictureOf(frameOf(QVideoFrameFormat::Format_Y8, width, width * 9 / 16));
    cv::Mat second = first.clone();
    (isAlike ? second.data[second.total() - 1] : second.data[0]) ^= 1;
    FrameWatchdog watchdog({}, FrameWatchdog::Time(0));
    FrameWatchdog::Time now{};
    std::uint64_t k = 0;
    for (auto _ : state) {
        now += FrameWatchdog::Time(33'333);
        const auto fault = watchdog.judge({++k % 2 == 0 ? first : second, now, k}, now);
        if (fault)
            state.SkipWithError("a good picture was refused");
    }
}
BENCHMARK_CAPTURE(judges, different, false)->Arg(1920);
BENCHMARK_CAPTURE(judges, alike, true)->Arg(1920);

}  // namespace
}  // namespace skincal

int main(int argc, char** argv) {
    qputenv("QT_QPA_PLATFORM", "offscreen");
    const QGuiApplication app(argc, argv);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
