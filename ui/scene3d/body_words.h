#pragma once

#include <QCoreApplication>
#include <optional>
#include <span>
#include <vector>

#include "ui/scene3d/body_values.h"
#include "ui/scene3d/colour_map.h"
#include "ui/scene3d/scene_layout.h"
#include "ui/scene3d/scene_overlay.h"

namespace skincal {

/// What the colour of a board means.
enum class ColourMode {
    Patch,
    Uncertainty,  ///< standard deviation of the position
    Residual,     ///< how far its LED was found from where the result has it, in the pictures
    ViewCount,    ///< how many views saw it
    LastView,     ///< which view was the last to see it
    Plain,
    Deviation,  ///< how far it lies above or below a surface, what setDeviations says
    Values,     ///< what setCellValues says, 0 to 1
};

/// The numbers behind a colour mode; nothing for Patch, Plain and Values, nor Deviation, which no
/// body model knows (deviations_mm).
[[nodiscard]] std::optional<ModuleValues> valuesOf(const BodyModel& body, ColourMode mode);

/// Words about what a scene shows, in the user's language.
class BodyWords {
    Q_DECLARE_TR_FUNCTIONS(BodyWords)
  public:
    /// @param values  valuesOf(body, mode), or deviations_mm.
    [[nodiscard]] static Legend legend(const BodyModel& body, const SceneLayout& layout, ColourMode mode,
                                       const std::optional<ModuleValues>& values, bool dark);
    [[nodiscard]] static QString ellipsoids(double scale);
    [[nodiscard]] static QString empty();
    /// That patches lie in a row because nothing is known of their places; else nothing.
    [[nodiscard]] static QString caption(const SceneLayout& layout);
    /// For those who hear the scene rather than see it.
    [[nodiscard]] static QString description(const BodyModel* body, const SceneLayout& layout);
    [[nodiscard]] static QString patch(PatchId id);
    [[nodiscard]] static QString module(ModuleId id);
    [[nodiscard]] static QString distance(double metres);
    [[nodiscard]] static QString hint();
};

/// The colour of each module of the layout.
/// @param live  of setCellValues, by position in BodyModel::modules; used by ColourMode::Values.
[[nodiscard]] std::vector<Rgb> coloursOf(const SceneLayout& layout, ColourMode mode,
                                         const std::optional<ModuleValues>& values, std::span<const float> live,
                                         bool dark);

}  // namespace skincal
