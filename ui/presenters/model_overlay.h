#pragma once

#include <optional>
#include <vector>

#include "core/estimation/body_model.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// A placed module as a view's camera would see it, px.
struct OverlayModule {
    enum class Sight {
        Open,        ///< nothing between it and the camera
        TurnedAway,  ///< its board shows its back
        Behind,      ///< another module's board is before its LED
    };
    ModuleId module;
    std::optional<PatchId> patch;
    Sight sight = Sight::Open;
    std::vector<Vector2d> outline;  ///< of its board
    Vector2d led = Vector2d::Zero();
    std::optional<Vector2d> found{};     ///< where its LED was found
    std::optional<Vector2d> residual{};  ///< found minus where the body has it
    bool counts = false;                 ///< what was found has a say in the body
};

/// A body in one of its pictures.
struct ModelOverlay {
    std::vector<OverlayModule> modules;  ///< those whose LED lies in the picture, or was found in it
    std::size_t counted = 0;             ///< detections that count
    std::size_t setAside = 0;            ///< detections that do not
    std::size_t missed = 0;              ///< modules in the open that were not found
    std::optional<double> rms_px{};      ///< of the residuals that count
    std::optional<double> median_px{};
    double worst_px = 0;  ///< of those that count
    ModuleId worst;
};

/// Projects every placed module into a view:  pixel = project(T_r_v^-1 * T_r_u * p_u)
/// Empty where the view has no pose. What hides a module are other modules' boards: nothing else is known of the body.
[[nodiscard]] ModelOverlay overlayOf(const BodyModel& body, const BodyView& view, const CameraModel& camera);

/// How many times as long as they are residuals have to be drawn to be seen: 1, 2 or 5 times a power of ten,
/// at most 200.
/// @param wanted_px  how long most of them may become in the picture
[[nodiscard]] double residualScale(const ModelOverlay& overlay, double wanted_px);

}  // namespace skincal
