#include "core/camera/control_lock.h"

#include <algorithm>
#include <cmath>

#ifdef __linux__
#include <linux/videodev2.h>

#include <cerrno>
#endif

namespace skincal {

#ifdef __linux__
namespace {

constexpr double kExposureUnit = 1e-4;  // s, of V4L2_CID_EXPOSURE_ABSOLUTE

struct Switches {
    std::uint32_t automatic;
    std::int32_t off;
    std::uint32_t value;
};

Switches switchesOf(CameraControl control) {
    switch (control) {
        case CameraControl::Exposure:
            return {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, V4L2_CID_EXPOSURE_ABSOLUTE};
        case CameraControl::Gain:
            return {V4L2_CID_AUTOGAIN, 0, V4L2_CID_GAIN};
        case CameraControl::Focus:
            return {V4L2_CID_FOCUS_AUTO, 0, V4L2_CID_FOCUS_ABSOLUTE};
        default:
            return {V4L2_CID_AUTO_WHITE_BALANCE, 0, V4L2_CID_WHITE_BALANCE_TEMPERATURE};
    }
}

std::optional<v4l2_queryctrl> query(V4l2Device& device, std::uint32_t id) {
    v4l2_queryctrl what{};
    what.id = id;
    if (device.ask(VIDIOC_QUERYCTRL, &what) != 0 || (what.flags & V4L2_CTRL_FLAG_DISABLED) != 0U)
        return std::nullopt;
    return what;
}

std::optional<std::int32_t> get(V4l2Device& device, std::uint32_t id) {
    v4l2_control control{};
    control.id = id;
    return device.ask(VIDIOC_G_CTRL, &control) == 0 ? std::optional(control.value) : std::nullopt;
}

bool set(V4l2Device& device, std::uint32_t id, std::int32_t value) {
    v4l2_control control{};
    control.id = id;
    control.value = value;
    return device.ask(VIDIOC_S_CTRL, &control) == 0;
}

std::int32_t within(const v4l2_queryctrl& range, double value) {
    const double step = std::max(range.step, 1);
    const double steps = std::round((value - range.minimum) / step);
    return static_cast<std::int32_t>(std::clamp(range.minimum + steps * step, static_cast<double>(range.minimum),
                                                static_cast<double>(range.maximum)));
}

class Locker {
  public:
    Locker(V4l2Device& device, ControlLock& lock) : device_(device), lock_(lock) {}

    ControlState lock(CameraControl control, std::optional<std::int32_t> wanted) {
        using Outcome = ControlState::Outcome;
        const Switches ids = switchesOf(control);
        const bool hasAutomatic = query(device_, ids.automatic).has_value();
        const auto range = query(device_, ids.value);
        ControlState state{control, Outcome::NotOffered, {}};
        if (!hasAutomatic && !range)
            return state;
        // Before the automatic is off: some cameras jump to a value of old then.
        const auto value = range ? get(device_, ids.value) : std::nullopt;
        state.outcome = Outcome::Locked;
        if (hasAutomatic && !change(ids.automatic, ids.off))
            state.outcome = Outcome::Refused;
        if (state.outcome == Outcome::Locked && value) {
            if (!change(ids.value, within(*range, wanted.value_or(*value))))
                state.outcome = Outcome::Refused;
            state.value = get(device_, ids.value);
        }
        if (state.outcome == Outcome::Locked && hasAutomatic && get(device_, ids.automatic) != ids.off)
            state.outcome = Outcome::Automatic;
        return state;
    }

    /// Longer exposures must not slow the pictures down.
    void keepRate() {
        if (query(device_, V4L2_CID_EXPOSURE_AUTO_PRIORITY))
            static_cast<void>(change(V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0));
    }

  private:
    bool change(std::uint32_t id, std::int32_t value) {
        const auto before = get(device_, id);
        if (!set(device_, id, value))
            return false;
        if (before)
            lock_.before.push_back({id, *before});
        return true;
    }

    V4l2Device& device_;
    ControlLock& lock_;
};

}  // namespace

ControlLock lockControls(V4l2Device& device, const ControlValues& values) {
    ControlLock lock;
    Locker locker(device, lock);
    for (const CameraControl control : kCameraControls) {
        const auto wanted =
            std::find_if(values.begin(), values.end(), [&](const auto& value) { return value.first == control; });
        lock.states.push_back(
            locker.lock(control, wanted == values.end() ? std::nullopt : std::optional(wanted->second)));
    }
    locker.keepRate();
    return lock;
}

bool restoreControls(V4l2Device& device, const ControlLock& lock) {
    bool isAllBack = true;
    for (auto saved = lock.before.rbegin(); saved != lock.before.rend(); ++saved)
        isAllBack = set(device, saved->id, saved->value) && isAllBack;
    return isAllBack;
}

std::optional<std::pair<double, double>> exposureRange(V4l2Device& device) {
    const auto range = query(device, V4L2_CID_EXPOSURE_ABSOLUTE);
    if (!range || range->minimum < 0 || range->maximum <= range->minimum)
        return std::nullopt;
    return std::pair(kExposureUnit * std::max(range->minimum, 1), kExposureUnit * range->maximum);
}

std::optional<double> exposure(V4l2Device& device) {
    const auto value = get(device, V4L2_CID_EXPOSURE_ABSOLUTE);
    return value && *value > 0 ? std::optional(kExposureUnit * *value) : std::nullopt;
}

bool setExposure(V4l2Device& device, double seconds) {
    const auto range = query(device, V4L2_CID_EXPOSURE_ABSOLUTE);
    return range && set(device, V4L2_CID_EXPOSURE_ABSOLUTE, within(*range, seconds / kExposureUnit));
}

#else

ControlLock lockControls(V4l2Device&, const ControlValues&) {
    ControlLock lock;
    for (const CameraControl control : kCameraControls)
        lock.states.push_back({control});
    return lock;
}

bool restoreControls(V4l2Device&, const ControlLock&) {
    return true;
}

std::optional<std::pair<double, double>> exposureRange(V4l2Device&) {
    return std::nullopt;
}

std::optional<double> exposure(V4l2Device&) {
    return std::nullopt;
}

bool setExposure(V4l2Device&, double) {
    return false;
}

#endif

}  // namespace skincal
