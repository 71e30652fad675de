#include "core/adjustment/gravity_table.h"

#include <algorithm>

namespace skincal {

GravityTable::GravityTable(const Skin& skin, std::span<const GravityReading> readings) : entries_(skin.modules.size()) {
    for (const GravityReading& reading : readings)
        poseNumbers_.push_back(reading.pose);
    std::sort(poseNumbers_.begin(), poseNumbers_.end());
    poseNumbers_.erase(std::unique(poseNumbers_.begin(), poseNumbers_.end()), poseNumbers_.end());

    const auto index = skin.indexById();
    for (const GravityReading& reading : readings) {
        const auto found = index.find(reading.module);
        if (found == index.end())
            continue;
        const auto pose = std::lower_bound(poseNumbers_.begin(), poseNumbers_.end(), reading.pose);
        entries_[found->second].push_back(
            {static_cast<std::size_t>(pose - poseNumbers_.begin()), reading.acceleration, reading.sigma});
    }
    for (auto& list : entries_)
        std::sort(list.begin(), list.end(), [](const Entry& x, const Entry& y) { return x.pose < y.pose; });
}

}  // namespace skincal
