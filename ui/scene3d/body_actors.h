#pragma once

#include <vtkSmartPointer.h>

#include <optional>
#include <span>

#include "ui/scene3d/board_mesh.h"
#include "ui/scene3d/scene_glyphs.h"

class vtkActor;
class vtkPolyData;
class vtkRenderer;

namespace skincal {

/// Everything of a body that stands in a renderer, each thing built anew only where it changes. Knows no widgets.
class BodyActors {
  public:
    /// @param renderer  outlives this.
    explicit BodyActors(vtkRenderer& renderer);

    /// Boards, LEDs and cameras of a snapshot; forgets the selection.
    void show(const BodyModel& body, const SceneLayout& layout);
    void clear();

    /// Background, edges and lines; boards keep their colours.
    void setDark(bool dark);
    void setColours(std::span<const Rgb> colours) { boards_.setColours(colours); }
    void setHeights(std::span<const float> heights) { boards_.setHeights(heights); }

    void setCamerasShown(bool shown);
    /// @param scale  0 hides them.
    void setEllipsoids(const BodyModel& body, double scale);
    void setSelected(const SceneLayout& layout, std::span<const ModuleId> modules);
    void setGuideCamera(const std::optional<Isometry3d>& T_s_v, double size);
    void setGuideUp(const std::optional<Vector3d>& direction, const SceneLayout& layout);
    void setContacts(std::span<const ContactMark> contacts);
    void setMesh(vtkPolyData* mesh);

    /// Tip of the arrow of setGuideUp.
    [[nodiscard]] static Vector3d tipOfUp(const Vector3d& direction, const SceneLayout& layout);
    /// How large cameras are drawn, m; the guide's is twice as large.
    [[nodiscard]] static double cameraSize(const SceneLayout& layout) { return 0.12 * layout.radius; }

  private:
    vtkRenderer& renderer_;
    BoardMesh boards_;
    vtkSmartPointer<vtkActor> cameras_, ellipsoids_, selectedUnder_, selected_, guide_, guideFill_, up_, contacts_,
        mesh_;
};

/// Colours of what is no board, as the legend shows them too.
[[nodiscard]] Rgb guideColour(bool dark);
[[nodiscard]] Rgb cameraColour(bool dark);
[[nodiscard]] Rgb ellipsoidColour(bool dark);
[[nodiscard]] Rgb backgroundColour(bool dark);

}  // namespace skincal
