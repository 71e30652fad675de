#include "ui/scene3d/scene_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "ui/scene3d/body_scene.h"
#include "ui/scene3d/view_fit.h"

namespace skincal {
namespace {

constexpr double kGap = 0.03;    // between patches in the row, m
constexpr double kWidest = 1.8;  // a row is broken where the whole would be wider than this many times its height

Vector3d corner3(const Vector2d& corner) {
    return {corner.x(), corner.y(), 0};
}

/// A patch by itself, its boards facing z, its longer side along x.
struct FlatPatch {
    std::vector<ShownModule> modules;  // T_s_u is the pose in this frame
    Vector2d low, high;                // box of the boards
};

Eigen::AlignedBox2d boxOf(const std::vector<ShownModule>& modules) {
    Eigen::AlignedBox2d box;
    for (const ShownModule& module : modules) {
        for (const Vector2d& corner : module.type->outline)
            box.extend(Vector2d((module.T_s_u * corner3(corner)).head<2>()));
    }
    return box;
}

void turn(std::vector<ShownModule>& modules, const Matrix3d& R) {
    for (ShownModule& module : modules)
        module.T_s_u = makeIsometry(R, Vector3d::Zero()) * module.T_s_u;
}

FlatPatch flatten(std::vector<ShownModule> modules) {
    Vector3d normal = Vector3d::Zero();
    for (const ShownModule& module : modules)
        normal += module.T_s_u.linear().col(2);
    if (normal.norm() > 1e-6)
        turn(modules, Quaterniond::FromTwoVectors(normal, Vector3d::UnitZ()).toRotationMatrix());
    const Eigen::AlignedBox2d box = boxOf(modules);
    if (box.sizes().y() > 1.2 * box.sizes().x())
        turn(modules, so3Exp(Vector3d(0, 0, -90 * kDegree)));
    const Eigen::AlignedBox2d turned = boxOf(modules);
    return {std::move(modules), turned.min(), turned.max()};
}

/// Lays patches out from left to right, in rows from top to bottom, around the origin; appends them to `to`.
void layRow(std::vector<FlatPatch>& patches, const Isometry3d& T_s_row, bool hanging, std::vector<ShownModule>& to) {
    double area = 0;
    double widest = 0;
    for (const FlatPatch& patch : patches) {
        const Vector2d size = patch.high - patch.low + Vector2d(kGap, kGap);
        area += size.x() * size.y();
        widest = std::max(widest, size.x());
    }
    const double limit = std::max(widest, kWidest * std::sqrt(area));
    std::vector<Vector2d> places;  // of each patch's upper left corner
    Vector2d next = Vector2d::Zero();
    double height = 0;
    double width = 0;
    for (const FlatPatch& patch : patches) {
        const Vector2d size = patch.high - patch.low + Vector2d(kGap, kGap);
        if (next.x() > 0 && next.x() + size.x() > limit) {
            next = Vector2d(0, next.y() - height);
            height = 0;
        }
        places.push_back(next);
        next.x() += size.x();
        width = std::max(width, next.x());
        height = std::max(height, size.y());
    }
    const double middle = hanging ? 0 : 0.5 * (height - next.y() - kGap);
    for (std::size_t i = 0; i < patches.size(); ++i) {
        const Vector2d shift =
            places[i] - Vector2d(patches[i].low.x() + 0.5 * (width - kGap), patches[i].high.y() - middle);
        for (ShownModule& module : patches[i].modules) {
            module.T_s_u = T_s_row * Eigen::Translation3d(shift.x(), shift.y(), 0) * module.T_s_u;
            to.push_back(module);
        }
    }
}

/// Below the body as one sees it at first.
Isometry3d rowBelow(const SceneLayout& layout, const std::optional<Vector3d>& up) {
    const Spectator view = bestSpectator(layout.poses(), up, true);
    Matrix3d R;
    R << view.up.cross(view.from), view.up, view.from;
    Eigen::AlignedBox3d box;
    for (const Vector3d& corner : layout.corners())
        box.extend(Vector3d(R.transpose() * corner));
    const Vector3d top(box.center().x(), box.min().y() - 1.5 * kGap, box.center().z());
    return makeIsometry(R, R * top);
}

}  // namespace

const ShownModule* SceneLayout::find(ModuleId id) const {
    const auto found = std::find_if(modules.begin(), modules.end(), [&](const ShownModule& m) { return m.id == id; });
    return found == modules.end() ? nullptr : &*found;
}

std::vector<Vector3d> SceneLayout::corners() const {
    std::vector<Vector3d> points;
    for (const ShownModule& module : modules) {
        for (const Vector2d& corner : module.type->outline)
            points.push_back(module.T_s_u * corner3(corner));
    }
    return points;
}

std::vector<Isometry3d> SceneLayout::poses() const {
    std::vector<Isometry3d> all;
    all.reserve(modules.size());
    for (const ShownModule& module : modules)
        all.push_back(module.T_s_u);
    return all;
}

SceneLayout layOut(const BodyModel& body) {
    std::map<std::string, const ModuleTemplate*> types;
    for (const ModuleTemplate& type : body.templates)
        types[type.name] = &type;
    SceneLayout layout;
    std::map<PatchId, std::vector<ShownModule>> apart;
    for (std::size_t i = 0; i < body.modules.size(); ++i) {
        const BodyModule& module = body.modules[i];
        const auto type = types.find(module.type);
        ShownModule shown{i, module.id, module.patch, type == types.end() ? nullptr : type->second, {}, false};
        const bool drawable = shown.type != nullptr && shown.type->outline.size() >= 3;
        if (drawable && module.T_body_module) {
            shown.T_s_u = *module.T_body_module;
            shown.placed = true;
            layout.modules.push_back(shown);
        } else if (drawable && module.patch && module.T_patch_module) {
            shown.T_s_u = *module.T_patch_module;
            apart[*module.patch].push_back(shown);
        } else {
            ++layout.unknown;
        }
    }
    layout.anyPlaced = !layout.modules.empty();
    std::vector<FlatPatch> flat;
    for (auto& [id, modules] : apart) {
        layout.apart.push_back(id);
        flat.push_back(flatten(std::move(modules)));
    }
    const Isometry3d T_s_row = layout.anyPlaced ? rowBelow(layout, firstCameraUp(body)) : Isometry3d::Identity();
    layRow(flat, T_s_row, layout.anyPlaced, layout.modules);

    Eigen::AlignedBox3d box;
    for (const ShownModule& module : layout.modules)
        box.extend(module.T_s_u.translation());
    if (!box.isEmpty())
        layout.centre = box.center();
    for (const Vector3d& corner : layout.corners())
        layout.radius = std::max(layout.radius, (corner - layout.centre).norm());
    return layout;
}

std::optional<ScenePick> pickPoint(const SceneLayout& layout, const Vector3d& origin, const Vector3d& direction) {
    std::optional<ScenePick> best;
    double nearest = 1e300;
    for (const ShownModule& module : layout.modules) {
        const Vector3d o = module.T_s_u.inverse() * origin;
        const Vector3d d = module.T_s_u.linear().transpose() * direction;
        if (std::abs(d.z()) < 1e-12)
            continue;
        const double along = -o.z() / d.z();
        if (along <= 0 || along >= nearest)
            continue;
        // Even-odd rule.
        const Vector2d hit = (o + along * d).head<2>();
        const std::vector<Vector2d>& outline = module.type->outline;
        bool inside = false;
        for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
            const Vector2d& a = outline[i];
            const Vector2d& b = outline[j];
            if ((a.y() > hit.y()) != (b.y() > hit.y()) &&
                hit.x() < a.x() + (b.x() - a.x()) * (hit.y() - a.y()) / (b.y() - a.y()))
                inside = !inside;
        }
        if (inside) {
            nearest = along;
            best = ScenePick{module.id, Vector3d(hit.x(), hit.y(), 0)};
        }
    }
    return best;
}

std::optional<ModuleId> pickModule(const SceneLayout& layout, const Vector3d& origin, const Vector3d& direction) {
    const auto pick = pickPoint(layout, origin, direction);
    return pick ? std::optional(pick->module) : std::nullopt;
}

}  // namespace skincal
