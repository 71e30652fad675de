#include "core/formats/export_urdf.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace skincal {
namespace {

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                // XML has no way to write control characters.
                out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
    }
    return out;
}

/// For an XML comment, which must not hold two hyphens in a row.
std::string withoutDoubleHyphens(std::string text) {
    for (std::size_t i = 0; (i = text.find("--", i)) != std::string::npos;)
        text.replace(i, 2, "- -");
    return text;
}

/// R = Rz(yaw) Ry(pitch) Rx(roll), as URDF has it. Pitch and roll are read from Rz(-yaw) R, which stays well
/// conditioned near the poles, where yaw is any and roll makes up for it.
Vector3d rollPitchYaw(const Matrix3d& R) {
    const double yaw = std::atan2(R(1, 0), R(0, 0));
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    return {std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1)),
            std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0)), yaw};
}

std::string origin(const Isometry3d& T) {
    const Vector3d rpy = rollPitchYaw(T.linear());
    const Vector3d t = T.translation();
    return fmt::format("<origin xyz=\"{} {} {}\" rpy=\"{} {} {}\"/>", t.x(), t.y(), t.z(), rpy.x(), rpy.y(), rpy.z());
}

std::string fixedJoint(const std::string& parent, const std::string& child, const Isometry3d& T) {
    return fmt::format(
        "  <joint name=\"{0}_to_{1}\" type=\"fixed\">\n    <parent link=\"{0}\"/>\n    <child link=\"{1}\"/>\n    {2}\n"
        "  </joint>\n",
        parent, child, origin(T));
}

std::string moduleLink(const std::string& name, const ModuleTemplate* type) {
    if (type == nullptr || type->outline.empty())
        return fmt::format("  <link name=\"{}\"/>\n", name);
    Vector2d low = type->outline.front();
    Vector2d high = low;
    for (const Vector2d& p : type->outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    constexpr double kThickness = 0.002;  // of a board; below the skin's surface
    const Vector2d size = high - low;
    const Vector2d centre = 0.5 * (high + low);
    return fmt::format(
        "  <link name=\"{}\">\n    <visual>\n      <origin xyz=\"{} {} {}\" rpy=\"0 0 0\"/>\n"
        "      <geometry><box size=\"{} {} {}\"/></geometry>\n    </visual>\n  </link>\n",
        name, centre.x(), centre.y(), -0.5 * kThickness, size.x(), size.y(), kThickness);
}

}  // namespace

std::string exportUrdf(const BodyModel& body, const std::string& robotName) {
    std::map<std::string, const ModuleTemplate*> types;
    for (const ModuleTemplate& type : body.templates)
        types[type.name] = &type;
    std::string urdf = fmt::format(
        "<?xml version=\"1.0\"?>\n<!-- Metres and radians. skin_base is the body frame, {}; module frames have z out "
        "of the skin. -->\n<robot name=\"{}\">\n  <link name=\"skin_base\"/>\n",
        withoutDoubleHyphens(escaped(body.body_frame)), escaped(robotName));
    std::map<PatchId, Isometry3d> patches;
    for (const BodyPatch& patch : body.patches) {
        if (!patch.T_body_patch)
            continue;
        patches[patch.id] = *patch.T_body_patch;
        const std::string name = fmt::format("patch_{}", patch.id.value);
        urdf += fmt::format("  <link name=\"{}\"/>\n", name) + fixedJoint("skin_base", name, *patch.T_body_patch);
    }
    for (const BodyModule& module : body.modules) {
        if (!module.T_body_module)
            continue;
        const std::string name = fmt::format("module_{}", module.id.value);
        const auto type = types.find(module.type);
        urdf += moduleLink(name, type == types.end() ? nullptr : type->second);
        const auto patch = module.patch ? patches.find(*module.patch) : patches.end();
        if (patch == patches.end())
            urdf += fixedJoint("skin_base", name, *module.T_body_module);
        else
            urdf += fixedJoint(fmt::format("patch_{}", patch->first.value), name,
                               patch->second.inverse() * *module.T_body_module);
    }
    return urdf + "</robot>\n";
}

}  // namespace skincal
