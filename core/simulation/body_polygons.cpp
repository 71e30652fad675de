#include "core/simulation/body_polygons.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace skincal {
namespace {

constexpr double kPi = 180 * kDegree;

/// A lamp over the camera's left shoulder, and what the walls return.
double shade(const Vector3d& normal_v) {
    static const Vector3d kLamp = Vector3d(-0.45, -0.65, -0.6).normalized();
    return 0.4 + 0.6 * std::max(0.0, normal_v.dot(kLamp));
}

/// Points of a circle or of a regular polygon in a module's plane.
std::vector<Vector3d> disc(const Vector3d& middle, double radius, int corners, double turn = 0) {
    std::vector<Vector3d> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = turn + 2 * kPi * i / corners;
        points.emplace_back(middle + radius * Vector3d(std::cos(angle), std::sin(angle), 0));
    }
    return points;
}

void addModule(const Isometry3d& T_v_u, const ModuleTemplate& type, std::vector<PolygonGroup>& groups) {
    const Vector3d normal = T_v_u.linear().col(2);
    if (normal.dot(T_v_u.translation()) >= 0)
        return;  // seen from behind: the surface it lies on hides it
    const double light = shade(normal);
    const double depth = T_v_u.translation().norm();
    const auto placed = [&](std::vector<Vector3d> corners, double brightness) {
        for (Vector3d& p : corners)
            p = T_v_u * p;
        return PolygonGroup::Polygon{std::move(corners), light * brightness};
    };
    const auto outline = [&](double scale, double z) {
        std::vector<Vector3d> corners;
        for (const Vector2d& p : type.outline)
            corners.emplace_back(scale * p.x(), scale * p.y(), z);
        return corners;
    };
    // Elastomer fills the gaps between boards: drawn before all of them.
    groups.push_back({depth + 0.03, {placed(outline(1.16, -0.001), 0.45)}});
    PolygonGroup board{depth, {placed(outline(1.0, 0), 0.75), placed(outline(0.93, 0), 0.95)}};
    for (const Vector3d& port : type.ports)
        board.polygons.push_back(placed(disc(0.84 * port, 0.0013, 4, std::atan2(port.y(), port.x()) + kPi / 4), 1.9));
    for (const SensorSite& sensor : type.sensors) {
        const bool force = sensor.kind == "force";
        board.polygons.push_back(
            placed(disc(sensor.position, force ? 0.0019 : 0.0011, force ? 12 : 4), force ? 1.5 : 0.35));
    }
    board.polygons.push_back(placed(disc(type.led, 0.0015, 4, kPi / 4), 2.2));
    groups.push_back(std::move(board));
}

void addTube(const Tube& tube, const Isometry3d& T_v_r, std::vector<PolygonGroup>& groups) {
    const Vector3d from = T_v_r * tube.from;
    const Vector3d axis = T_v_r * tube.to - from;
    const Vector3d a = axis.unitOrthogonal();
    const Vector3d b = axis.normalized().cross(a);
    constexpr int kRound = 36;
    const int pieces = std::max(1, static_cast<int>(std::ceil(axis.norm() / 0.02)));
    const auto direction = [&](int i) -> Vector3d {
        return std::cos(2 * kPi * i / kRound) * a + std::sin(2 * kPi * i / kRound) * b;
    };
    const auto add = [&](std::vector<Vector3d> corners, const Vector3d& normal, double brightness) {
        Vector3d middle = Vector3d::Zero();
        for (const Vector3d& p : corners)
            middle += p / static_cast<double>(corners.size());
        if (normal.dot(middle) < 0)
            groups.push_back({middle.norm() + 0.06, {{std::move(corners), brightness * shade(normal)}}});
    };
    for (int i = 0; i < kRound; ++i) {
        for (int k = 0; k < pieces; ++k) {
            const Vector3d low = from + axis * k / pieces;
            const Vector3d high = from + axis * (k + 1) / pieces;
            const Vector3d p = tube.radius * direction(i);
            const Vector3d q = tube.radius * direction(i + 1);
            add({low + p, low + q, high + q, high + p}, (p + q).normalized(), 1.25);
        }
    }
    for (const double end : {0.0, 1.0}) {
        std::vector<Vector3d> cap;
        for (int i = 0; i < kRound; ++i)
            cap.push_back(from + end * axis + tube.radius * direction(i));
        add(std::move(cap), (2 * end - 1) * axis.normalized(), 0.8);
    }
}

/// What patches that are not on a tube are mounted on: a plate that reaches a little beyond their boards.
void addPlate(const World& world, const Isometry3d& T_v_r, std::vector<PolygonGroup>& groups) {
    constexpr double kReach = 0.034;  // m, from a board's middle
    constexpr double kBehind = 0.08;  // m: drawn before everything that lies on it
    std::vector<cv::Point2f> points;
    Vector3d normal = Vector3d::Zero();
    double depth = 0;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const Isometry3d T_v_u = T_v_r * world.T_r_u[u];
        const auto& plan = world.scenario.patches[static_cast<std::size_t>(world.patchOf[u])];
        if (plan.surface == SurfaceKind::Cylinder || T_v_u.linear().col(2).dot(T_v_u.translation()) >= 0)
            continue;
        normal += T_v_u.linear().col(2);
        depth = std::max(depth, T_v_u.translation().norm());
        for (const Vector3d& corner : disc({0, 0, -0.004}, kReach, 16)) {
            const Vector3d p = T_v_u * corner;
            if (p.z() > 0.01)
                points.emplace_back(static_cast<float>(p.x() / p.z()), static_cast<float>(p.y() / p.z()));
        }
    }
    if (points.size() < 3)
        return;
    std::vector<cv::Point2f> hull;
    cv::convexHull(points, hull);
    const auto lifted = [&](double scale) {
        cv::Point2f middle(0, 0);
        for (const cv::Point2f& p : hull)
            middle += p * (1.0F / static_cast<float>(hull.size()));
        std::vector<Vector3d> corners;
        for (const cv::Point2f& p : hull) {
            const cv::Point2f q = middle + static_cast<float>(scale) * (p - middle);
            corners.push_back(depth * Vector3d(static_cast<double>(q.x), static_cast<double>(q.y), 1));
        }
        return corners;
    };
    const double light = shade(normal.normalized());
    groups.push_back({depth + kBehind, {{lifted(1.02), 1.9 * light}, {lifted(1.0), 1.45 * light}}});
}

/// White, with a few lines of print.
PolygonGroup cardGroup(const Card& card, const Isometry3d& T_v_r) {
    const Isometry3d T_v_k = T_v_r * card.T_r_k;
    const double light = shade(T_v_k.linear().col(2) * (T_v_k.linear().col(2).dot(T_v_k.translation()) < 0 ? 1 : -1));
    PolygonGroup group;
    const auto add = [&](double x0, double y0, double x1, double y1, double brightness) {
        std::vector<Vector3d> corners;
        for (const auto& [x, y] : {std::pair(x0, y0), std::pair(x1, y0), std::pair(x1, y1), std::pair(x0, y1)})
            corners.push_back(T_v_k * Vector3d(x * card.width, y * card.height, 0));
        group.polygons.push_back({std::move(corners), light * brightness});
    };
    add(-0.5, -0.5, 0.5, 0.5, 2.3);
    add(-0.42, 0.22, 0.1, 0.33, 0.8);
    for (int line = 0; line < 3; ++line)
        add(-0.42, -0.36 + 0.12 * line, 0.05 + 0.1 * line, -0.32 + 0.12 * line, 1.2);
    add(0.25, -0.1, 0.42, 0.25, 1.0);
    return group;
}

}  // namespace

std::vector<PolygonGroup> bodyPolygons(const World& world, const Isometry3d& T_v_r) {
    std::vector<PolygonGroup> groups;
    for (const Tube& tube : world.tubes)
        addTube(tube, T_v_r, groups);
    addPlate(world, T_v_r, groups);
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        addModule(T_v_r * world.T_r_u[u], world.trueTemplate(u), groups);
    std::stable_sort(groups.begin(), groups.end(),
                     [](const PolygonGroup& x, const PolygonGroup& y) { return x.depth > y.depth; });
    for (const Card& card : world.cards)
        groups.push_back(cardGroup(card, T_v_r));
    return groups;
}

}  // namespace skincal
