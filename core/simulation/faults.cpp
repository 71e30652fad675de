#include "core/simulation/faults.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "core/geometry/random.h"
#include "core/simulation/world.h"

namespace skincal {
namespace {

/// What drawing culprits needs to remember.
struct Draw {
    Random random;
    std::vector<bool> touched;  ///< per module: no fault may touch it any more
};

void require(bool condition, const std::string& what) {
    if (!condition)
        throw std::logic_error("addFaults: " + what);
}

void checkSizes(const FaultOptions& options) {
    for (const double size : {options.moveShift, options.moveTilt, options.shake, options.tremble, options.bumpShift,
                              options.bumpTurn, options.patchTurn})
        require(std::isfinite(size) && size >= 0, "a fault's size is negative or not a number");
}

/// `count` of the candidates, each once, in increasing order.
std::vector<std::size_t> choose(std::vector<std::size_t> candidates, std::size_t count, Random& random,
                                const std::string& what) {
    require(count <= candidates.size(), "not enough " + what + " to choose from");
    for (std::size_t i = 0; i < count; ++i)
        std::swap(candidates[i], candidates[i + random.index(candidates.size() - i)]);
    candidates.resize(count);
    std::sort(candidates.begin(), candidates.end());
    return candidates;
}

std::vector<std::size_t> untouched(const Draw& draw) {
    std::vector<std::size_t> modules;
    for (std::size_t u = 0; u < draw.touched.size(); ++u) {
        if (!draw.touched[u])
            modules.push_back(u);
    }
    return modules;
}

void rememberPoses(World& world) {
    if (world.faults.T_r_u_before.empty())
        world.faults.T_r_u_before.assign(world.T_r_u.begin(), world.T_r_u.end());
}

/// The turn is taken back from the pose before instead of added to the pose at the scan: between patches only the
/// difference shows, and cameras and tubes stay right where they are.
void movePatches(World& world, Draw& draw) {
    const FaultOptions& options = world.scenario.faults;
    std::vector<std::size_t> candidates;
    for (std::size_t k = 1; k < world.scenario.patches.size(); ++k)
        candidates.push_back(k);
    world.faults.movedPatches = choose(candidates, options.movedPatches, draw.random, "patches");
    for (const std::size_t k : world.faults.movedPatches) {
        rememberPoses(world);
        std::vector<std::size_t> modules;
        Vector3d middle = Vector3d::Zero();
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            if (world.patchOf[u] != static_cast<int>(k))
                continue;
            modules.push_back(u);
            middle += world.T_r_u[u].translation();
        }
        middle /= static_cast<double>(modules.size());
        const Matrix3d R = so3Exp(options.patchTurn * draw.random.direction());
        const Isometry3d turn = makeIsometry(R, middle - R * middle);
        for (const std::size_t u : modules) {
            world.faults.T_r_u_before[u] = turn * world.T_r_u[u];
            draw.touched[u] = true;
        }
    }
}

/// The skin was laid out well and came loose afterwards: links meet in the pose before, and no more at the scan.
void moveModules(World& world, Draw& draw) {
    const FaultOptions& options = world.scenario.faults;
    world.faults.movedModules = choose(untouched(draw), options.movedModules, draw.random, "modules");
    for (const std::size_t u : world.faults.movedModules) {
        rememberPoses(world);
        Isometry3d& T = world.T_r_u[u];
        Vector3d shift = options.moveShift * draw.random.direction();
        // Along the skin or off it; into the body it can't.
        if (shift.dot(T.linear().col(2)) < 0)
            shift = -shift;
        T.translation() += shift;
        T.linear() = so3Exp(options.moveTilt * draw.random.direction()) * T.linear();
        draw.touched[u] = true;
    }
}

/// Ports of each module that some link or the computer's wire uses, as reported.
std::vector<std::set<int>> portsInUse(const Skin& skin) {
    const auto index = skin.indexById();
    std::vector<std::set<int>> used(skin.modules.size());
    for (const Link& link : skin.links) {
        used[index.at(link.a)].insert(link.a_port);
        used[index.at(link.b)].insert(link.b_port);
    }
    for (const HostLink& host : skin.hostLinks)
        used[index.at(host.module)].insert(host.port);
    return used;
}

struct LinkEnd {
    std::size_t link;
    bool atA;
};

void misportLinks(World& world, Draw& draw) {
    const auto index = world.skin.indexById();
    const auto used = portsInUse(world.skin);
    std::vector<int> neighbours(world.T_r_u.size(), 0);
    for (std::size_t l = 0; l < world.skin.links.size(); ++l) {
        if (world.isCable[l])
            continue;
        ++neighbours[index.at(world.skin.links[l].a)];
        ++neighbours[index.at(world.skin.links[l].b)];
    }
    for (std::size_t n = 0; n < world.scenario.faults.misportedLinks; ++n) {
        std::vector<LinkEnd> all;
        std::vector<LinkEnd> spare;  // without these, both modules still have a neighbour
        for (std::size_t l = 0; l < world.skin.links.size(); ++l) {
            const Link& link = world.skin.links[l];
            const std::size_t a = index.at(link.a);
            const std::size_t b = index.at(link.b);
            if (world.isCable[l] || draw.touched[a] || draw.touched[b])
                continue;
            for (const bool atA : {true, false}) {
                const std::size_t u = atA ? a : b;
                if (used[u].size() >= world.trueTemplate(u).ports.size())
                    continue;
                all.push_back({l, atA});
                if (neighbours[a] > 1 && neighbours[b] > 1)
                    spare.push_back({l, atA});
            }
        }
        const std::vector<LinkEnd>& candidates = spare.empty() ? all : spare;
        require(!candidates.empty(), "not enough links with a free port to choose from");
        const LinkEnd end = candidates[draw.random.index(candidates.size())];
        Link& link = world.skin.links[end.link];
        const std::size_t a = index.at(link.a);
        const std::size_t b = index.at(link.b);
        const std::size_t u = end.atA ? a : b;
        std::vector<int> open;
        for (int p = 0; p < static_cast<int>(world.trueTemplate(u).ports.size()); ++p) {
            if (used[u].count(p) == 0)
                open.push_back(p);
        }
        int& port = end.atA ? link.a_port : link.b_port;
        world.faults.misportedLinks.push_back({end.link, u, port});
        port = open[draw.random.index(open.size())];
        draw.touched[a] = draw.touched[b] = true;
        --neighbours[a];
        --neighbours[b];
    }
    auto& links = world.faults.misportedLinks;
    std::sort(links.begin(), links.end(), [](const auto& x, const auto& y) { return x.link < y.link; });
}

void reportWrongTemplates(World& world, Draw& draw) {
    const auto used = portsInUse(world.skin);
    // Templates that a module could be taken for: the network would notice a port that the template lacks.
    const auto disguises = [&](std::size_t u) {
        std::vector<std::size_t> types;
        for (std::size_t t = 0; t < world.scenario.templates.size(); ++t) {
            const int last = used[u].empty() ? -1 : *used[u].rbegin();
            if (t != world.trueType[u] && last < static_cast<int>(world.scenario.templates[t].ports.size()))
                types.push_back(t);
        }
        return types;
    };
    std::vector<std::size_t> candidates = untouched(draw);
    candidates.erase(
        std::remove_if(candidates.begin(), candidates.end(), [&](std::size_t u) { return disguises(u).empty(); }),
        candidates.end());
    world.faults.wrongTemplates = choose(candidates, world.scenario.faults.wrongTemplates, draw.random,
                                         "modules that another template has the ports of");
    for (const std::size_t u : world.faults.wrongTemplates) {
        const auto types = disguises(u);
        world.skin.modules[u].type = types[draw.random.index(types.size())];
        draw.touched[u] = true;
    }
}

void shakePoses(World& world, Draw& draw) {
    const FaultOptions& options = world.scenario.faults;
    std::vector<std::size_t> candidates;
    for (std::size_t p = 0; p < world.gravity_r.size(); ++p)
        candidates.push_back(p);
    for (const std::size_t p : choose(candidates, options.shakenPoses, draw.random, "poses")) {
        ShakenPose shaken;
        shaken.pose = p;
        shaken.acceleration_r = options.shake / std::sqrt(3.0) * draw.random.normal3();
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
            shaken.acceleration_u.emplace_back(options.tremble * draw.random.normal3());
        world.faults.shakenPoses.push_back(std::move(shaken));
    }
}

/// A knock shows only where something is seen before and after it, enough for a pose each.
bool seesBothHalves(const World& world, std::size_t view) {
    constexpr int kEnough = 4;
    int before = 0;
    int after = 0;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        if (visiblePixel(world, view, u))
            ++(scannedAfterBump(world, u) ? after : before);
    }
    return before >= kEnough && after >= kEnough;
}

void bumpViews(World& world, Draw& draw) {
    const FaultOptions& options = world.scenario.faults;
    if (options.bumpedViews == 0)
        return;
    require(world.scenario.views.scan == ScanKind::Detections, "bumped views are for scans without pictures");
    std::vector<std::size_t> candidates;
    for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
        if (seesBothHalves(world, v))
            candidates.push_back(v);
    }
    for (const std::size_t v : choose(candidates, options.bumpedViews, draw.random, "views")) {
        const Matrix3d R_v_w = so3Exp(options.bumpTurn * draw.random.direction());
        const Vector3d shift_v = options.bumpShift * draw.random.direction();
        world.faults.bumpedViews.push_back({v, world.T_r_v[v] * makeIsometry(R_v_w, shift_v)});
    }
}

}  // namespace

void addFaults(World& world) {
    checkSizes(world.scenario.faults);
    Draw draw{Random(world.seed, "faults"), std::vector<bool>(world.T_r_u.size(), false)};
    for (const std::size_t u : world.covered)
        draw.touched[u] = true;
    // Those first that leave the least choice to others.
    movePatches(world, draw);
    misportLinks(world, draw);
    reportWrongTemplates(world, draw);
    moveModules(world, draw);
    shakePoses(world, draw);
    bumpViews(world, draw);
}

const Isometry3d& poseAtGravity(const World& world, std::size_t module) {
    return world.faults.T_r_u_before.empty() ? world.T_r_u[module] : world.faults.T_r_u_before[module];
}

}  // namespace skincal
