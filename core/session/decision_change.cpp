#include "core/session/decision_change.h"

#include <algorithm>
#include <iterator>

namespace skincal {
namespace {

bool isSame(LinkKind a, LinkKind b) {
    return a == b;
}

bool isSame(const Decision& a, const Decision& b) {
    return a.view == b.view && a.module == b.module && a.verdict == b.verdict && a.reason == b.reason;
}

template <class Key, class Value>
std::map<Key, std::optional<Value>> difference(const std::map<Key, Value>& before, const std::map<Key, Value>& after) {
    std::map<Key, std::optional<Value>> result;
    for (const auto& [key, value] : before) {
        if (!after.contains(key))
            result[key] = std::nullopt;
    }
    for (const auto& [key, value] : after) {
        const auto known = before.find(key);
        if (known == before.end() || !isSame(known->second, value))
            result[key] = value;
    }
    return result;
}

template <class Key>
std::set<Key> difference(const std::set<Key>& before, const std::set<Key>& after) {
    std::set<Key> result;
    std::set_symmetric_difference(before.begin(), before.end(), after.begin(), after.end(),
                                  std::inserter(result, result.end()));
    return result;
}

template <class Key, class Value>
void exchange(std::map<Key, std::optional<Value>>& change, std::map<Key, Value>& values) {
    for (auto& [key, other] : change) {
        std::optional<Value> now;
        if (const auto known = values.find(key); known != values.end())
            now = std::move(known->second);
        values.erase(key);
        if (other)
            values[key] = *std::move(other);
        other = std::move(now);
    }
}

template <class Key>
void toggle(const std::set<Key>& change, std::set<Key>& values) {
    for (const Key& key : change) {
        if (values.erase(key) == 0)
            values.insert(key);
    }
}

}  // namespace

DecisionChange::DecisionChange(const Decisions& before, const Decisions& after)
    : links_(difference(before.links, after.links)),
      poses_(difference(before.droppedPoses, after.droppedPoses)),
      views_(difference(before.droppedViews, after.droppedViews)),
      detections_(difference(before.detections, after.detections)) {
    if (!sameCamera(before.camera, after.camera) || !(before.cameraOrigin == after.cameraOrigin))
        camera_.emplace(after.camera, after.cameraOrigin);
}

void DecisionChange::swap(Decisions& decisions) {
    exchange(links_, decisions.links);
    toggle(poses_, decisions.droppedPoses);
    toggle(views_, decisions.droppedViews);
    exchange(detections_, decisions.detections);
    if (camera_) {
        std::swap(camera_->first, decisions.camera);
        std::swap(camera_->second, decisions.cameraOrigin);
    }
}

}  // namespace skincal
