#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/geometry/random.h"
#include "core/simulation/world.h"

namespace skincal {
namespace {

using Word = std::uint32_t;

/// Words of `bits` bits, no two nearer than `distance`, none all on or off, in order of value.
std::vector<Word> distinctWords(std::size_t count, int bits, int distance) {
    std::vector<Word> words;
    for (Word word = 1; word + 1 < (Word{1} << static_cast<unsigned>(bits)) && words.size() < count; ++word) {
        const bool far = std::all_of(words.begin(), words.end(),
                                     [&](Word other) { return std::popcount(word ^ other) >= distance; });
        if (far)
            words.push_back(word);
    }
    return words;
}

/// As few bits as give every module a word that differs from all others in two bits.
std::vector<Word> codeBook(std::size_t modules, int& bits) {
    constexpr int kDistance = 2;
    for (bits = 3;; ++bits) {
        auto words = distinctWords(modules, bits, kDistance);
        if (words.size() == modules)
            return words;
    }
}

class ScanWriter {
  public:
    explicit ScanWriter(std::size_t view) : view_(view) {}
    void add(std::vector<LitModule> lit) {
        FrameInfo frame;
        frame.file = fmt::format("views/{:03}/{:05}.png", view_, frames_.size());
        frame.lit = std::move(lit);
        frame.time_s = static_cast<double>(frames_.size()) / 30.0;
        frames_.push_back(std::move(frame));
    }
    std::vector<FrameInfo> take() { return std::move(frames_); }

  private:
    std::size_t view_;
    std::vector<FrameInfo> frames_;
};

std::vector<FrameInfo> planCoded(const World& world, std::size_t view) {
    int bits = 0;
    auto words = codeBook(world.skin.modules.size(), bits);
    Random random(world.seed, "words");
    for (std::size_t i = words.size(); i > 1; --i)
        std::swap(words[i - 1], words[random.index(i)]);
    ScanWriter scan(view);
    std::vector<LitModule> all;
    for (const SkinModule& module : world.skin.modules)
        all.push_back({module.id, std::nullopt});
    scan.add({});
    scan.add(all);
    for (int bit = 0; bit < bits; ++bit) {
        for (const bool complement : {false, true}) {
            std::vector<LitModule> lit;
            for (std::size_t u = 0; u < words.size(); ++u) {
                if ((((words[u] >> static_cast<unsigned>(bit)) & 1U) != 0) != complement)
                    lit.push_back({world.skin.modules[u].id, std::nullopt});
            }
            scan.add(std::move(lit));
        }
    }
    scan.add({});
    return scan.take();
}

}  // namespace

std::vector<FrameInfo> planScan(const World& world, std::size_t view) {
    static constexpr std::array<std::array<int, 3>, 7> kColours{
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}}};
    const ViewOptions& options = world.scenario.views;
    ScanWriter scan(view);
    const auto& modules = world.skin.modules;
    switch (options.scan) {
        case ScanKind::Detections:
            return {};
        case ScanKind::Coded:
            return planCoded(world, view);
        case ScanKind::OneAtATime:
            for (const SkinModule& module : modules) {
                for (int repeat = 0; repeat < options.repeats; ++repeat) {
                    scan.add({});
                    scan.add({{module.id, std::nullopt}});
                }
            }
            break;
        case ScanKind::Coloured:
            for (std::size_t first = 0; first < modules.size(); first += kColours.size()) {
                std::vector<LitModule> lit;
                for (std::size_t i = first; i < std::min(modules.size(), first + kColours.size()); ++i)
                    lit.push_back({modules[i].id, kColours.at(i - first)});
                scan.add({});
                scan.add(std::move(lit));
            }
            break;
    }
    scan.add({});
    return scan.take();
}

}  // namespace skincal
