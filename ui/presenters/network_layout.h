#pragma once

#include <QPointF>
#include <QPolygonF>
#include <vector>

#include "core/skin/skin.h"
#include "ui/presenters/link_model.h"

namespace skincal {

/// A module laid flat, mm, y down as on a screen.
struct FlatModule {
    ModuleId module;
    unsigned patch = 0;  ///< numbered by the smallest module
    QPointF centre;
    QPolygonF outline;
    std::vector<QPointF> ports;
};

struct FlatLink {
    LinkKind kind = LinkKind::Adjacent;
    QPointF from, to;  ///< the two ports
    int row = 0;       ///< in LinkModel
};

/// The network as it would lie on a table: neighbours port to port, patches in rows side by side, cables between them.
struct FlatNetwork {
    std::vector<FlatModule> modules;
    std::vector<FlatLink> links;
    QRectF bounds;
};

[[nodiscard]] FlatNetwork layOutFlat(const Skin& skin, const std::vector<JudgedLink>& links);

}  // namespace skincal
