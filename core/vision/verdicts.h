#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/vision/detection.h"

namespace skincal {

/// The reason of what the operator threw out, with the operator's own where one was given.
[[nodiscard]] inline Sentence rejectedByOperator(const std::string& why) {
    return why.empty() ? Sentence::saying("rejected by the operator")
                       : Sentence::saying("rejected by the operator: {}", why);
}

/// Why modules are not found, one reason per module.
class Verdicts {
  public:
    explicit Verdicts(std::size_t modules) : reasons_(modules) {}

    /// What nearly was a find says more than what never was; of spots that were refused alike, the brightest.
    void note(std::size_t module, DetectionVerdict verdict, Undetected::Cause cause, Sentence reason,
              std::optional<NearestSpot> nearest = std::nullopt) {
        auto& known = reasons_[module];
        const bool isBrighter = nearest && (!known.nearest || nearest->reading.snr > known.nearest->reading.snr);
        const bool better = verdict == known.verdict ? isBrighter : verdict == DetectionVerdict::Ambiguous;
        if (known.reason.empty() || better)
            known = {{}, verdict, std::move(reason), {}, cause, std::move(nearest)};
    }
    /// Nothing says more than several finds.
    void replace(std::size_t module, Undetected with) { reasons_[module] = std::move(with); }
    [[nodiscard]] Undetected take(std::size_t module, ModuleId id) {
        Undetected result = std::move(reasons_[module]);
        result.module = id;
        if (result.reason.empty())
            result.reason = Sentence::saying("no spot blinks its word");
        return result;
    }

    /// Of light that blinks, and like nobody.
    void countUnexplained() { ++unexplained_; }
    [[nodiscard]] std::size_t unexplained() const { return unexplained_; }

  private:
    std::size_t unexplained_ = 0;
    std::vector<Undetected> reasons_;
};

}  // namespace skincal
