#include "ui/scene3d/board_mesh.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace skincal {
namespace {

constexpr double kThickness = 1.6e-3;  // of a circuit board, m
constexpr double kLedRadius = 1.4e-3;
constexpr double kLift = 0.35e-3;  // of LEDs and outlines above the board, so that they win against it
constexpr int kLedCorners = 10;
constexpr std::size_t kManyModules = 3000;

void append(vtkCellArray& cells, std::initializer_list<vtkIdType> corners) {
    cells.InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.begin());
}

void appendRing(vtkCellArray& cells, vtkIdType first, vtkIdType count, bool reversed) {
    cells.InsertNextCell(static_cast<int>(count));
    for (vtkIdType i = 0; i < count; ++i)
        cells.InsertCellPoint(reversed ? first + count - 1 - i : first + i);
}

}  // namespace

BoardMesh::BoardMesh() : actor_(vtkSmartPointer<vtkActor>::New()), data_(vtkSmartPointer<vtkPolyData>::New()) {
    auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
    mapper->SetInputData(data_);
    mapper->SetScalarModeToUseCellData();
    actor_->SetMapper(mapper);
    actor_->GetProperty()->SetInterpolationToFlat();
    // Together 1 and no highlights: a board that faces the spectator has the legend's colour.
    actor_->GetProperty()->SetAmbient(0.5);
    actor_->GetProperty()->SetDiffuse(0.5);
}

vtkActor* BoardMesh::actor() const {
    return actor_;
}

vtkPolyData* BoardMesh::data() const {
    return data_;
}

void BoardMesh::build(const SceneLayout& layout) {
    const bool many = layout.modules.size() > kManyModules;
    points_ = vtkSmartPointer<vtkPoints>::New();
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    parts_.clear();
    base_.clear();
    const auto addPoint = [&](const Isometry3d& T, double x, double y, double z) {
        const Vector3d p = T * Vector3d(x, y, z);
        base_.push_back(p);
        points_->InsertNextPoint(p.x(), p.y(), p.z());
    };
    for (const ShownModule& module : layout.modules) {
        const std::vector<Vector2d>& outline = module.type->outline;
        const auto n = static_cast<vtkIdType>(outline.size());
        const vtkIdType first = points_->GetNumberOfPoints();
        const vtkIdType firstCell = cells->GetNumberOfCells();
        const vtkIdType led = first + n;
        const vtkIdType back = led + kLedCorners;
        for (const Vector2d& corner : outline)
            addPoint(module.T_s_u, corner.x(), corner.y(), 0);
        for (int i = 0; i < kLedCorners; ++i) {
            const double angle = 360 * kDegree * i / kLedCorners;
            addPoint(module.T_s_u, module.type->led.x() + kLedRadius * std::cos(angle),
                     module.type->led.y() + kLedRadius * std::sin(angle), std::max(kLift, module.type->led.z()));
        }
        appendRing(*cells, first, n, false);
        appendRing(*cells, led, kLedCorners, false);
        if (many) {
            // The back by itself, which is seen where the face is turned away.
            appendRing(*cells, first, n, true);
        } else {
            for (const Vector2d& corner : outline)
                addPoint(module.T_s_u, corner.x(), corner.y(), -kThickness);
            appendRing(*cells, back, n, true);
            for (vtkIdType i = 0; i < n; ++i) {
                const vtkIdType j = (i + 1) % n;
                append(*cells, {first + i, back + i, back + j, first + j});
            }
        }
        parts_.push_back(
            {firstCell, cells->GetNumberOfCells() - firstCell, first, n + kLedCorners, module.T_s_u.linear().col(2)});
    }
    colours_ = vtkSmartPointer<vtkUnsignedCharArray>::New();
    colours_->SetNumberOfComponents(3);
    colours_->SetNumberOfTuples(cells->GetNumberOfCells());
    colours_->Fill(128);
    data_->Initialize();
    data_->SetPoints(points_);
    data_->SetPolys(cells);
    data_->GetCellData()->SetScalars(colours_);

    vtkProperty* look = actor_->GetProperty();
    look->SetBackfaceCulling(1);  // slabs are closed
    look->SetEdgeVisibility(many ? 0 : 1);
    look->SetLineWidth(layout.modules.size() > 400 ? 1.0F : 1.5F);
}

void BoardMesh::setDark(bool dark) {
    if (dark)
        actor_->GetProperty()->SetEdgeColor(0.05, 0.055, 0.07);
    else
        actor_->GetProperty()->SetEdgeColor(0.15, 0.16, 0.19);
}

void BoardMesh::setColours(std::span<const Rgb> colours) {
    if (colours.size() != parts_.size())
        throw std::logic_error("BoardMesh: one colour per module");
    const Rgb led{255, 252, 235};
    const Rgb back{66, 69, 76};
    unsigned char* out = colours_ == nullptr ? nullptr : colours_->GetPointer(0);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Rgb side = mixed(colours[i], Rgb{0, 0, 0}, 0.35);
        for (vtkIdType k = 0; k < parts_[i].cells; ++k) {
            const Rgb& colour = k == 0 ? colours[i] : k == 1 ? led : k == 2 ? back : side;
            std::copy(colour.begin(), colour.end(), out + 3 * (parts_[i].firstCell + k));
        }
    }
    if (colours_ != nullptr)
        colours_->Modified();
}

void BoardMesh::setHeights(std::span<const float> heights) {
    if (heights.size() != parts_.size())
        throw std::logic_error("BoardMesh: one height per module");
    if (parts_.empty())
        return;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Vector3d shift = static_cast<double>(heights[i]) * parts_[i].normal;
        for (vtkIdType k = 0; k < parts_[i].raised; ++k) {
            const vtkIdType at = parts_[i].firstPoint + k;
            const Vector3d p = base_[static_cast<std::size_t>(at)] + shift;
            points_->SetPoint(at, p.data());
        }
    }
    points_->Modified();
}

vtkSmartPointer<vtkPolyData> outlinesOf(const SceneLayout& layout, std::span<const ModuleId> modules) {
    auto points = vtkSmartPointer<vtkPoints>::New();
    auto lines = vtkSmartPointer<vtkCellArray>::New();
    for (const ModuleId id : modules) {
        const ShownModule* module = layout.find(id);
        if (module == nullptr)
            continue;
        // In front of either side.
        for (const double z : {kLift, -kThickness - kLift}) {
            const auto n = static_cast<int>(module->type->outline.size());
            const vtkIdType first = points->GetNumberOfPoints();
            for (const Vector2d& corner : module->type->outline) {
                const Vector3d p = module->T_s_u * Vector3d(corner.x(), corner.y(), z);
                points->InsertNextPoint(p.data());
            }
            lines->InsertNextCell(n + 1);
            for (int i = 0; i <= n; ++i)
                lines->InsertCellPoint(first + i % n);
        }
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetLines(lines);
    return data;
}

}  // namespace skincal
