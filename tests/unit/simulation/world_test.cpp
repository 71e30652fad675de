#include "core/simulation/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace skincal {
namespace {

class Scenarios : public testing::TestWithParam<std::string> {
  protected:
    const Scenario& scenario() const { return *findScenario(GetParam()); }
};

TEST_P(Scenarios, AreWellFormedWorlds) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const World world = buildWorld(scenario(), seed);
        std::set<ModuleId> ids;
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            EXPECT_TRUE(isRigid(world.T_r_u[u]));
            EXPECT_TRUE(ids.insert(world.skin.modules[u].id).second);
        }
        const auto index = world.skin.indexById();
        for (std::size_t l = 0; l < world.skin.links.size(); ++l) {
            const Link& link = world.skin.links[l];
            const std::size_t a = index.at(link.a);
            const std::size_t b = index.at(link.b);
            EXPECT_EQ(world.isCable[l], world.patchOf[a] != world.patchOf[b]);
            EXPECT_FALSE(link.decided) << "the network does not know what is a cable";
            const double gap = (world.T_r_u[a] * world.skin.templateOf(a).ports[static_cast<std::size_t>(link.a_port)] -
                                world.T_r_u[b] * world.skin.templateOf(b).ports[static_cast<std::size_t>(link.b_port)])
                                   .norm();
            if (!world.isCable[l]) {
                EXPECT_LT(gap, 4e-3);
            }
        }
        for (const Vector3d& g : world.gravity_r)
            EXPECT_NEAR(g.norm(), kStandardGravity, 1e-9);
    }
}

TEST_P(Scenarios, EveryPatchIsSeenAndEveryPixelIsInThePicture) {
    const World world = buildWorld(scenario(), 1);
    const Truth truth = truthOf(world);
    const auto index = world.skin.indexById();
    std::set<int> seen;
    for (const TruePixel& pixel : truth.pixels) {
        EXPECT_TRUE(world.scenario.camera.contains(pixel.pixel));
        seen.insert(world.patchOf[index.at(pixel.module)]);
    }
    EXPECT_EQ(seen.size(), world.scenario.patches.size());
}

std::vector<std::string> scenarioNames() {
    std::vector<std::string> names;
    for (const Scenario& scenario : builtInScenarios())
        names.push_back(scenario.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Scenarios, testing::ValuesIn(scenarioNames()), [](const auto& parameter) {
    std::string name = parameter.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

TEST(World, TheSameSeedGivesTheSameNumbers) {
    const Scenario& scenario = *findScenario("arm");
    const World a = buildWorld(scenario, 7);
    const World b = buildWorld(scenario, 7);
    const World c = buildWorld(scenario, 8);
    const auto ga = simulateGravity(a);
    const auto gb = simulateGravity(b);
    const auto gc = simulateGravity(c);
    ASSERT_EQ(ga.size(), gb.size());
    for (std::size_t i = 0; i < ga.size(); ++i)
        EXPECT_EQ(ga[i].acceleration, gb[i].acceleration);
    EXPECT_NE(ga[0].acceleration, gc[0].acceleration);
    EXPECT_EQ(simulateDetections(a)[0].found[0].pixel, simulateDetections(b)[0].found[0].pixel);
}

TEST(World, AnIdealAccelerometerReadsGravityInItsOwnFrame) {
    Scenario scenario = *findScenario("cylinder");
    scenario.sensors.bias = scenario.sensors.scale = scenario.sensors.noise = 0;
    const World world = buildWorld(scenario, 2);
    const auto readings = simulateGravity(world);
    const std::size_t poses = world.gravity_r.size();
    ASSERT_EQ(readings.size(), poses * world.T_r_u.size());
    for (std::size_t i = 0; i < readings.size(); ++i)
        EXPECT_LT((world.T_r_u[i / poses].linear() * readings[i].acceleration - world.gravity_r[i % poses]).norm(),
                  1e-9);
}

TEST(World, SensorErrorsHaveTheSizeAskedFor) {
    Scenario scenario = *findScenario("thousand");
    scenario.sensors.scale = 0;
    scenario.sensors.noise = 0;
    const World world = buildWorld(scenario, 3);
    const auto readings = simulateGravity(world);
    double squares = 0;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const auto& first = readings[u * world.gravity_r.size()];
        squares += (first.acceleration - world.T_r_u[u].linear().transpose() * world.gravity_r[0]).squaredNorm();
    }
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(3 * world.T_r_u.size())), 0.3, 0.02);
}

TEST(World, ParallelPosesAreParallel) {
    Scenario scenario = *findScenario("plane");
    scenario.sensors.parallelPoses = true;
    const World world = buildWorld(scenario, 4);
    for (const Vector3d& g : world.gravity_r)
        EXPECT_EQ(g, world.gravity_r.front());
}

TEST(World, OutliersComeInTheShareAskedFor) {
    const World world = buildWorld(*findScenario("outliers"), 5);
    const auto views = simulateDetections(world);
    const auto index = world.skin.indexById();
    double far = 0;
    double all = 0;
    for (std::size_t v = 0; v < views.size(); ++v) {
        for (const LedDetection& d : views[v].found) {
            ++all;
            far += (d.pixel - *visiblePixel(world, v, index.at(d.module))).norm() > 1 ? 1 : 0;
        }
    }
    EXPECT_NEAR(far / all, 0.1, 0.04);
}

TEST(World, ATubeHidesWhatLiesBehindIt) {
    Scenario scenario = *findScenario("plane");
    World world = buildWorld(scenario, 6);
    ASSERT_TRUE(visiblePixel(world, 0, 0));
    const Vector3d led = world.T_r_u[0] * world.skin.templateOf(0).led;
    const Vector3d middle = 0.5 * (led + world.T_r_v[0].translation());
    world.tubes.push_back({middle - Vector3d(0.05, 0, 0), middle + Vector3d(0.05, 0, 0), 0.02});
    EXPECT_FALSE(visiblePixel(world, 0, 0));
}

TEST(World, CodedScansGiveEveryModuleAWordOfItsOwn) {
    for (const char* name : {"demo", "coded"}) {
        const World world = buildWorld(*findScenario(name), 1);
        const auto frames = planScan(world, 0);
        EXPECT_TRUE(frames.front().lit.empty());
        EXPECT_EQ(frames[1].lit.size(), world.skin.modules.size());
        std::map<ModuleId, std::string> words;
        for (const FrameInfo& frame : frames) {
            for (const SkinModule& module : world.skin.modules)
                words[module.id] += '0';
            for (const LitModule& lit : frame.lit)
                words[lit.module].back() = '1';
        }
        for (auto a = words.begin(); a != words.end(); ++a) {
            for (auto b = std::next(a); b != words.end(); ++b) {
                int distance = 0;
                for (std::size_t k = 0; k < frames.size(); ++k)
                    distance += a->second[k] != b->second[k] ? 1 : 0;
                EXPECT_GE(distance, 4) << "two bits and their complements";
            }
        }
    }
}

TEST(World, OneAtATimeAlternatesWithBackgrounds) {
    const World world = buildWorld(*findScenario("one-at-a-time"), 1);
    const auto frames = planScan(world, 1);
    ASSERT_EQ(frames.size(), 2 * world.skin.modules.size() + 1);
    for (std::size_t k = 0; k < frames.size(); ++k)
        EXPECT_EQ(frames[k].lit.size(), k % 2);
}

TEST(World, NeedsAPatch) {
    EXPECT_THROW((void)buildWorld(Scenario{}, 1), std::logic_error);
}

}  // namespace
}  // namespace skincal
