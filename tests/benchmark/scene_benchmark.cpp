// Frames of the live demo on the whole of a screen: the values and heights of all modules change and the camera goes
// round between any two. "ratio" is what a frame takes in parts of one of the empty view, drawn in turn with it.

#include <benchmark/benchmark.h>

#include <QApplication>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>

#include "app/headless_display.h"
#include "tests/ui/scene3d/sample_body.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/scene_widget.h"

namespace skincal {
namespace {

constexpr QSize kScreen(1280, 800);
constexpr float kHeight = 0.012F;  // m

double spent(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Sums over many frames, s.
struct Cost {
    double wall = 0, thread = 0, process = 0;

    template <class Frame>
    void add(const Frame& frame) {
        const double wallBefore = spent(CLOCK_MONOTONIC);
        const double threadBefore = spent(CLOCK_THREAD_CPUTIME_ID);
        const double processBefore = spent(CLOCK_PROCESS_CPUTIME_ID);
        frame();
        wall += spent(CLOCK_MONOTONIC) - wallBefore;
        thread += spent(CLOCK_THREAD_CPUTIME_ID) - threadBefore;
        process += spent(CLOCK_PROCESS_CPUTIME_ID) - processBefore;
    }
};

void settle(BodyViewWidget& view) {
    view.resize(kScreen);
    view.show();
    while (view.scene().framesDrawn() < 3) {
        view.scene().requestDraw();
        QApplication::processEvents(QEventLoop::WaitForMoreEvents);
    }
}

void draw(BodyViewWidget& view) {
    view.scene().orbit(0.02, 0);
    view.scene().drawNow();
    view.scene().repaint();
}

void frame(benchmark::State& state) {
    BodyViewWidget empty;
    settle(empty);
    BodyViewWidget view;
    const auto cells = static_cast<std::size_t>(state.range(0));
    view.setBody(shared(sheetOf(cells)));
    view.setColourMode(ColourMode::Values);
    settle(view);
    std::vector<float> values(cells);
    std::vector<float> heights(cells);
    Cost nothing;
    Cost all;
    float time = 0;
    for (auto _ : state) {
        nothing.add([&] { draw(empty); });
        all.add([&] {
            time += 0.2F;
            for (std::size_t i = 0; i < cells; ++i) {
                values[i] = 0.5F + 0.5F * std::sin(time + 0.05F * static_cast<float>(i));
                heights[i] = kHeight * values[i];
            }
            view.setCellValues(values);
            view.setCellHeights(heights);
            draw(view);
        });
    }
    if (view.scene().framesDrawn() < state.iterations())
        state.SkipWithError("not every frame was drawn");
    const double ms = 1e3 / static_cast<double>(state.iterations());
    state.counters["frames/s"] = 1e3 / (ms * all.wall);
    state.counters["gui_ms"] = ms * all.thread;
    state.counters["process_ms"] = ms * all.process;
    state.counters["ratio"] = all.process / nothing.process;
}
BENCHMARK(frame)->Arg(100)->Arg(1000)->Arg(10000)->Iterations(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skincal

int main(int argc, char** argv) {
    ::unsetenv("DISPLAY");
    const skincal::HeadlessDisplay display;
    if (!display.complaint().empty()) {
        std::cerr << display.complaint() << '\n';
        return 1;
    }
    ::setenv("QT_QPA_PLATFORM", "xcb", 1);
    const QApplication application(argc, argv);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
