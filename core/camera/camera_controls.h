#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace skincal {

enum class CameraControl : std::uint8_t { Exposure, Gain, Focus, WhiteBalance };
inline constexpr std::array kCameraControls = {CameraControl::Exposure, CameraControl::Gain, CameraControl::Focus,
                                               CameraControl::WhiteBalance};

/// What became of a control that should not change while pictures are taken.
struct ControlState {
    enum class Outcome : std::uint8_t {
        Locked,
        NotOffered,  ///< the camera has no such control: it is fixed, or does as it likes
        Automatic,   ///< it can't be switched off, or was and is on again
        Refused,     ///< the camera answered with an error
        NoAccess,    ///< it is not known how to reach this camera's controls
    };

    CameraControl control{};
    Outcome outcome = Outcome::NoAccess;
    std::optional<std::int32_t> value{};  ///< as the camera counts it

    friend bool operator==(const ControlState&, const ControlState&) = default;
};

}  // namespace skincal
