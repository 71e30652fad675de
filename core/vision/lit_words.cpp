#include "core/vision/lit_words.h"

#include <unordered_map>
#include <utility>

namespace skincal {

tl::expected<LitWords, Sentence> litWords(std::span<const ModuleId> modules, std::span<const FrameInfo> frames) {
    std::unordered_map<ModuleId, std::size_t> index;
    for (std::size_t i = 0; i < modules.size(); ++i)
        index.emplace(modules[i], i);

    LitWords words;
    for (const FrameInfo& frame : frames) {
        for (const LitModule& lit : frame.lit) {
            if (!lit.colour)
                continue;
            for (const int level : *lit.colour) {
                if (level != 0 && level != 1)
                    return tl::unexpected(Sentence::saying(
                        "{}: module {} is lit in a colour that is not made of 0 and 1", frame.file, lit.module.value));
                words.coloured = words.coloured || level == 0;
            }
        }
    }
    words.lit.resize(modules.size());
    std::vector<std::size_t> lastLit(modules.size(), frames.size());  // the frame that lit it last
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const std::size_t first = words.planes.size();
        if (words.coloured) {
            for (int channel = 0; channel < 3; ++channel)
                words.planes.push_back({k, channel});
        } else {
            words.planes.push_back({k, -1});
        }
        for (const LitModule& lit : frames[k].lit) {
            const auto found = index.find(lit.module);
            if (found == index.end())
                return tl::unexpected(Sentence::saying("{}: lights module {}, which the skin does not have",
                                                       frames[k].file, lit.module.value));
            if (std::exchange(lastLit[found->second], k) == k)
                return tl::unexpected(Sentence::saying("{}: lights module {} twice", frames[k].file, lit.module.value));
            auto& word = words.lit[found->second];
            if (!words.coloured) {
                word.push_back(first);
                continue;
            }
            for (std::size_t channel = 0; channel < 3; ++channel) {
                // Colours are given as RGB, pictures are BGR.
                if (!lit.colour || (*lit.colour)[2 - channel] == 1)
                    word.push_back(first + channel);
            }
        }
    }
    return words;
}

}  // namespace skincal
