#pragma once

#include <vtkSmartPointer.h>

#include <span>
#include <vector>

#include "ui/scene3d/colour_map.h"
#include "ui/scene3d/scene_layout.h"

class vtkActor;
class vtkPoints;
class vtkPolyData;
class vtkUnsignedCharArray;

namespace skincal {

/// All boards with their LEDs as one mesh, whose colours and heights change without building it anew: 1,000 modules in
/// well under a millisecond, for values that come 30 times a second.
class BoardMesh {
  public:
    BoardMesh();

    /// Boards as thin slabs; above 3,000 modules as polygons only, and without edges, to stay quick.
    void build(const SceneLayout& layout);

    /// Colours of edges only.
    void setDark(bool dark);

    /// One colour per module of the layout, in its order. Throws std::logic_error where their number differs.
    void setColours(std::span<const Rgb> colours);

    /// How far each module's face stands out of its place along its normal, m, in the layout's order. Throws likewise.
    void setHeights(std::span<const float> heights);

    [[nodiscard]] vtkActor* actor() const;
    [[nodiscard]] vtkPolyData* data() const;

  private:
    struct Part {
        vtkIdType firstCell, cells;    // face, LED, then back and sides
        vtkIdType firstPoint, raised;  // the points that setHeights moves come first
        Vector3d normal;
    };
    vtkSmartPointer<vtkActor> actor_;
    vtkSmartPointer<vtkPolyData> data_;
    vtkSmartPointer<vtkPoints> points_;
    vtkSmartPointer<vtkUnsignedCharArray> colours_;
    std::vector<Part> parts_;
    std::vector<Vector3d> base_;  // points before setHeights
};

/// Closed lines round the boards of some modules, a little off them so that they lie in front, scene frame.
[[nodiscard]] vtkSmartPointer<vtkPolyData> outlinesOf(const SceneLayout& layout, std::span<const ModuleId> modules);

}  // namespace skincal
