#pragma once

#include <optional>

#include "core/skin/skin.h"
#include "tests/unit/skin/synthetic_skin.h"

namespace skincal::test {

inline Link link(unsigned a, int a_port, unsigned b, int b_port, std::optional<LinkKind> decided = std::nullopt) {
    return {ModuleId(a), a_port, ModuleId(b), b_port, decided};
}

/// Modules of one template, ids 1 … count, without links.
inline Skin looseModules(const ModuleTemplate& type, std::size_t count) {
    Skin skin;
    skin.templates = {type};
    for (std::size_t i = 0; i < count; ++i)
        skin.modules.push_back({ModuleId(static_cast<std::uint32_t>(i + 1)), 0});
    return skin;
}

/// Four-port modules in rows; `ahead` and `aside` are the ports that face the next column and the next row.
inline KnownSkin fourPortGrid(const ModuleTemplate& type, int columns, int rows, int ahead, int behind, int aside,
                              int opposite) {
    KnownSkin grid{looseModules(type, static_cast<std::size_t>(columns * rows)), {}};
    const auto port = [&](int p) { return type.ports[static_cast<std::size_t>(p)]; };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const Vector3d t = column * (port(ahead) - port(behind)) + row * (port(aside) - port(opposite));
            grid.T_s_u.push_back(makeIsometry(Matrix3d::Identity(), t));
            const auto id = static_cast<unsigned>(row * columns + column + 1);
            if (column + 1 < columns)
                grid.skin.links.push_back(link(id, ahead, id + 1, behind));
            if (row + 1 < rows)
                grid.skin.links.push_back(link(id, aside, id + static_cast<unsigned>(columns), opposite));
        }
    }
    return grid;
}

inline KnownSkin hexagonGrid(int columns, int rows) {
    return fourPortGrid(paperHexagon(), columns, rows, 0, 3, 1, 2);
}

inline KnownSkin rectangleGrid(int columns, int rows) {
    return fourPortGrid(rectangleTemplate(), columns, rows, 0, 2, 1, 3);
}

/// Triangles that point forwards and backwards in turn; each pair is one cell of the lattice.
inline KnownSkin triangleGrid(int columns, int rows) {
    const ModuleTemplate type = triangleTemplate();
    KnownSkin grid{looseModules(type, static_cast<std::size_t>(2 * columns * rows)), {}};
    const Matrix3d turned = Eigen::AngleAxisd(180 * kDegree, Vector3d::UnitZ()).toRotationMatrix();
    const auto forward = [&](int column, int row) { return static_cast<unsigned>(2 * (row * columns + column) + 1); };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const Vector3d t = 2 * column * (type.ports[0] - type.ports[1]) + 2 * row * (type.ports[0] - type.ports[2]);
            grid.T_s_u.push_back(makeIsometry(Matrix3d::Identity(), t));
            grid.T_s_u.push_back(makeIsometry(turned, t + 2 * type.ports[0]));
            const unsigned backward = forward(column, row) + 1;
            grid.skin.links.push_back(link(forward(column, row), 0, backward, 0));
            if (column + 1 < columns)
                grid.skin.links.push_back(link(backward, 1, forward(column + 1, row), 1));
            if (row + 1 < rows)
                grid.skin.links.push_back(link(backward, 2, forward(column, row + 1), 2));
        }
    }
    return grid;
}

inline Vector3d portOf(const Skin& skin, std::size_t module, int port) {
    return skin.templateOf(module).ports[static_cast<std::size_t>(port)];
}

}  // namespace skincal::test
