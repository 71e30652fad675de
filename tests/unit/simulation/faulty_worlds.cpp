#include "tests/unit/simulation/faulty_worlds.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace skincal {

Scenario hexagonsOnly() {
    Scenario scenario = *findScenario("freeform");
    scenario.templates = {paperHexagon(), triangleTemplate(), rectangleTemplate()};
    scenario.cables = true;
    return scenario;
}

World faulty(const FaultOptions& faults, std::uint64_t seed, Scenario scenario) {
    scenario.faults = faults;
    return buildWorld(scenario, seed);
}

bool contains(const std::vector<std::size_t>& sorted, std::size_t value) {
    return std::binary_search(sorted.begin(), sorted.end(), value);
}

bool nobody(std::size_t, std::size_t) {
    return false;
}

void expectSameGravity(const World& a, const World& b, const Exempt& exempt) {
    const auto x = simulateGravity(a);
    const auto y = simulateGravity(b);
    ASSERT_EQ(x.size(), y.size());
    const std::size_t poses = a.gravity_r.size();
    for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_EQ(x[i].acceleration == y[i].acceleration, !exempt(i / poses, i % poses)) << "reading " << i;
}

std::map<std::pair<std::size_t, std::size_t>, Vector2d> pixelsOf(const World& world) {
    const auto views = simulateDetections(world);
    const auto index = world.skin.indexById();
    std::map<std::pair<std::size_t, std::size_t>, Vector2d> pixels;
    for (std::size_t v = 0; v < views.size(); ++v) {
        for (const LedDetection& d : views[v].found)
            pixels.emplace(std::pair(v, index.at(d.module)), d.pixel);
    }
    return pixels;
}

void expectSameDetections(const World& a, const World& b, const Exempt& exempt) {
    const auto x = pixelsOf(a);
    const auto y = pixelsOf(b);
    for (std::size_t v = 0; v < a.T_r_v.size(); ++v) {
        for (std::size_t u = 0; u < a.T_r_u.size(); ++u) {
            const auto inX = x.find({v, u});
            const auto inY = y.find({v, u});
            const bool neither = inX == x.end() && inY == y.end();
            const bool same = neither || (inX != x.end() && inY != y.end() && inX->second == inY->second);
            EXPECT_TRUE(neither || same != exempt(v, u)) << "view " << v << ", module " << u;
        }
    }
}

void expectSameSkin(const World& a, const World& b) {
    ASSERT_EQ(a.skin.modules.size(), b.skin.modules.size());
    for (std::size_t u = 0; u < a.skin.modules.size(); ++u) {
        EXPECT_EQ(a.skin.modules[u].id, b.skin.modules[u].id);
        EXPECT_EQ(a.skin.modules[u].type, b.skin.modules[u].type);
    }
    ASSERT_EQ(a.skin.links.size(), b.skin.links.size());
    for (std::size_t l = 0; l < a.skin.links.size(); ++l) {
        EXPECT_EQ(a.skin.links[l].a_port, b.skin.links[l].a_port);
        EXPECT_EQ(a.skin.links[l].b_port, b.skin.links[l].b_port);
    }
}

void expectSamePoses(const std::vector<Isometry3d>& a, const std::vector<Isometry3d>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_EQ(a[i].matrix(), b[i].matrix()) << i;
}

}  // namespace skincal
