#include "core/vision/live_spots.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "core/vision/spot_series.h"

namespace skincal {

LiveSpots::LiveSpots(std::vector<ModuleId> modules, LitSets lit, const DecoderOptions& options)
    : modules_(std::move(modules)), lit_(std::move(lit)), options_(options), words_(modules_.size()) {}

bool LiveSpots::add(const cv::Mat& picture) {
    if (next_ >= lit_.size())
        return false;
    auto frame = FramePixels::make(picture, {}, before_ ? before_->size() : cv::Size(), false);
    if (!frame)
        return false;
    std::unordered_set<ModuleId> isLit;
    for (const LitModule& lit : lit_[next_])
        isLit.insert(lit.module);
    for (std::size_t u = 0; u < modules_.size(); ++u)
        words_[u] += isLit.contains(modules_[u]) ? '1' : '0';
    const bool isFirstLight = spots_.empty() && before_ && lit_[next_ - 1].empty() && !lit_[next_].empty();
    if (isFirstLight) {
        find(*before_, *frame);
        found_ = next_ + 1;
    } else {
        for (Spot& spot : spots_) {
            const double value = spotBrightness(*frame, spot.at, options_.windowRadius, -1).value;
            spot.word += value > 0.5 * (spot.off + spot.on) ? '1' : '0';
        }
    }
    before_ = std::move(*frame);
    ++next_;
    return true;
}

void LiveSpots::find(const FramePixels& dark, const FramePixels& light) {
    SpotFinder finder(options_.candidates);
    finder.add(dark, false);
    finder.add(light, false);
    // More than that are not looked for: this is done while the scan goes on.
    const std::size_t most = 2 * lit_[next_].size() + 50;
    for (const SpotCandidate& candidate : finder.candidates(most)) {
        Spot spot{candidate, spotBrightness(dark, candidate, options_.windowRadius, -1).value,
                  spotBrightness(light, candidate, options_.windowRadius, -1).value};
        if (spot.on > spot.off)
            spots_.push_back(std::move(spot));
    }
    // Light that falls beside an LED blinks with it, too, and so does noise now and then: a small part of what LEDs do.
    constexpr double kLeast = 0.08;
    const auto contrast = [](const Spot& spot) { return spot.on - spot.off; };
    double strongest = 0;
    for (const Spot& spot : spots_)
        strongest = std::max(strongest, contrast(spot));
    std::erase_if(spots_, [&](const Spot& spot) { return contrast(spot) < kLeast * strongest; });
}

std::vector<LiveSpot> LiveSpots::spots() const {
    struct Senders {
        std::size_t count = 0;
        std::size_t first = 0;
    };
    std::unordered_map<std::string, Senders> senders;
    for (std::size_t u = 0; u < words_.size(); ++u) {
        Senders& same = senders[words_[u].substr(std::min(found_, words_[u].size()))];
        if (same.count++ == 0)
            same.first = u;
    }
    std::vector<LiveSpot> result;
    for (const Spot& spot : spots_) {
        LiveSpot live{Vector2d(spot.at.x, spot.at.y), spot.on - spot.off};
        if (const auto sender = senders.find(spot.word); sender != senders.end()) {
            live.possible = sender->second.count;
            if (live.possible == 1)
                live.module = modules_[sender->second.first];
        }
        result.push_back(live);
    }
    return result;
}

}  // namespace skincal
