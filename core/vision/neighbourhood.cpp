#include "core/vision/neighbourhood.h"

#include <algorithm>
#include <cmath>

namespace skincal {

Neighbourhood::Neighbourhood(const std::vector<MatchedSpot>& matches, std::vector<double> reach_px)
    : matches_(matches), reach_px_(std::move(reach_px)) {
    for (const double reach : reach_px_)
        cell_px_ = std::max(cell_px_, static_cast<int>(std::ceil(reach)));
    for (std::size_t i = 0; i < matches.size(); ++i)
        cells_[cellOf(matches[i].spot.x, matches[i].spot.y)].push_back(i);
}

std::vector<std::size_t> Neighbourhood::wordsAround(std::size_t match, std::size_t most) const {
    const SpotCandidate& spot = matches_[match].spot;
    std::vector<std::pair<int, std::size_t>> near;
    for (int dy = -cell_px_; dy <= cell_px_; dy += cell_px_) {
        for (int dx = -cell_px_; dx <= cell_px_; dx += cell_px_) {
            const auto cell = cells_.find(cellOf(spot.x + dx, spot.y + dy));
            if (cell == cells_.end())
                continue;
            for (const std::size_t i : cell->second) {
                const int x = matches_[i].spot.x - spot.x;
                const int y = matches_[i].spot.y - spot.y;
                if (i != match && x * x + y * y <= reach_px_[i] * reach_px_[i])
                    near.emplace_back(x * x + y * y, i);
            }
        }
    }
    std::sort(near.begin(), near.end());
    std::vector<std::size_t> words;
    for (const auto& [distance, i] : near) {
        for (const std::size_t word : matches_[i].series.words) {
            const auto known = [&](const std::vector<std::size_t>& list) {
                return std::find(list.begin(), list.end(), word) != list.end();
            };
            if (words.size() < most && !known(words) && !known(matches_[match].series.words))
                words.push_back(word);
        }
    }
    return words;
}

}  // namespace skincal
