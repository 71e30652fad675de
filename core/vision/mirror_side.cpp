#include "core/vision/mirror_side.h"

#include <algorithm>

#include "core/geometry/statistics.h"

namespace skincal {

MirrorSide::MirrorSide(std::span<const MirroredPair> pairs) : pairs_(pairs.begin(), pairs.end()) {
    constexpr std::size_t kFewest = 3;
    constexpr std::size_t kMost = 64;
    if (pairs_.size() > kMost) {
        for (std::size_t i = 0; i < kMost; ++i)
            pairs_[i] = pairs_[i * pairs_.size() / kMost];
        pairs_.resize(kMost);
    }
    if (!pairs_.empty())
        orient();
    if (pairs_.size() < kFewest || !isFlat())
        pairs_.clear();
    margin_px_ = 0.5 * spread_px();
}

double MirrorSide::beyond(const MirroredPair& pair, const Vector2d& pixel) {
    return (pixel - 0.5 * (pair.led + pair.reflection)).dot((pair.reflection - pair.led).normalized());
}

void MirrorSide::orient() {
    const Vector2d first = pairs_.front().reflection - pairs_.front().led;
    std::size_t swapped = 0;
    const auto swap = [](MirroredPair& pair) {
        std::swap(pair.led, pair.reflection);
        pair.strength = 1 / pair.strength;
    };
    for (MirroredPair& pair : pairs_) {
        if ((pair.reflection - pair.led).dot(first) < 0) {
            swap(pair);
            ++swapped;
        }
    }
    if (2 * swapped > pairs_.size()) {
        std::for_each(pairs_.begin(), pairs_.end(), swap);
        swapped = pairs_.size() - swapped;
    }
    // LEDs that face the mirror are brighter in it.
    constexpr double kFainter = 0.8;
    std::vector<double> strengths;
    for (const MirroredPair& pair : pairs_)
        strengths.push_back(pair.strength);
    isOriented_ = 4 * swapped <= pairs_.size() && median(std::move(strengths)) <= kFainter;
}

bool MirrorSide::isFlat() const {
    constexpr double kAlike = 0.9;
    double alike = 0;
    for (const MirroredPair& pair : pairs_) {
        for (const MirroredPair& other : pairs_)
            alike += beyond(pair, other.led) <= 0 && beyond(pair, other.reflection) > 0 ? 1 : 0;
    }
    const auto pairs = static_cast<double>(pairs_.size());
    return alike >= kAlike * pairs * pairs;
}

double MirrorSide::spread_px() const {
    double spread = 0;
    for (const MirroredPair& pair : pairs_) {
        for (const MirroredPair& other : pairs_)
            spread = std::max(spread, beyond(pair, 0.5 * (other.led + other.reflection)));
    }
    return spread;
}

bool MirrorSide::mayReflect(const Vector2d& pixel) const {
    if (!isOriented_)
        return !pairs_.empty();
    return std::any_of(pairs_.begin(), pairs_.end(),
                       [&](const MirroredPair& pair) { return beyond(pair, pixel) > -margin_px_; });
}

}  // namespace skincal
