#include "core/camera/camera_devices.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace skincal {
namespace {

constexpr double kSameRate = 0.05;  // frames/s: 30 and 29.97 are one to an operator

}  // namespace

std::vector<FrameFormat> withoutDoubles(std::vector<FrameFormat> formats) {
    const auto order = [](const FrameFormat& format) {
        return std::tuple(-format.width * format.height, -format.width, -format.framesPerSecond);
    };
    std::erase_if(formats, [](const FrameFormat& format) { return format.width <= 0 || format.height <= 0; });
    std::sort(formats.begin(), formats.end(),
              [&](const FrameFormat& a, const FrameFormat& b) { return order(a) < order(b); });
    formats.erase(std::unique(formats.begin(), formats.end(),
                              [](const FrameFormat& a, const FrameFormat& b) {
                                  return a.width == b.width && a.height == b.height &&
                                         std::abs(a.framesPerSecond - b.framesPerSecond) < kSameRate;
                              }),
                  formats.end());
    return formats;
}

FrameFormat usualFormat(const std::vector<FrameFormat>& formats) {
    const auto usual = std::find_if(formats.begin(), formats.end(), [](const FrameFormat& format) {
        return format.width <= 1920 && format.height <= 1080 && format.framesPerSecond >= 24;
    });
    if (usual != formats.end())
        return *usual;
    return formats.empty() ? FrameFormat{} : formats.front();
}

std::vector<ListedCamera> withoutDoubles(std::vector<ListedCamera> cameras, const std::vector<V4l2Node>& nodes) {
    std::map<std::string, std::vector<const V4l2Node*>> nodesOf;
    for (const V4l2Node& node : nodes) {
        if (node.error == 0)
            nodesOf[node.card].push_back(&node);
    }
    std::map<std::string, std::size_t> seen;
    std::vector<ListedCamera> kept;
    for (ListedCamera& camera : cameras) {
        const auto found = nodesOf.find(camera.description);
        const std::size_t there = found == nodesOf.end() ? 1 : found->second.size();
        std::size_t& count = seen[camera.description];
        if (count >= there)
            continue;
        camera.ordinal = count++;
        camera.node = found != nodesOf.end() && there == 1 ? found->second.front()->path : std::string();
        kept.push_back(std::move(camera));
    }
    return kept;
}

const ListedCamera* findAgain(const std::vector<ListedCamera>& cameras, const ListedCamera& before) {
    const ListedCamera* result = nullptr;
    std::size_t alike = 0;
    for (const ListedCamera& camera : cameras) {
        if (camera.description != before.description)
            continue;
        if (camera.id == before.id)
            return &camera;
        ++alike;
        if (result == nullptr || camera.ordinal == before.ordinal)
            result = &camera;
    }
    return result != nullptr && (alike == 1 || result->ordinal == before.ordinal) ? result : nullptr;
}

}  // namespace skincal
