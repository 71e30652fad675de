#include "core/vision/coded_scan.h"

#include "core/geometry/random.h"
#include "core/vision/code_words.h"

namespace skincal {

LitSets codedScan(std::span<const ModuleId> modules, std::uint64_t seed) {
    CodeWords code = codeWords(modules.size());
    Random random(seed, "words");
    for (std::size_t i = code.words.size(); i > 1; --i)
        std::swap(code.words[i - 1], code.words[random.index(i)]);
    std::vector<LitModule> all;
    for (const ModuleId module : modules)
        all.push_back({module, std::nullopt});
    LitSets scan{{}, all};
    for (const bool complement : {false, true}) {
        for (int bit = 0; bit < code.bits; ++bit) {
            std::vector<LitModule> lit;
            for (std::size_t u = 0; u < modules.size(); ++u) {
                if ((((code.words[u] >> static_cast<unsigned>(bit)) & 1U) != 0) != complement)
                    lit.push_back(all[u]);
            }
            scan.push_back(std::move(lit));
        }
    }
    scan.push_back(std::move(all));
    scan.emplace_back();
    return scan;
}

}  // namespace skincal
