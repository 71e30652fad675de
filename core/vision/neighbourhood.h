#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "core/vision/matched_spot.h"

namespace skincal {

/// Whose light falls on which match: a grid of cells as large as the farthest reach. The matches must outlive it.
class Neighbourhood {
  public:
    /// @param reach_px  per match, how far its light counts; > 0
    Neighbourhood(const std::vector<MatchedSpot>& matches, std::vector<double> reach_px);

    /// Words of the others whose light reaches a match, nearest first, none twice and none of its own.
    [[nodiscard]] std::vector<std::size_t> wordsAround(std::size_t match, std::size_t most) const;

  private:
    [[nodiscard]] std::pair<int, int> cellOf(int x, int y) const {
        return {(x + 2 * cell_px_) / cell_px_, (y + 2 * cell_px_) / cell_px_};
    }

    const std::vector<MatchedSpot>& matches_;
    std::vector<double> reach_px_;
    int cell_px_ = 1;
    std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

}  // namespace skincal
