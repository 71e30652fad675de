#include "core/device/protocol/cell_poll.h"

#include <algorithm>

namespace skincal {

CellPoll::CellPoll(std::vector<CellNumber> cells, Time patience, Time now)
    : cells_(std::move(cells)), open_(cells_.size()), patience_(patience), lastNews_(now) {
    std::sort(cells_.begin(), cells_.end());
    state_.resize(cells_.empty() ? 1 : cells_.back() + std::size_t{1}, State::None);
    for (const CellNumber cell : cells_)
        state_[cell] = State::Open;
}

std::vector<CellRange> CellPoll::poll(Time now) {
    if (asked_ > 0 && now >= lastNews_ + patience_) {
        for (const CellNumber cell : cells_)
            if (state_[cell] == State::Asked)
                state_[cell] = State::Open;
        asked_ = 0;
        next_ = 0;
        ++rounds_;
        lastNews_ = now;
    }
    std::vector<CellRange> ranges;
    if (isOver() || asked_ + kRange > kAtOnce)
        return ranges;
    for (; next_ < cells_.size() && asked_ < kAtOnce; ++next_) {
        const CellNumber cell = cells_[next_];
        if (state_[cell] != State::Open)
            continue;
        if (asked_ == 0)
            lastNews_ = now;
        state_[cell] = State::Asked;
        ++asked_;
        if (!ranges.empty() && ranges.back().first + ranges.back().count == cell && ranges.back().count < kRange)
            ++ranges.back().count;
        else
            ranges.push_back({cell, 1});
    }
    return ranges;
}

bool CellPoll::answered(CellNumber cell, Time now) {
    if (cell >= state_.size() || state_[cell] == State::None)
        return false;
    if (state_[cell] == State::Answered) {
        patience_ = std::min(patience_ * 3 / 2, kMostPatience);
        return false;
    }
    asked_ -= state_[cell] == State::Asked ? 1 : 0;
    state_[cell] = State::Answered;
    --open_;
    rounds_ = 0;
    lastNews_ = now;
    return true;
}

std::vector<CellNumber> CellPoll::missing() const {
    std::vector<CellNumber> missing;
    std::copy_if(cells_.begin(), cells_.end(), std::back_inserter(missing),
                 [&](CellNumber cell) { return state_[cell] != State::Answered; });
    return missing;
}

}  // namespace skincal
