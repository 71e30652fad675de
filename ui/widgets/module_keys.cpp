#include "ui/widgets/module_keys.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skincal {
namespace {

std::optional<QPointF> directionOf(int key) {
    switch (key) {
        case Qt::Key_Left:
            return QPointF(-1, 0);
        case Qt::Key_Right:
            return QPointF(1, 0);
        case Qt::Key_Up:
            return QPointF(0, -1);
        case Qt::Key_Down:
            return QPointF(0, 1);
        default:
            return std::nullopt;
    }
}

using Places = std::vector<ModulePlace>;

/// What lies straight ahead goes before what is nearer but aside.
Places::const_iterator nearest(const Places& places, Places::const_iterator from, const QPointF& direction) {
    constexpr double kWidest = 2;  // aside, per step ahead
    auto best = from;
    double least = std::numeric_limits<double>::infinity();
    for (auto other = places.begin(); other != places.end(); ++other) {
        const QPointF way = other->at - from->at;
        const double ahead = QPointF::dotProduct(way, direction);
        const double aside = std::abs(way.x() * direction.y() - way.y() * direction.x());
        const double cost = ahead + 2 * aside;
        if (ahead > 0 && aside <= kWidest * ahead && cost < least) {
            least = cost;
            best = other;
        }
    }
    return best;
}

}  // namespace

std::optional<ModuleId> moduleByKey(int key, Places places, std::optional<ModuleId> current) {
    const auto direction = directionOf(key);
    const bool isNumber = key == Qt::Key_PageUp || key == Qt::Key_PageDown || key == Qt::Key_Home || key == Qt::Key_End;
    if (places.empty() || (!direction && !isNumber))
        return std::nullopt;
    std::sort(places.begin(), places.end(),
              [](const ModulePlace& a, const ModulePlace& b) { return a.module < b.module; });
    if (key == Qt::Key_End)
        return places.back().module;
    const auto at =
        std::find_if(places.cbegin(), places.cend(), [&](const ModulePlace& place) { return place.module == current; });
    if (at == places.cend() || key == Qt::Key_Home)
        return places.front().module;
    if (key == Qt::Key_PageUp)
        return at == places.cbegin() ? at->module : std::prev(at)->module;
    if (key == Qt::Key_PageDown)
        return std::next(at) == places.cend() ? at->module : std::next(at)->module;
    return nearest(places, at, *direction)->module;
}

}  // namespace skincal
