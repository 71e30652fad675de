#pragma once

#include <ceres/iteration_callback.h>

#include "core/geometry/run_context.h"

namespace skincal {

/// Breaks off a Ceres solver between two iterations once its user wants that. Only for who links Ceres.
class StopWhenCancelled final : public ceres::IterationCallback {
  public:
    explicit StopWhenCancelled(const RunContext& context) : context_(context) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
        return context_.isCancelled() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
    }

  private:
    const RunContext& context_;
};

}  // namespace skincal
