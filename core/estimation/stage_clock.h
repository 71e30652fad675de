#pragma once

#include <chrono>
#include <string>

#include "core/estimation/body_model.h"

namespace skincal {

/// Times one stage of a computation from here to stop().
class StageClock {
  public:
    explicit StageClock(std::string stage) : stage_(std::move(stage)) {}

    [[nodiscard]] StageReport stop(int iterations = 0) const {
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
        return {stage_, taken.count(), iterations};
    }

  private:
    std::string stage_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace skincal
