// What the protocol costs: frames against copying the same bytes, the touch stream of a large skin on the computer's
// side in parts of the second that it takes, and a whole network brought up in simulated time.

#include <benchmark/benchmark.h>

#include <cstring>

#include "tests/unit/protocol/virtual_line.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

std::vector<std::uint8_t> stream(std::size_t frames, std::size_t payload) {
    std::vector<std::uint8_t> bytes;
    FrameHeader header;
    header.type = FrameType::Tactile;
    std::string text(payload, '\0');
    for (std::size_t i = 0; i < frames; ++i) {
        header.sequence = static_cast<std::uint16_t>(i);
        for (std::size_t k = 0; k < payload; ++k)
            text[k] = static_cast<char>(i * 7 + k * k);
        appendFrame(header, text, bytes);
    }
    return bytes;
}

double copyTime(const std::vector<std::uint8_t>& bytes) {
    std::vector<std::uint8_t> copy(bytes.size());
    const auto start = std::chrono::steady_clock::now();
    constexpr int kTimes = 50;
    for (int i = 0; i < kTimes; ++i) {
        std::memcpy(copy.data(), bytes.data(), bytes.size());
        benchmark::DoNotOptimize(copy.data());
        benchmark::ClobberMemory();
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / kTimes;
}

void report(benchmark::State& state, std::size_t frames, const std::vector<std::uint8_t>& bytes, double seconds) {
    state.counters["frames/s"] = static_cast<double>(frames) / seconds;
    state.counters["MB/s"] = 1e-6 * static_cast<double>(bytes.size()) / seconds;
    state.counters["times memcpy"] = seconds / copyTime(bytes);
}

void decode(benchmark::State& state) {
    constexpr std::size_t kFrames = 20'000;
    const auto bytes = stream(kFrames, static_cast<std::size_t>(state.range(0)));
    double seconds = 0;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        FrameDecoder decoder;
        std::size_t seen = 0;
        decoder.feed(bytes, [&](const FrameHeader&, std::string_view payload) { seen += payload.size(); });
        benchmark::DoNotOptimize(seen);
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    report(state, kFrames, bytes, seconds / static_cast<double>(state.iterations()));
}
BENCHMARK(decode)->Arg(10)->Arg(48)->Arg(200)->Unit(benchmark::kMillisecond);

void encode(benchmark::State& state) {
    constexpr std::size_t kFrames = 20'000;
    const std::string payload(static_cast<std::size_t>(state.range(0)), 'x');
    std::vector<std::uint8_t> bytes;
    double seconds = 0;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        bytes.clear();
        for (std::size_t i = 0; i < kFrames; ++i)
            appendFrame({}, payload, bytes);
        benchmark::DoNotOptimize(bytes.data());
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    report(state, kFrames, bytes, seconds / static_cast<double>(state.iterations()));
}
BENCHMARK(encode)->Arg(10)->Arg(48)->Arg(200)->Unit(benchmark::kMillisecond);

/// A second of 10,000 cells at 100 Hz, six to a frame, into a client that knows them. "ratio": of that second.
void touchSecond(benchmark::State& state) {
    const Skin skin = gridSkin(100, 100);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 1);
    if (!line.connect())
        throw std::logic_error("no skin");
    std::vector<std::uint8_t> bytes;
    FrameHeader header;
    header.type = FrameType::Tactile;
    header.direction = FrameDirection::Up;
    header.epoch = 1;
    header.count = 1;
    for (unsigned cell = 1; cell <= 10'000; cell += 6) {
        header.first = static_cast<std::uint16_t>(cell);
        std::string samples;
        for (unsigned i = cell; i < std::min(cell + 6, 10'001U); ++i) {
            std::string sample(20, '\1');
            sample[0] = static_cast<char>(i & 0xFF);
            sample[1] = static_cast<char>(i >> 8);
            samples += sample;
        }
        appendFrame(header, std::string("\x0A") + static_cast<char>(samples.size()) + samples, bytes);
    }
    double seconds = 0;
    for (auto _ : state) {
        line.notes.touches.clear();
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < 100; ++i) {
            line.notes.touches.clear();
            line.client.receive(bytes, line.network.now());
        }
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (line.notes.touches.size() != 10'000)
            throw std::logic_error("touches are missing");
    }
    state.counters["ratio"] = seconds / static_cast<double>(state.iterations());
}
BENCHMARK(touchSecond)->Unit(benchmark::kMillisecond);

/// Everything that a calibration asks of a skin but the camera's time, at 3 Mbaud: seconds of simulated time.
void bringUp(benchmark::State& state) {
    const auto side = static_cast<std::size_t>(state.range(0));
    WireFaults faults;
    faults.byteErrors = static_cast<double>(state.range(1)) * 1e-4;
    const Skin skin = gridSkin(side, side);
    std::uint64_t seed = 0;
    for (auto _ : state) {
        VirtualLine line(skin, skin.hostLinks.front(), faults, ++seed);
        const auto seconds = [&] { return 1e-6 * static_cast<double>(line.network.now().count()); };
        if (!line.connect())
            throw std::logic_error("no skin");
        state.counters["explored_s"] = seconds();
        const std::size_t cells = line.client.cells();
        std::vector<std::vector<LitCell>> sets;
        for (int k = 0; k < 30; ++k) {
            sets.emplace_back();
            for (std::size_t i = 1; i <= cells; ++i)
                if ((i * 2654435761U >> k) & 1U)
                    sets.back().push_back({static_cast<CellNumber>(i), 7});
        }
        line.client.prepare(sets);
        double before = seconds();
        std::uint64_t token = 0;
        for (const auto& set : sets) {
            line.client.light(set, ++token, line.network.now());
            if (!line.runUntil([&] { return line.notes.shown == token; }, 20s))
                throw std::logic_error("a pattern was not shown");
        }
        state.counters["scan_s"] = seconds() - before;
        before = seconds();
        line.client.measureRest(300ms, line.network.now());
        if (!line.runUntil([&] { return line.notes.restCame; }, 60s))
            throw std::logic_error("no pose");
        state.counters["pose_s"] = seconds() - before;
        state.counters["missing"] = static_cast<double>(line.notes.restMissing.size());
        state.counters["all_s"] = seconds();
    }
}
BENCHMARK(bringUp)
    ->ArgsProduct({{10, 32, 100}, {0, 10}})
    ->ArgNames({"side", "byte errors, 1e-4"})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace skincal
