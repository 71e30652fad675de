// The simulated webcam at 1280x720 with 200 LEDs lit, against the plainest way to a noisy picture: OpenCV's own random
// numbers added to the same background. Counter `ratio` is that baseline's time over ours, in the same run.

#include <benchmark/benchmark.h>

#include <chrono>
#include <opencv2/core.hpp>

#include "core/simulation/renderer.h"

namespace {

using namespace skincal;

World worldOf200() {
    Scenario scenario = *findScenario("plane");
    scenario.patches.clear();
    for (int k = 0; k < 4; ++k) {
        PatchPlan plan;
        plan.modules = 50;
        plan.offset = {0.25 * (k % 2), 0.25 * (k / 2)};
        scenario.patches.push_back(plan);
    }
    scenario.views.count = 1;
    scenario.views.distance = 1.0;
    return buildWorld(scenario, 1);
}

cv::Mat noisyCopy(const cv::Mat& background) {
    cv::Mat noise(background.size(), CV_32F);
    cv::randn(noise, 0, 1.5);
    cv::Mat picture;
    cv::add(background, noise, picture, cv::noArray(), CV_8U);
    return picture;
}

void renderFrame(benchmark::State& state) {
    const World world = worldOf200();
    const FrameRenderer renderer(world, 0, 100);
    std::vector<LitModule> lit;
    for (const SkinModule& module : world.skin.modules)
        lit.push_back({module.id, std::nullopt});
    std::size_t frame = 0;
    double ours = 0;
    double baseline = 0;
    const cv::Mat background(720, 1280, CV_32F, cv::Scalar(70));
    const auto seconds = [](auto start) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        benchmark::DoNotOptimize(renderer.render(lit, frame++).data);
        const double elapsed = seconds(start);
        state.SetIterationTime(elapsed);
        ours += elapsed;
        const auto then = std::chrono::steady_clock::now();
        benchmark::DoNotOptimize(noisyCopy(background).data);
        baseline += seconds(then);
    }
    state.counters["frames/s"] = static_cast<double>(frame) / ours;
    state.counters["ratio"] = baseline / ours;
}
BENCHMARK(renderFrame)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
