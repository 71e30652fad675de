#include "ui/presenters/network_layout.h"

#include <gtest/gtest.h>

#include <QLineF>
#include <map>

#include "core/simulation/world.h"

namespace skincal {
namespace {

std::vector<JudgedLink> trueLinks(const World& world) {
    std::vector<JudgedLink> links;
    for (std::size_t i = 0; i < world.skin.links.size(); ++i)
        links.push_back({world.skin.links[i], world.isCable[i] ? LinkKind::Cable : LinkKind::Adjacent, {}, false});
    return links;
}

TEST(LayOutFlat, NeighboursTouchPortToPortAndPatchesDoNotOverlap) {
    for (const char* name : {"coded", "demo", "arm", "cylinder", "freeform", "mixed"}) {
        const Scenario* scenario = findScenario(name);
        if (scenario == nullptr)
            continue;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const World world = buildWorld(*scenario, seed);
            const auto links = trueLinks(world);
            const FlatNetwork network = layOutFlat(world.skin, links);
            ASSERT_EQ(network.modules.size(), world.skin.modules.size());
            ASSERT_EQ(network.links.size(), links.size());
            std::map<ModuleId, unsigned> patchOf;
            std::map<unsigned, QRectF> bounds;
            for (const FlatModule& module : network.modules) {
                EXPECT_TRUE(patchOf.emplace(module.module, module.patch).second);
                bounds[module.patch] |= module.outline.boundingRect();
                EXPECT_TRUE(network.bounds.adjusted(-1, -1, 1, 1).contains(module.outline.boundingRect()));
            }
            for (const FlatLink& link : network.links) {
                const Link& reported = links[static_cast<std::size_t>(link.row)].link;
                if (link.kind == LinkKind::Adjacent) {
                    EXPECT_EQ(patchOf.at(reported.a), patchOf.at(reported.b));
                    EXPECT_LT(QLineF(link.from, link.to).length(), 1e-6) << name << ' ' << reported.a.value;
                }
            }
            for (const auto& [a, boundsOfA] : bounds) {
                for (const auto& [b, boundsOfB] : bounds) {
                    EXPECT_TRUE(a == b || !boundsOfA.intersects(boundsOfB)) << name << " patches " << a << ' ' << b;
                }
            }
        }
    }
}

TEST(LayOutFlat, ManagesWithoutLinksAndWithoutModules) {
    EXPECT_TRUE(layOutFlat({}, {}).modules.empty());
    const World world = buildWorld(*findScenario("coded"), 1);
    const FlatNetwork network = layOutFlat(world.skin, {});
    EXPECT_EQ(network.modules.size(), world.skin.modules.size());
    for (std::size_t i = 0; i < network.modules.size(); ++i)
        EXPECT_EQ(network.modules[i].patch, i) << "each alone";
}

}  // namespace
}  // namespace skincal
