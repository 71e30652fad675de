#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/skin/skin.h"

namespace skincal {

/// Gravity readings sorted by module and pose. Pose numbers of the file become 0 … poseCount-1 in rising order.
class GravityTable {
  public:
    struct Entry {
        std::size_t pose = 0;
        Vector3d acceleration = Vector3d::Zero();
        std::optional<double> sigma;
    };

    /// Readings of modules that the skin does not have are left out.
    GravityTable(const Skin& skin, std::span<const GravityReading> readings);

    [[nodiscard]] std::size_t poseCount() const { return poseNumbers_.size(); }
    [[nodiscard]] int poseNumber(std::size_t pose) const { return poseNumbers_[pose]; }
    /// In rising order of pose.
    [[nodiscard]] std::span<const Entry> of(std::size_t module) const { return entries_[module]; }

  private:
    std::vector<int> poseNumbers_;
    std::vector<std::vector<Entry>> entries_;
};

}  // namespace skincal
