#include "core/simulation/patch_layout.h"

#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace skincal {
namespace {

constexpr double kPi = 180 * kDegree;
constexpr double kMeets = 0.3e-3;  // m: ports nearer than this are linked

Vector2d portAt(const LaidModule& module, const Vector3d& port) {
    return module.position + Eigen::Rotation2Dd(module.yaw) * Vector2d(port.head<2>());
}

struct Place {
    LaidModule module;
    double cost;
};

/// Places that an open port offers: another module turned by 0 or 180 degrees against its neighbour.
std::vector<Place> placesAt(const LaidModule& module, std::size_t port, const ModuleTemplate& type) {
    std::vector<Place> places;
    const Vector3d& p = type.ports[port];
    for (const Vector3d& q : type.ports) {
        const double turn = std::remainder(std::atan2(p.y(), p.x()) + kPi - std::atan2(q.y(), q.x()), 2 * kPi);
        if (std::abs(turn) > 1e-3 && std::abs(std::abs(turn) - kPi) > 1e-3)
            continue;
        LaidModule next;
        next.yaw = module.yaw + turn;
        next.position = portAt(module, p) - Eigen::Rotation2Dd(next.yaw) * Vector2d(q.head<2>());
        places.push_back({next, 0});
    }
    return places;
}

bool isFree(const std::vector<LaidModule>& modules, const Vector2d& position, double radius) {
    return std::none_of(modules.begin(), modules.end(),
                        [&](const LaidModule& m) { return (m.position - position).norm() < radius; });
}

void linkPortsThatMeet(const ModuleTemplate& type, PatchLayout& layout) {
    const std::size_t b = layout.modules.size() - 1;
    const double reach = 2 * type.portRadius() + kMeets;
    for (std::size_t a = 0; a < b; ++a) {
        if ((layout.modules[a].position - layout.modules[b].position).norm() > reach)
            continue;
        for (std::size_t i = 0; i < type.ports.size(); ++i) {
            for (std::size_t k = 0; k < type.ports.size(); ++k) {
                if ((portAt(layout.modules[a], type.ports[i]) - portAt(layout.modules[b], type.ports[k])).norm() <
                    kMeets)
                    layout.links.push_back({a, static_cast<int>(i), b, static_cast<int>(k)});
            }
        }
    }
}

/// Unit relief: a sum of a few waves whose curvature stays below 1 / radius.
struct Relief {
    std::vector<Eigen::Vector4d> waves;  // kx, ky, phase, amplitude
    Vector2d slope(double x, double y) const {
        Vector2d s = Vector2d::Zero();
        for (const auto& w : waves)
            s += w[3] * std::cos(w[0] * x + w[1] * y + w[2]) * w.head<2>();
        return s;
    }
    double height(double x, double y) const {
        double h = 0;
        for (const auto& w : waves)
            h += w[3] * std::sin(w[0] * x + w[1] * y + w[2]);
        return h;
    }
};

Relief makeRelief(double radius, std::uint64_t seed) {
    Random random(seed, "relief");
    Relief relief;
    constexpr int kWaves = 5;
    for (int i = 0; i < kWaves; ++i) {
        const double k = random.uniform(8, 22);  // rad/m: waves of 0.3 to 0.8 m
        const double direction = random.uniform(0, 2 * kPi);
        relief.waves.emplace_back(k * std::cos(direction), k * std::sin(direction), random.uniform(0, 2 * kPi),
                                  0.25 / (radius * kWaves * 4 * k * k));
    }
    return relief;
}

/// Frame of the surface under the layout's point: z is its normal, x follows the layout's x.
Isometry3d surfaceFrame(const PatchPlan& plan, const ModuleTemplate& type, const Relief& relief, const Vector2d& p) {
    if (plan.surface == SurfaceKind::Cylinder) {
        // Boards are tangents: a step that joins two ports turns by 2 atan(h / R), h the port's reach round the axis.
        double reach = 0;
        for (const Vector3d& port : type.ports)
            reach = std::max(reach, plan.strip ? port.norm() : std::abs(port.x()));
        const double angle = p.x() / (2 * reach) * 2 * std::atan(reach / plan.radius);
        const Matrix3d R = Eigen::AngleAxisd(angle, Vector3d::UnitY()).toRotationMatrix();
        return makeIsometry(R, R * Vector3d(0, 0, plan.radius) + Vector3d(0, p.y(), 0));
    }
    Vector2d slope = Vector2d::Zero();
    double height = 0;
    if (plan.surface == SurfaceKind::FreeForm) {
        slope = relief.slope(p.x(), p.y());
        height = relief.height(p.x(), p.y());
    } else if (plan.surface == SurfaceKind::Sole) {
        // Toe and heel spring: a parabola along y, a little camber across.
        slope = {0.8 * p.x(), 1.4 * p.y()};
        height = 0.4 * p.x() * p.x() + 0.7 * p.y() * p.y();
    }
    const Vector3d normal = Vector3d(-slope.x(), -slope.y(), 1).normalized();
    const Matrix3d R = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix();
    return makeIsometry(R, {p.x(), p.y(), height});
}

/// Positions that close the gaps at the links best, orientations given; the first module stays.
void closeGaps(const PatchLayout& layout, const ModuleTemplate& type, std::vector<Isometry3d>& poses) {
    const auto unknowns = static_cast<Eigen::Index>(poses.size()) - 1;
    if (unknowns <= 0)
        return;
    std::vector<Eigen::Triplet<double>> triplets;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, 3);
    for (const LaidLink& link : layout.links) {
        const Vector3d a = poses[link.a].linear() * type.ports[static_cast<std::size_t>(link.a_port)];
        const Vector3d b = poses[link.b].linear() * type.ports[static_cast<std::size_t>(link.b_port)];
        const Eigen::Index i = static_cast<Eigen::Index>(link.a) - 1;
        const Eigen::Index k = static_cast<Eigen::Index>(link.b) - 1;
        const auto add = [&](Eigen::Index row, Eigen::Index other, const Vector3d& target, std::size_t otherModule) {
            if (row < 0)
                return;
            triplets.emplace_back(row, row, 1.0);
            right.row(row) += target.transpose();
            if (other >= 0)
                triplets.emplace_back(row, other, -1.0);
            else
                right.row(row) += poses[otherModule].translation().transpose();
        };
        add(i, k, b - a, link.b);
        add(k, i, a - b, link.a);
    }
    Eigen::SparseMatrix<double> laplacian(unknowns, unknowns);
    laplacian.setFromTriplets(triplets.begin(), triplets.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(laplacian);
    const Eigen::MatrixXd solution = solver.solve(right);
    if (solver.info() != Eigen::Success)
        throw std::logic_error("bendOntoSurface: the layout is not connected");
    for (Eigen::Index i = 0; i < unknowns; ++i)
        poses[static_cast<std::size_t>(i) + 1].translation() = solution.row(i).transpose();
}

}  // namespace

PatchLayout growPatch(const ModuleTemplate& type, std::size_t modules, double raggedness, Random& random) {
    PatchLayout layout;
    layout.modules.push_back({Vector2d::Zero(), 0});
    double reach = std::numeric_limits<double>::infinity();
    for (const Vector3d& port : type.ports)
        reach = std::min(reach, port.norm());
    const double radius = 1.7 * reach;  // neighbours sit at twice the reach; anything nearer would overlap
    while (layout.modules.size() < modules) {
        std::vector<Place> places;
        for (const LaidModule& module : layout.modules) {
            for (std::size_t port = 0; port < type.ports.size(); ++port) {
                for (Place place : placesAt(module, port, type)) {
                    if (!isFree(layout.modules, place.module.position, radius))
                        continue;
                    // Chance decides between the two turns that the same place allows, too.
                    place.cost = place.module.position.norm() + reach * (4 * raggedness + 0.01) * random.uniform();
                    places.push_back(place);
                }
            }
        }
        if (places.empty())
            throw std::logic_error("growPatch: the template's ports don't tile the plane");
        const auto best = std::min_element(places.begin(), places.end(),
                                           [](const Place& x, const Place& y) { return x.cost < y.cost; });
        layout.modules.push_back(best->module);
        linkPortsThatMeet(type, layout);
    }
    return layout;
}

PatchLayout layStrip(const ModuleTemplate& type, std::size_t modules, bool closed) {
    const Vector3d& first = type.ports.at(0);
    const auto opposite = std::find_if(type.ports.begin(), type.ports.end(),
                                       [&](const Vector3d& port) { return (port + first).norm() < 1e-6; });
    if (opposite == type.ports.end())
        throw std::logic_error("layStrip: the template has no port opposite to its first");
    const int last = static_cast<int>(opposite - type.ports.begin());
    PatchLayout layout;
    for (std::size_t m = 0; m < modules; ++m) {
        layout.modules.push_back({{static_cast<double>(m) * 2 * first.norm(), 0}, -std::atan2(first.y(), first.x())});
        if (m > 0)
            layout.links.push_back({m - 1, 0, m, last});
    }
    if (closed && modules > 2)
        layout.links.push_back({modules - 1, 0, 0, last});
    return layout;
}

std::vector<Isometry3d> bendOntoSurface(const PatchLayout& layout, const ModuleTemplate& type, const PatchPlan& plan,
                                        std::uint64_t seed) {
    const Relief relief = makeRelief(plan.radius, seed);
    std::vector<Isometry3d> poses;
    for (const LaidModule& module : layout.modules) {
        Isometry3d T = surfaceFrame(plan, type, relief, plan.offset + module.position);
        T.linear() = T.linear() * Eigen::AngleAxisd(module.yaw, Vector3d::UnitZ()).toRotationMatrix();
        poses.push_back(T);
    }
    closeGaps(layout, type, poses);
    return poses;
}

std::vector<Vector3d> surfacePoints(const PatchPlan& plan, const ModuleTemplate& type, std::uint64_t seed,
                                    const std::vector<Vector2d>& points) {
    const Relief relief = makeRelief(plan.radius, seed);
    std::vector<Vector3d> places;
    for (const Vector2d& point : points)
        places.emplace_back(surfaceFrame(plan, type, relief, point).translation());
    return places;
}

}  // namespace skincal
