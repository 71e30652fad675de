#include "core/vision/paper_frames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace skincal {
namespace {

using Key = std::vector<std::pair<ModuleId, std::array<int, 3>>>;

bool coloursTellApart(const std::vector<LitModule>& lit, std::size_t nativeColours) {
    if (lit.empty() || lit.size() > nativeColours)
        return false;
    std::set<std::array<int, 3>> colours;
    return std::all_of(lit.begin(), lit.end(), [&](const LitModule& one) {
        return !isBlack(colourOf(one)) && colours.insert(colourOf(one)).second;
    });
}

// True where frame b is nearer to frame k than frame a is; a < k < b.
bool laterIsNearer(std::span<const FrameInfo> frames, std::size_t a, std::size_t k, std::size_t b) {
    const auto& t_a = frames[a].time_s;
    const auto& t_k = frames[k].time_s;
    const auto& t_b = frames[b].time_s;
    if (t_a && t_k && t_b)
        return std::abs(*t_b - *t_k) < std::abs(*t_k - *t_a);
    return b - k < k - a;
}

}  // namespace

std::array<int, 3> colourOf(const LitModule& lit) {
    return lit.colour.value_or(std::array{1, 1, 1});
}

bool isBlack(const std::array<int, 3>& colour) {
    return colour == std::array{0, 0, 0};
}

bool isWhite(const std::array<int, 3>& colour) {
    return colour == std::array{1, 1, 1};
}

std::vector<std::optional<std::size_t>> nearestBackgrounds(std::span<const FrameInfo> frames) {
    std::vector<std::optional<std::size_t>> nearest(frames.size());
    std::optional<std::size_t> last;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        nearest[k] = last;
        if (frames[k].lit.empty())
            last = k;
    }
    std::optional<std::size_t> next;
    for (std::size_t k = frames.size(); k-- > 0;) {
        if (next && (!nearest[k] || laterIsNearer(frames, *nearest[k], k, *next)))
            nearest[k] = next;
        if (frames[k].lit.empty())
            next = k;
    }
    return nearest;
}

std::vector<PaperGroup> paperGroups(std::span<const FrameInfo> frames, std::size_t nativeColours) {
    const auto backgrounds = nearestBackgrounds(frames);
    std::vector<PaperGroup> groups;
    std::map<Key, std::size_t> known;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        std::vector<LitModule> lit = frames[k].lit;
        const bool alone = lit.size() == 1 && isWhite(colourOf(lit[0]));
        if (!alone && !coloursTellApart(lit, nativeColours))
            continue;
        std::sort(lit.begin(), lit.end(), [](const LitModule& a, const LitModule& b) { return a.module < b.module; });
        Key key;
        for (const LitModule& one : lit)
            key.emplace_back(one.module, colourOf(one));
        const auto [entry, isNew] = known.emplace(std::move(key), groups.size());
        if (isNew)
            groups.push_back({std::move(lit), !alone});
        if (backgrounds[k])
            groups[entry->second].pairs.push_back({k, *backgrounds[k]});
    }
    return groups;
}

}  // namespace skincal
