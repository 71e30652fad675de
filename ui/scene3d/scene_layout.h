#pragma once

#include <optional>
#include <vector>

#include "core/estimation/body_model.h"

namespace skincal {

/// A module as the scene shows it.
struct ShownModule {
    std::size_t index = 0;  ///< in BodyModel::modules
    ModuleId id;
    std::optional<PatchId> patch;
    const ModuleTemplate* type = nullptr;       ///< of the body model, which has to outlive this
    Isometry3d T_s_u = Isometry3d::Identity();  ///< scene; the body frame for those that are placed
    bool placed = false;                        ///< in the body, not only in its patch
    [[nodiscard]] Vector3d led() const { return T_s_u * type->led; }
};

/// Where everything of a body model is drawn. The scene's frame is the body frame, in metres.
struct SceneLayout {
    std::vector<ShownModule> modules;
    std::vector<PatchId> apart;  ///< patches whose shape is known, but not their place
    std::size_t unknown = 0;     ///< modules of which nothing can be shown yet
    bool anyPlaced = false;
    Vector3d centre = Vector3d::Zero();
    double radius = 0.02;  ///< about the centre, boards included, m

    [[nodiscard]] const ShownModule* find(ModuleId id) const;
    /// Corners of all boards.
    [[nodiscard]] std::vector<Vector3d> corners() const;
    [[nodiscard]] std::vector<Isometry3d> poses() const;
};

/// Modules with a pose in the body go where they are. Patches that have a shape but no pose lie side by side in a row,
/// each flattened towards the spectator: about the origin where nothing is placed yet, else below the body. Modules
/// without either, or of an unknown type, are not shown.
[[nodiscard]] SceneLayout layOut(const BodyModel& body);
SceneLayout layOut(const BodyModel&& body) = delete;  // templates would be gone

/// A place on a board.
struct ScenePick {
    ModuleId module;
    Vector3d point_u = Vector3d::Zero();  ///< module frame
};

/// The board that a ray hits first, from either side, and where.
/// @param direction  of any length but zero; what lies behind the origin is not hit.
[[nodiscard]] std::optional<ScenePick> pickPoint(const SceneLayout& layout, const Vector3d& origin,
                                                 const Vector3d& direction);
/// The module alone.
[[nodiscard]] std::optional<ModuleId> pickModule(const SceneLayout& layout, const Vector3d& origin,
                                                 const Vector3d& direction);

}  // namespace skincal
