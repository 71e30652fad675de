#pragma once

#include <linux/videodev2.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <memory>
#include <set>

#include "core/camera/v4l2_device.h"

namespace skincal::test {

/// A Video4Linux node that exists nowhere.
struct FakeNode {
    struct Control {
        int minimum = 0;
        int maximum = 1;
        int step = 1;
        int value = 0;
        bool isStubborn = false;  ///< takes values and keeps its own
        bool isRefused = false;   ///< answers with an error
    };

    std::string card = "Webcam";
    std::uint32_t can = V4L2_CAP_VIDEO_CAPTURE;
    std::map<std::uint32_t, Control> controls;
    int openError = 0;
    int formatError = 0;
    int open = 0;  ///< how often
    int asked = 0;

    /// As most webcams are, with everything automatic.
    [[nodiscard]] static std::shared_ptr<FakeNode> webcam(std::string card) {
        auto node = std::make_shared<FakeNode>();
        node->card = std::move(card);
        node->controls = {{V4L2_CID_EXPOSURE_AUTO, {0, 3, 1, V4L2_EXPOSURE_APERTURE_PRIORITY}},
                          {V4L2_CID_EXPOSURE_ABSOLUTE, {3, 2047, 1, 250}},
                          {V4L2_CID_EXPOSURE_AUTO_PRIORITY, {0, 1, 1, 1}},
                          {V4L2_CID_AUTOGAIN, {0, 1, 1, 1}},
                          {V4L2_CID_GAIN, {0, 255, 1, 64}},
                          {V4L2_CID_FOCUS_AUTO, {0, 1, 1, 1}},
                          {V4L2_CID_FOCUS_ABSOLUTE, {0, 250, 5, 35}},
                          {V4L2_CID_AUTO_WHITE_BALANCE, {0, 1, 1, 1}},
                          {V4L2_CID_WHITE_BALANCE_TEMPERATURE, {2000, 6500, 1, 4650}}};
        return node;
    }

    [[nodiscard]] std::map<std::uint32_t, int> values() const {
        std::map<std::uint32_t, int> result;
        for (const auto& [id, control] : controls)
            result[id] = control.value;
        return result;
    }

    int ask(unsigned long request, void* argument) {
        ++asked;
        if (request == VIDIOC_QUERYCAP) {
            auto& capability = *static_cast<v4l2_capability*>(argument);
            std::memcpy(capability.card, card.data(), std::min(card.size(), sizeof(capability.card)));
            capability.capabilities = V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_META_CAPTURE;
            capability.device_caps = can;
            return 0;
        }
        if (request == VIDIOC_G_FMT)
            return 0;
        if (request == VIDIOC_S_FMT)
            return formatError;
        if (request == VIDIOC_QUERYCTRL) {
            auto& query = *static_cast<v4l2_queryctrl*>(argument);
            const auto found = controls.find(query.id);
            if (found == controls.end())
                return EINVAL;
            query.minimum = found->second.minimum;
            query.maximum = found->second.maximum;
            query.step = found->second.step;
            return 0;
        }
        auto& control = *static_cast<v4l2_control*>(argument);
        const auto found = controls.find(control.id);
        if (found == controls.end())
            return EINVAL;
        if (request == VIDIOC_G_CTRL) {
            control.value = found->second.value;
            return 0;
        }
        if (found->second.isRefused || control.value < found->second.minimum || control.value > found->second.maximum ||
            (control.value - found->second.minimum) % found->second.step != 0)
            return ERANGE;
        if (!found->second.isStubborn)
            found->second.value = control.value;
        return 0;
    }
};

struct FakeV4l2 : V4l2System {
    explicit FakeV4l2(std::map<std::string, std::shared_ptr<FakeNode>> all) : nodes(std::move(all)) {}

    std::map<std::string, std::shared_ptr<FakeNode>> nodes;

    struct Open : V4l2Device {
        explicit Open(std::shared_ptr<FakeNode> one) : node(std::move(one)) { ++node->open; }
        Open(const Open&) = delete;
        Open& operator=(const Open&) = delete;
        ~Open() override { --node->open; }
        int ask(unsigned long request, void* argument) override { return node->ask(request, argument); }

        std::shared_ptr<FakeNode> node;
    };

    [[nodiscard]] std::vector<std::string> paths() const override {
        std::vector<std::string> result;
        for (const auto& [path, node] : nodes)
            result.push_back(path);
        return result;
    }
    [[nodiscard]] tl::expected<std::unique_ptr<V4l2Device>, int> open(const std::string& path) const override {
        const auto found = nodes.find(path);
        if (found == nodes.end())
            return tl::unexpected(ENOENT);
        if (found->second->openError != 0)
            return tl::unexpected(found->second->openError);
        return std::make_unique<Open>(found->second);
    }
};

}  // namespace skincal::test
