#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "core/session/session_data.h"

namespace skincal {

/// What one step changed about the decisions, and nothing besides. Taking it back leaves alone what came about
/// otherwise: that a pose no longer counts since its capture was taken back outlives any decision made before it.
class DecisionChange {
  public:
    DecisionChange(const Decisions& before, const Decisions& after);

    /// From `before` to `after`, the next time back again, and so on.
    void swap(Decisions& decisions);

  private:
    std::map<LinkKey, std::optional<LinkKind>> links_;
    std::set<int> poses_;  ///< those that are dropped by one and not by the other
    std::set<std::string> views_;
    std::map<DetectionKey, std::optional<Decision>> detections_;
    std::optional<std::pair<std::optional<CameraModel>, CameraOrigin>> camera_;
};

}  // namespace skincal
