#include "ui/presenters/model_overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

constexpr int kCell_px = 64;
constexpr double kBefore = 2e-3;  // m: boards of one surface do not hide each other

struct Board {
    std::size_t at;  ///< in ModelOverlay::modules
    Isometry3d T_v_u;
    Eigen::AlignedBox2d box;
};

std::optional<Vector2d> pixelOf(const CameraModel& camera, const Vector3d& p_v) {
    if (!(p_v.z() > 1e-3))
        return std::nullopt;
    const auto pixel = camera.project(p_v);
    if (!pixel)
        return std::nullopt;
    // Far out of the picture a lens polynomial may fold back into it.
    const Vector2d straight = p_v.head<2>() / p_v.z();
    constexpr double kSame = 1e-3;
    if (!((camera.unproject(*pixel) - straight).norm() < kSame * (1 + straight.norm())))
        return std::nullopt;
    return pixel;
}

bool contains(const std::vector<Vector2d>& polygon, const Vector2d& p) {
    bool isInside = false;
    for (std::size_t i = 0, k = polygon.size() - 1; i < polygon.size(); k = i++) {
        const Vector2d& a = polygon[i];
        const Vector2d& b = polygon[k];
        if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
            isInside = !isInside;
    }
    return isInside;
}

/// Nothing where its LED is not in the picture and was not found there either. Without an outline where the lens can't
/// tell where a corner would be.
std::optional<OverlayModule> projected(const BodyModule& module, const ModuleTemplate& type, const Isometry3d& T_v_u,
                                       const CameraModel& camera, bool isFound) {
    const auto led = pixelOf(camera, T_v_u * type.led);
    if (!led || !(camera.contains(*led) || isFound))
        return std::nullopt;
    OverlayModule result{module.id, module.patch, OverlayModule::Sight::Open, {}, *led};
    for (const Vector2d& corner : type.outline) {
        const auto pixel = pixelOf(camera, T_v_u * Vector3d(corner.x(), corner.y(), 0));
        if (!pixel) {
            result.outline.clear();
            break;
        }
        result.outline.push_back(*pixel);
    }
    if (T_v_u.linear().col(2).dot(T_v_u.translation()) >= 0)
        result.sight = OverlayModule::Sight::TurnedAway;
    return result;
}

/// Marks what lies behind boards; these are sorted into cells of the picture, since each can hide only what is near it.
void findHidden(const std::vector<Board>& boards, const std::unordered_map<std::size_t, Vector3d>& leds,
                ModelOverlay& overlay) {
    std::unordered_map<int, std::vector<const Board*>> cells;
    constexpr int kRow = 1 << 12;
    const auto cellOf = [](const Vector2d& p) {
        const Eigen::Vector2i cell = (p / kCell_px).array().floor().cast<int>();
        return Eigen::Vector2i(cell + Eigen::Vector2i::Constant(kRow / 4));
    };
    for (const Board& board : boards) {
        const Eigen::Vector2i low = cellOf(board.box.min());
        const Eigen::Vector2i high = cellOf(board.box.max());
        for (int y = low.y(); y <= high.y(); ++y) {
            for (int x = low.x(); x <= high.x(); ++x)
                cells[y * kRow + x].push_back(&board);
        }
    }
    for (const auto& [at, led] : leds) {
        OverlayModule& module = overlay.modules[at];
        if (module.sight != OverlayModule::Sight::Open)
            continue;
        const Eigen::Vector2i cell = cellOf(module.led);
        for (const Board* board : cells[cell.y() * kRow + cell.x()]) {
            if (board->at == at || !contains(overlay.modules[board->at].outline, module.led))
                continue;
            // Where the ray to the LED goes through the board's plane.
            const Vector3d normal = board->T_v_u.linear().col(2);
            const double share = normal.dot(board->T_v_u.translation()) / normal.dot(led);
            if (share > 0 && (1 - share) * led.norm() > kBefore) {
                module.sight = OverlayModule::Sight::Behind;
                break;
            }
        }
    }
}

void addFigures(ModelOverlay& overlay) {
    std::vector<double> sizes;
    double squares = 0;
    for (const OverlayModule& module : overlay.modules) {
        if (!module.found) {
            overlay.missed += module.sight == OverlayModule::Sight::Open ? 1 : 0;
            continue;
        }
        (module.counts ? overlay.counted : overlay.setAside) += 1;
        if (!module.counts || !module.residual)
            continue;
        const double size = module.residual->norm();
        squares += size * size;
        if (sizes.empty() || size > overlay.worst_px) {
            overlay.worst_px = size;
            overlay.worst = module.module;
        }
        sizes.push_back(size);
    }
    if (sizes.empty())
        return;
    overlay.rms_px = std::sqrt(squares / static_cast<double>(sizes.size()));
    overlay.median_px = median(std::move(sizes));
}

}  // namespace

ModelOverlay overlayOf(const BodyModel& body, const BodyView& view, const CameraModel& camera) {
    ModelOverlay overlay;
    if (!view.T_body_camera)
        return overlay;
    std::unordered_map<std::string, const ModuleTemplate*> types;
    for (const ModuleTemplate& type : body.templates)
        types[type.name] = &type;
    std::unordered_map<ModuleId, const BodyObservation*> observations;
    for (const BodyObservation& observation : view.observations)
        observations[observation.module] = &observation;
    const Eigen::AlignedBox2d picture(Vector2d::Zero(), Vector2d(camera.width, camera.height));
    std::vector<Board> boards;
    std::unordered_map<std::size_t, Vector3d> leds;
    for (const BodyModule& module : body.modules) {
        const auto type = types.find(module.type);
        if (!module.T_body_module || type == types.end())
            continue;
        const Isometry3d T_v_u = view.T_body_camera->inverse() * *module.T_body_module;
        const auto found = observations.find(module.id);
        const bool isFound = found != observations.end() && found->second->pixel;
        auto shown = projected(module, *type->second, T_v_u, camera, isFound);
        if (!shown)
            continue;
        if (isFound) {
            shown->found = found->second->pixel;
            shown->residual = found->second->residual;
            shown->counts = found->second->verdict == ObservationVerdict::Used;
        }
        Board board{overlay.modules.size(), T_v_u, {}};
        for (const Vector2d& corner : shown->outline)
            board.box.extend(corner);
        board.box = board.box.intersection(picture);
        if (!board.box.isEmpty())
            boards.push_back(board);
        leds[board.at] = T_v_u * type->second->led;
        overlay.modules.push_back(*std::move(shown));
    }
    findHidden(boards, leds, overlay);
    addFigures(overlay);
    return overlay;
}

double residualScale(const ModelOverlay& overlay, double wanted_px) {
    std::vector<double> sizes;
    for (const OverlayModule& module : overlay.modules) {
        if (module.counts && module.residual)
            sizes.push_back(module.residual->norm());
    }
    if (sizes.empty())
        return 1;
    std::sort(sizes.begin(), sizes.end());
    const double typical = sizes[sizes.size() * 9 / 10];
    // Longer than that is to look at dust.
    constexpr double kMost = 200;
    const double factor = std::min(kMost, wanted_px / std::max(1e-6, typical));
    if (factor <= 1)
        return 1;
    const double power = std::pow(10, std::floor(std::log10(factor)));
    return power * (factor >= 5 * power ? 5 : factor >= 2 * power ? 2 : 1);
}

}  // namespace skincal
