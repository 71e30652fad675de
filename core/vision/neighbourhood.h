#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "core/vision/matched_spot.h"

namespace skincal {

/// Which matches are how near to which: a grid of cells as large as what can throw light into a window. The matches
/// must outlive it.
class Neighbourhood {
  public:
    Neighbourhood(const std::vector<MatchedSpot>& matches, int reach_px);

    /// Words of the others within reach, nearest first, none twice and none of this match's own.
    [[nodiscard]] std::vector<std::size_t> wordsAround(std::size_t match, std::size_t most) const;

  private:
    [[nodiscard]] std::pair<int, int> cellOf(int x, int y) const {
        return {(x + 2 * reach_px_) / reach_px_, (y + 2 * reach_px_) / reach_px_};
    }

    const std::vector<MatchedSpot>& matches_;
    int reach_px_;
    std::map<std::pair<int, int>, std::vector<std::size_t>> cells_;
};

}  // namespace skincal
