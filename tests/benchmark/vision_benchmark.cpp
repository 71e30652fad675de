#include <benchmark/benchmark.h>

#include <ctime>
#include <map>
#include <opencv2/core/utility.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/simulation/renderer.h"
#include "core/study/scan_study.h"
#include "core/vision/decoder.h"

// What a scan costs the computer, next to the paper's pipeline (difference, blur, threshold, blobs) on the same
// pictures. The argument is the number of modules in a picture of 1280 x 720.

namespace skincal {
namespace {

struct Pictures {
    std::vector<ModuleId> modules;
    std::vector<FrameInfo> frames;
    std::vector<cv::Mat> pictures;
};

const Pictures& picturesOf(std::size_t modules) {
    static std::map<std::size_t, Pictures> known;
    Pictures& result = known[modules];
    if (result.pictures.empty()) {
        World world = scanWorld({Disturbance::None, 0, modules, 0.8, ScanMethod::Coded}, 1);
        world.scenario.views.scan = ScanKind::Coded;
        result.frames = planScan(world, 1);
        const FrameRenderer renderer(world, 1, result.frames.size());
        for (const SkinModule& module : world.skin.modules)
            result.modules.push_back(module.id);
        for (std::size_t k = 0; k < result.frames.size(); ++k)
            result.pictures.push_back(renderer.render(result.frames[k].lit, k));
    }
    return result;
}

double threadSeconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Equations 10 to 13 for one pair of pictures.
void paperFrame(const cv::Mat& dark, const cv::Mat& lit) {
    cv::Mat difference;
    cv::subtract(lit, dark, difference);
    cv::GaussianBlur(difference, difference, cv::Size(9, 9), 2);
    double most = 0;
    cv::minMaxLoc(difference, nullptr, &most);
    cv::threshold(difference, difference, std::max(40.0, 0.5 * most), 255, cv::THRESH_BINARY);
    std::vector<cv::KeyPoint> blobs;
    cv::SimpleBlobDetector::Params parameters;
    parameters.filterByColor = true;
    parameters.blobColor = 255;
    parameters.minArea = 1;
    parameters.maxArea = 500;
    cv::SimpleBlobDetector::create(parameters)->detect(difference, blobs);
    benchmark::DoNotOptimize(blobs);
}

double paperSeconds(const Pictures& scan) {
    const double before = threadSeconds();
    for (std::size_t k = 1; k < scan.pictures.size(); ++k)
        paperFrame(scan.pictures[0], scan.pictures[k]);
    return (threadSeconds() - before) / static_cast<double>(scan.pictures.size() - 1);
}

/// One picture on its way into the maps that spots are looked for in.
void accumulate(benchmark::State& state) {
    cv::setNumThreads(1);
    const Pictures& scan = picturesOf(static_cast<std::size_t>(state.range(0)));
    const double paper = paperSeconds(scan);
    double seconds = 0;
    std::size_t frames = 0;
    for (auto _ : state) {
        SpotFinder finder;
        const double before = threadSeconds();
        for (const cv::Mat& picture : scan.pictures)
            finder.add(*FramePixels::make(picture, "", {}, false), false);
        seconds += threadSeconds() - before;
        frames += scan.pictures.size();
    }
    const double each = seconds / static_cast<double>(frames);
    state.counters["ms_per_frame"] = 1e3 * each;
    state.counters["paper_ms_per_frame"] = 1e3 * paper;
    state.counters["times_faster"] = paper / each;
}
BENCHMARK(accumulate)->Arg(55)->Arg(1000)->Unit(benchmark::kMillisecond);

/// All of decodeView, and what of it comes after the last picture.
void decode(benchmark::State& state) {
    cv::setNumThreads(-1);
    const Pictures& scan = picturesOf(static_cast<std::size_t>(state.range(0)));
    const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> { return scan.pictures[k]; };
    std::size_t found = 0;
    for (auto _ : state)
        found = decodeView("view", scan.modules, scan.frames, load)->found.size();
    state.counters["found"] = static_cast<double>(found);
    state.counters["pictures"] = static_cast<double>(scan.frames.size());
}
BENCHMARK(decode)->Arg(55)->Arg(1000)->Arg(10'000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace skincal
