#include "core/simulation/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/simulation/simulated_accelerometer.h"

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
            // As the skin was laid out, before anything moved or was misreported.
            int aPort = link.a_port;
            int bPort = link.b_port;
            for (const MisportedLink& wrong : world.faults.misportedLinks) {
                if (wrong.link == l)
                    (wrong.module == a ? aPort : bPort) = wrong.truePort;
            }
            const double gap = (poseAtGravity(world, a) * world.trueTemplate(a).ports[static_cast<std::size_t>(aPort)] -
                                poseAtGravity(world, b) * world.trueTemplate(b).ports[static_cast<std::size_t>(bPort)])
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

    // A chip turned by w on its board reads w x a more: two thirds of |w|^2 |a|^2, and nothing longer or shorter.
    scenario.sensors.bias = 0;
    scenario.sensors.misalignment = 0.5 * kDegree;
    const auto askew = simulateGravity(buildWorld(scenario, 3));
    squares = 0;
    for (std::size_t i = 0; i < askew.size(); ++i) {
        const Vector3d ideal =
            world.T_r_u[i / world.gravity_r.size()].linear().transpose() * world.gravity_r[i % world.gravity_r.size()];
        EXPECT_NEAR(askew[i].acceleration.norm(), kStandardGravity, 1e-9);
        squares += (askew[i].acceleration - ideal).squaredNorm();
    }
    const double expected = std::sqrt(2.0) * scenario.sensors.misalignment * kStandardGravity;
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(askew.size())), expected, 0.05 * expected);
}

TEST(World, ReadingsAreThoseOfItsAccelerometers) {
    for (const char* name : {"faults", "misaligned", "moved-joint"}) {
        const World world = buildWorld(*findScenario(name), 8);
        auto sensors = accelerometersOf(world);
        for (SimulatedAccelerometer& sensor : sensors) {
            EXPECT_EQ(sensor.noise, world.scenario.sensors.noise);
            sensor.noise = 0;
        }
        const auto index = world.skin.indexById();
        Random unused(1);
        double squares = 0;
        std::size_t count = 0;
        for (const GravityReading& reading : simulateGravity(world)) {
            const auto pose = static_cast<std::size_t>(reading.pose);
            const auto& shaken = world.faults.shakenPoses;
            if (std::any_of(shaken.begin(), shaken.end(), [&](const ShakenPose& s) { return s.pose == pose; }))
                continue;
            const std::size_t u = index.at(reading.module);
            const Vector3d ideal_u = poseAtGravity(world, u).linear().transpose() * world.gravity_r[pose];
            squares += (reading.acceleration - sensors[u].read(ideal_u, unused)).squaredNorm();
            count += 3;
        }
        EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)), world.scenario.sensors.noise, 0.003) << name;
    }
}

TEST(World, MisalignedChipsAreOneOfTheScenarios) {
    const World world = buildWorld(*findScenario("misaligned"), 1);
    Scenario straight = world.scenario;
    EXPECT_GT(straight.sensors.misalignment, 0);
    straight.sensors.misalignment = 0;
    EXPECT_NE(simulateGravity(world)[0].acceleration, simulateGravity(buildWorld(straight, 1))[0].acceleration);
}

TEST(World, ParallelPosesAreParallel) {
    const World world = buildWorld(*findScenario("parallel-poses"), 4);
    ASSERT_GE(world.gravity_r.size(), 2U);
    for (const Vector3d& g : world.gravity_r)
        EXPECT_EQ(g, world.gravity_r.front());
    // No module ever reads anything else than the first time, but for the noise.
    const auto readings = simulateGravity(world);
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const GravityReading& first = readings[i - i % world.gravity_r.size()];
        EXPECT_LT((readings[i].acceleration - first.acceleration).norm(), 8 * world.scenario.sensors.noise);
    }
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

TEST(World, ACardCoversTheSameSixModulesOfTheSoleInEveryView) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const World world = buildWorld(*findScenario("shoe-sole"), seed);
        World bare = world;
        bare.cards.clear();
        ASSERT_EQ(world.cards.size(), 1U);
        ASSERT_EQ(world.covered.size(), 6U);
        EXPECT_EQ(world.covered.front(), 0U) << "the middle one among them";
        for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
            for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
                const bool covered = std::binary_search(world.covered.begin(), world.covered.end(), u);
                EXPECT_EQ(visiblePixel(world, v, u).has_value(), visiblePixel(bare, v, u) && !covered)
                    << "seed " << seed << ", view " << v << ", module " << u;
            }
        }
        // It lies on the boards, not in them.
        for (const std::size_t u : world.covered) {
            for (const Vector2d& corner : world.skin.templateOf(u).outline)
                EXPECT_LT((world.cards[0].T_r_k.inverse() * (world.T_r_u[u] * Vector3d(corner.x(), corner.y(), 0))).z(),
                          0);
        }
    }
}

TEST(World, ACardCoversNoMoreThanItCan) {
    World world = buildWorld(*findScenario("plane"), 1);
    EXPECT_THROW(layCard(world, 20), std::logic_error);
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
                EXPECT_GE(distance, 6) << "three bits and their complements";
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
