// What the live demo costs besides drawing: a second of the stream of 1,000 or 10,000 modules at 100 Hz, and 30 updates
// of the window from it. "ratio" is that cost in parts of the second.

#include <benchmark/benchmark.h>

#include <chrono>

#include "core/geometry/random.h"
#include "ui/presenters/tactile_picture.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

constexpr int kRate = 100;
constexpr int kUpdates = 30;
constexpr std::size_t kTraces = 4;
constexpr std::size_t kColumns = 250;

BodyModel bodyOf(unsigned modules) {
    BodyModel body;
    body.templates = {paperHexagon()};
    for (unsigned i = 1; i <= modules; ++i) {
        BodyModule& module = body.modules.emplace_back();
        module.id = ModuleId(i);
        module.type = "hex";
        module.T_body_module = Isometry3d(Eigen::Translation3d(0.03 * i, 0, 0));
    }
    return body;
}

TactileSample noisySample(unsigned modules) {
    Random random(1, "tactile benchmark");
    TactileSample sample;
    for (unsigned i = 1; i <= modules; ++i) {
        const auto noise = [&] { return static_cast<float>(0.01 * std::abs(random.normal())); };
        sample.readings.push_back(
            {ModuleId(i), noise(), {noise(), noise(), i % 50 == 0 ? 2.0F : noise()}, 24 + noise(), {noise(), 9.8F, 0}});
    }
    return sample;
}

void second(benchmark::State& state) {
    const auto count = static_cast<unsigned>(state.range(0));
    const BodyModel body = bodyOf(count);
    std::vector<ModuleId> modules;
    for (const BodyModule& module : body.modules)
        modules.push_back(module.id);
    TactileHistory history(modules);
    TactileSample sample = noisySample(count);
    TactilePicture picture;
    std::array<Trace, kTraces> traces;
    for (std::size_t i = 0; i < kTraces; ++i)
        traces.at(i).module = ModuleId(static_cast<unsigned>(100 * i + 50));
    // The memory is full, as it is after half a minute.
    for (int i = 0; i < 31 * kRate; ++i) {
        sample.time += 10ms;
        history.add(sample);
    }
    const auto began = std::chrono::steady_clock::now();
    for (auto _ : state) {
        int updates = 0;
        for (int i = 0; i < kRate; ++i) {
            sample.time += 10ms;
            history.add(sample);
            if ((i + 1) * kUpdates / kRate == updates)
                continue;
            ++updates;
            drawPicture(picture, history.at(history.size() - 1), Quantity::Force, body);
            for (Trace& trace : traces)
                drawTrace(trace, history, Quantity::Force, kColumns);
            benchmark::DoNotOptimize(picture.values.data());
        }
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    state.counters["ratio"] = took.count() / static_cast<double>(state.iterations());
}
BENCHMARK(second)->Arg(1000)->Arg(10'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skincal
