#include "core/simulation/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "core/simulation/patch_layout.h"

namespace skincal {
namespace {

/// Random ids with gaps, as a network gives them out.
std::vector<ModuleId> drawIds(std::size_t count, Random& random) {
    std::set<std::uint32_t> used;
    std::vector<ModuleId> ids;
    while (ids.size() < count) {
        const auto id = static_cast<std::uint32_t>(1 + random.index(20 * count + 50));
        if (used.insert(id).second)
            ids.emplace_back(id);
    }
    return ids;
}

void addPatch(World& world, std::size_t k, Random& random) {
    const PatchPlan& plan = world.scenario.patches[k];
    const ModuleTemplate& type = world.scenario.templates.at(plan.type);
    Random growth(world.seed + 1000 * k, "layout");
    const PatchLayout layout =
        plan.strip ? layStrip(type, plan.modules, plan.ring) : growPatch(type, plan.modules, plan.raggedness, growth);
    const auto poses = bendOntoSurface(layout, type, plan, world.seed);
    const std::size_t first = world.T_r_u.size();
    for (const Isometry3d& T_s_u : poses) {
        Isometry3d T = plan.T_r_s * T_s_u;
        const PlayOptions& play = world.scenario.play;
        T.translation() += play.position * random.normal3();
        T.linear() = so3Exp(play.tilt * random.normal3()) * T.linear();
        world.T_r_u.push_back(T);
        world.patchOf.push_back(static_cast<int>(k));
        world.skin.modules.push_back({ModuleId(), plan.type});
        world.trueType.push_back(plan.type);
    }
    for (const LaidLink& link : layout.links) {
        // Positions for now; ids are given out once all modules are there.
        world.skin.links.push_back({ModuleId(static_cast<std::uint32_t>(first + link.a)), link.a_port,
                                    ModuleId(static_cast<std::uint32_t>(first + link.b)), link.b_port});
        world.isCable.push_back(false);
    }
    if (plan.surface == SurfaceKind::Cylinder) {
        double low = 1e9;
        double high = -1e9;
        for (const Isometry3d& T : poses) {
            low = std::min(low, T.translation().y());
            high = std::max(high, T.translation().y());
        }
        world.tubes.push_back(
            {plan.T_r_s * Vector3d(0, low - 0.02, 0), plan.T_r_s * Vector3d(0, high + 0.02, 0), 0.95 * plan.radius});
    }
}

/// One wire from a free port of each patch to one of the next.
void addCables(World& world, Random& random) {
    std::set<std::pair<std::uint32_t, int>> taken;
    for (const Link& link : world.skin.links) {
        taken.insert({link.a.value, link.a_port});
        taken.insert({link.b.value, link.b_port});
    }
    const auto freePort = [&](int patch) -> std::optional<std::pair<std::uint32_t, int>> {
        std::vector<std::pair<std::uint32_t, int>> open;
        for (std::size_t u = 0; u < world.patchOf.size(); ++u) {
            if (world.patchOf[u] != patch)
                continue;
            for (int p = 0; p < static_cast<int>(world.trueTemplate(u).ports.size()); ++p) {
                if (taken.count({static_cast<std::uint32_t>(u), p}) == 0)
                    open.emplace_back(static_cast<std::uint32_t>(u), p);
            }
        }
        if (open.empty())
            return std::nullopt;
        return open[random.index(open.size())];
    };
    for (int k = 0; k + 1 < static_cast<int>(world.scenario.patches.size()); ++k) {
        const auto a = freePort(k);
        const auto b = freePort(k + 1);
        if (!a || !b)
            continue;
        taken.insert(*a);
        taken.insert(*b);
        world.skin.links.push_back({ModuleId(a->first), a->second, ModuleId(b->first), b->second});
        world.isCable.push_back(true);
    }
}

void poseBody(World& world) {
    Random random(world.seed, "poses");
    const SensorOptions& sensors = world.scenario.sensors;
    const Vector3d first = random.direction();
    for (int p = 0; p < sensors.poses; ++p) {
        if (sensors.parallelPoses) {
            world.gravity_r.push_back(kStandardGravity * first);
            continue;
        }
        // The best of a few draws: an operator does not show the same side twice.
        Vector3d best = random.direction();
        double bestSpread = -2;
        for (int draw = 0; draw < 8; ++draw) {
            const Vector3d candidate = random.direction();
            double nearest = -1;
            for (const Vector3d& g : world.gravity_r)
                nearest = std::max(nearest, g.normalized().dot(candidate));
            if (-nearest > bestSpread) {
                bestSpread = -nearest;
                best = candidate;
            }
        }
        world.gravity_r.push_back(kStandardGravity * best);
    }
}

struct PatchSide {
    Vector3d middle = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
};

std::vector<PatchSide> sidesOf(const World& world) {
    std::vector<PatchSide> sides(world.scenario.patches.size());
    std::vector<double> count(sides.size(), 0);
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        PatchSide& side = sides[static_cast<std::size_t>(world.patchOf[u])];
        side.middle += world.T_r_u[u].translation();
        side.normal += world.T_r_u[u].linear().col(2);
        ++count[static_cast<std::size_t>(world.patchOf[u])];
    }
    for (std::size_t k = 0; k < sides.size(); ++k) {
        sides[k].middle /= count[k];
        // A ring looks everywhere; cameras go round it.
        sides[k].normal = sides[k].normal.norm() > 0.1 * count[k] ? sides[k].normal.normalized() : Vector3d::Zero();
    }
    return sides;
}

Isometry3d lookAt(const Vector3d& from, const Vector3d& to, double roll) {
    const Vector3d z = (to - from).normalized();
    const Vector3d aside = std::abs(z.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitY();
    const Vector3d x = aside.cross(z).normalized();
    Matrix3d R;
    R << -x, z.cross(-x), z;
    return makeIsometry(R * Eigen::AngleAxisd(roll, Vector3d::UnitZ()).toRotationMatrix(), from);
}

/// Cameras that go from patch to patch, each between two of them: what lies between is seen from both sides.
void placeCameras(World& world) {
    const auto sides = sidesOf(world);
    const ViewOptions& views = world.scenario.views;
    Random random(world.seed, "cameras");
    for (int v = 0; v < views.count; ++v) {
        const double turn = views.count > 1 ? static_cast<double>(v) / (views.count - 1) : 0.5;
        const double at = turn * static_cast<double>(sides.size() - 1);
        const auto k = std::min(static_cast<std::size_t>(at), sides.size() - 1);
        const std::size_t next = std::min(k + 1, sides.size() - 1);
        const double share = at - static_cast<double>(k);
        const Vector3d target = (1 - share) * sides[k].middle + share * sides[next].middle;
        Vector3d direction = (1 - share) * sides[k].normal + share * sides[next].normal;
        if (direction.norm() < 0.2) {
            // Patches back to back, or a ring: round the axis that the surface has.
            const Matrix3d R = world.scenario.patches[k].T_r_s.linear();
            const double angle = turn * 2 * 180 * kDegree;
            direction = R * Vector3d(std::sin(angle), 0.25, std::cos(angle));
        }
        direction.normalize();
        const Vector3d tilted = so3Exp(views.tilt * (2 * random.uniform() - 1) * random.direction()) * direction;
        const double distance = views.distance * random.uniform(0.9, 1.15);
        world.T_r_v.push_back(
            lookAt(target + distance * tilted, target + 0.01 * random.normal3(), random.uniform(-0.3, 0.3)));
    }
}

}  // namespace

std::string viewName(std::size_t view) {
    return fmt::format("view{}", view);
}

World buildWorld(const Scenario& scenario, std::uint64_t seed) {
    if (scenario.patches.empty() || scenario.templates.empty())
        throw std::logic_error("buildWorld: a scenario needs a patch and a template");
    World world;
    world.scenario = scenario;
    world.seed = seed;
    world.skin.templates = scenario.templates;
    Random play(seed, "play");
    for (std::size_t k = 0; k < scenario.patches.size(); ++k)
        addPatch(world, k, play);
    Random network(seed, "network");
    if (scenario.cables)
        addCables(world, network);
    const auto ids = drawIds(world.T_r_u.size(), network);
    for (std::size_t u = 0; u < ids.size(); ++u)
        world.skin.modules[u].id = ids[u];
    for (Link& link : world.skin.links) {
        link.a = ids[link.a.value];
        link.b = ids[link.b.value];
    }
    if (scenario.covered > 0)
        layCard(world, scenario.covered);
    poseBody(world);
    placeCameras(world);
    addFaults(world);
    return world;
}

}  // namespace skincal
