#include "core/formats/export_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace skincal {

std::string exportPly(const BodyModel& body) {
    // Okabe and Ito's palette: told apart by people who see red and green alike.
    static constexpr std::array<std::array<int, 3>, 8> kPalette{{{0, 114, 178},
                                                                 {230, 159, 0},
                                                                 {0, 158, 115},
                                                                 {204, 121, 167},
                                                                 {86, 180, 233},
                                                                 {213, 94, 0},
                                                                 {240, 228, 66},
                                                                 {140, 140, 153}}};
    std::map<std::string, const ModuleTemplate*> types;
    for (const ModuleTemplate& type : body.templates)
        types[type.name] = &type;

    std::string vertices;
    std::string faces;
    std::size_t vertexCount = 0;
    std::size_t faceCount = 0;
    std::size_t longestFace = 0;
    for (const BodyModule& module : body.modules) {
        const auto type = types.find(module.type);
        if (!module.T_body_module || type == types.end())
            continue;
        const Vector3d normal = module.T_body_module->linear().col(2);
        const auto& colour = kPalette.at(module.patch.value_or(PatchId(0)).value % kPalette.size());
        std::string face = fmt::format("{}", type->second->outline.size());
        for (const Vector2d& corner : type->second->outline) {
            const Vector3d p = *module.T_body_module * Vector3d(corner.x(), corner.y(), 0);
            vertices += fmt::format("{:.9g} {:.9g} {:.9g} {:.6g} {:.6g} {:.6g} {} {} {}\n", p.x(), p.y(), p.z(),
                                    normal.x(), normal.y(), normal.z(), colour[0], colour[1], colour[2]);
            face += fmt::format(" {}", vertexCount++);
        }
        faces += face + "\n";
        longestFace = std::max(longestFace, type->second->outline.size());
        ++faceCount;
    }
    return fmt::format(
               "ply\nformat ascii 1.0\ncomment skin boards in the body frame, metres\nelement vertex {}\n"
               "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
               "property float nz\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face {}\n"
               "property list {} int vertex_indices\nend_header\n",
               vertexCount, faceCount, longestFace < 256 ? "uchar" : "uint") +
           vertices + faces;
}

}  // namespace skincal
