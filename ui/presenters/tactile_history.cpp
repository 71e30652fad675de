#include "ui/presenters/tactile_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace skincal {
namespace {

FeltModule nothingFelt() {
    const auto nan = std::numeric_limits<Eigen::half>::quiet_NaN();
    return {nan, nan, nan, {nan, nan, nan}};
}

FeltModule keptOf(const TactileSample::Reading& reading) {
    const auto& a = reading.acceleration;
    return {Eigen::half(reading.proximity),
            Eigen::half(reading.temperature),
            Eigen::half(std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])),
            {Eigen::half(reading.force[0]), Eigen::half(reading.force[1]), Eigen::half(reading.force[2])}};
}

}  // namespace

TactileHistory::TactileHistory(std::vector<ModuleId> modules, std::size_t frames)
    : modules_(std::move(modules)), times_(frames), felt_(frames * modules_.size()) {
    if (frames == 0)
        throw std::logic_error("TactileHistory: no room for a single frame");
    for (std::size_t i = 0; i < modules_.size(); ++i)
        index_[modules_[i]] = i;
    order_.reserve(modules_.size());
}

std::optional<std::size_t> TactileHistory::indexOf(ModuleId module) const {
    const auto found = index_.find(module);
    return found == index_.end() ? std::nullopt : std::optional(found->second);
}

void TactileHistory::clear() {
    first_ = 0;
    count_ = 0;
}

void TactileHistory::add(const TactileSample& sample) {
    if (count_ > 0 && sample.time <= timeOf(count_ - 1))
        clear();
    if (count_ == times_.size()) {
        first_ = (first_ + 1) % times_.size();
        --count_;
    }
    const std::size_t here = slot(count_);
    ++count_;
    times_[here] = sample.time;
    while (sample.time - timeOf(0) > kSpan) {
        first_ = (first_ + 1) % times_.size();
        --count_;
    }
    const std::span<FeltModule> frame(felt_.data() + here * modules_.size(), modules_.size());
    std::fill(frame.begin(), frame.end(), nothingFelt());
    if (order_.size() != sample.readings.size())
        order_.assign(sample.readings.size(), 0);
    for (std::size_t i = 0; i < sample.readings.size(); ++i) {
        const TactileSample::Reading& reading = sample.readings[i];
        if (order_[i] >= modules_.size() || modules_[order_[i]] != reading.module) {
            const auto found = index_.find(reading.module);
            if (found == index_.end())
                continue;
            order_[i] = found->second;
        }
        frame[order_[i]] = keptOf(reading);
    }
}

std::span<const FeltModule> TactileHistory::at(std::size_t frame) const {
    return {felt_.data() + slot(frame) * modules_.size(), modules_.size()};
}

std::optional<std::size_t> TactileHistory::frameAt(Time time) const {
    if (count_ == 0)
        return std::nullopt;
    std::size_t low = 0;
    std::size_t high = count_;  // the first that is later is in (low, high]
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (timeOf(middle) <= time ? low : high) = middle;
    }
    return low;
}

}  // namespace skincal
