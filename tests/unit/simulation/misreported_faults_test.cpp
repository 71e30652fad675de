#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <stdexcept>

#include "core/simulation/renderer.h"
#include "core/skin/skin_graph.h"
#include "tests/unit/simulation/faulty_worlds.h"

namespace skincal {
namespace {

constexpr std::uint64_t kSeeds = 8;

TEST(Faults, MisportedLinksNameAFreePortAtOneEnd) {
    FaultOptions options;
    options.misportedLinks = 3;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const World right = faulty({}, seed);
        World world = faulty(options, seed);
        const auto index = world.skin.indexById();
        ASSERT_EQ(world.faults.misportedLinks.size(), 3U);
        for (const MisportedLink& wrong : world.faults.misportedLinks) {
            EXPECT_FALSE(world.isCable[wrong.link]);
            Link& link = world.skin.links[wrong.link];
            const bool atA = index.at(link.a) == wrong.module;
            EXPECT_NE(atA, index.at(link.b) == wrong.module);
            const ModuleId id = world.skin.modules[wrong.module].id;
            int& port = atA ? link.a_port : link.b_port;
            EXPECT_NE(port, wrong.truePort);
            EXPECT_LT(port, static_cast<int>(world.trueTemplate(wrong.module).ports.size()));
            for (const Link& other : right.skin.links)
                EXPECT_FALSE((other.a == id && other.a_port == port) || (other.b == id && other.b_port == port));
            port = wrong.truePort;
        }
        // Put right, nothing else is left.
        expectSameSkin(world, right);
        expectSameGravity(world, right);
        expectSameDetections(world, right);
        expectSamePoses(world.T_r_u, right.T_r_u);
    }
}

TEST(Faults, MisportedLinksLeaveModulesTheirNeighbours) {
    Scenario row = hexagonsOnly();
    row.cables = false;
    row.patches.resize(1);
    row.patches[0].strip = true;
    FaultOptions options;
    options.misportedLinks = 1;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        row.patches[0].modules = 4;
        EXPECT_EQ(faulty(options, seed, row).faults.misportedLinks[0].link, 1U) << "the one in the middle";
        row.patches[0].modules = 2;
        EXPECT_EQ(faulty(options, seed, row).faults.misportedLinks[0].link, 0U) << "the only one";
    }
    options.misportedLinks = 2;
    row.patches[0].modules = 4;
    EXPECT_THROW((void)faulty(options, 1, row), std::logic_error) << "the others touch the first";
}

TEST(Faults, WrongTemplatesAreReportedAndNotThere) {
    FaultOptions options;
    options.wrongTemplates = 3;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const World right = faulty({}, seed);
        World world = faulty(options, seed);
        const auto& wrong = world.faults.wrongTemplates;
        ASSERT_EQ(wrong.size(), 3U);
        EXPECT_EQ(world.trueType, right.trueType);
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            EXPECT_EQ(world.skin.modules[u].type != right.skin.modules[u].type, contains(wrong, u));
            EXPECT_EQ(world.trueTemplate(u).name, "hex");
        }
        // The network would notice a port that is not there; this throws where one is not.
        EXPECT_NO_THROW((void)buildSkinGraph(world.skin));
        for (const std::size_t u : wrong)
            world.skin.modules[u].type = world.trueType[u];
        expectSameSkin(world, right);
        expectSameGravity(world, right);
        expectSameDetections(world, right);
        expectSamePoses(world.T_r_u, right.T_r_u);
    }
}

TEST(Faults, PicturesShowTheTrueTemplate) {
    Scenario scenario = *findScenario("coded");
    scenario.templates.push_back(rectangleTemplate());
    const World right = buildWorld(scenario, 1);
    scenario.faults.wrongTemplates = 3;
    const World world = buildWorld(scenario, 1);
    const std::vector<LitModule> lit{{world.skin.modules[world.faults.wrongTemplates[0]].id, std::nullopt}};
    for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
        const cv::Mat a = FrameRenderer(right, v, 3).render(lit, 1);
        const cv::Mat b = FrameRenderer(world, v, 3).render(lit, 1);
        EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0);
    }
}

TEST(Faults, TouchAModuleOnce) {
    FaultOptions options;
    options.movedModules = 12;
    options.misportedLinks = 4;
    options.wrongTemplates = 12;
    options.movedPatches = 1;
    for (std::uint64_t seed = 1; seed <= 5 * kSeeds; ++seed) {
        const World world = faulty(options, seed);
        const auto index = world.skin.indexById();
        std::vector<int> touched(world.T_r_u.size(), 0);
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            if (contains(world.faults.movedPatches, static_cast<std::size_t>(world.patchOf[u])))
                ++touched[u];
        }
        for (const std::size_t u : world.faults.movedModules)
            ++touched[u];
        for (const std::size_t u : world.faults.wrongTemplates)
            ++touched[u];
        for (const MisportedLink& wrong : world.faults.misportedLinks) {
            ++touched[index.at(world.skin.links[wrong.link].a)];
            ++touched[index.at(world.skin.links[wrong.link].b)];
        }
        EXPECT_EQ(std::count(touched.begin(), touched.end(), 1), 19 + 12 + 12 + 2 * 4);
        EXPECT_EQ(*std::max_element(touched.begin(), touched.end()), 1);
    }
}

TEST(Faults, SpareWhatLiesUnderACard) {
    FaultOptions options;
    options.movedModules = 17;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const World world = faulty(options, seed, *findScenario("shoe-sole"));
        for (const std::size_t u : world.faults.movedModules)
            EXPECT_FALSE(contains(world.covered, u));
    }
    options.movedModules = 18;
    EXPECT_THROW((void)faulty(options, 1, *findScenario("shoe-sole")), std::logic_error);
}

TEST(Faults, AreInTwoOfTheScenarios) {
    const World world = buildWorld(*findScenario("faults"), 1);
    EXPECT_FALSE(world.faults.movedModules.empty());
    EXPECT_FALSE(world.faults.shakenPoses.empty());
    EXPECT_FALSE(world.faults.misportedLinks.empty());
    EXPECT_FALSE(world.faults.bumpedViews.empty());
    EXPECT_FALSE(world.faults.wrongTemplates.empty());
    EXPECT_TRUE(world.faults.movedPatches.empty());
    EXPECT_EQ(buildWorld(*findScenario("moved-joint"), 1).faults.movedPatches.size(), 1U);
}

TEST(Faults, MoreThanThereIsIsRefused) {
    const auto refused = [](void (*ask)(FaultOptions&), const Scenario& scenario) {
        FaultOptions options;
        ask(options);
        EXPECT_THROW((void)faulty(options, 1, scenario), std::logic_error);
    };
    const Scenario scenario = hexagonsOnly();
    refused([](FaultOptions& f) { f.movedModules = 77; }, scenario);
    refused([](FaultOptions& f) { f.shakenPoses = 13; }, scenario);
    refused([](FaultOptions& f) { f.misportedLinks = 39; }, scenario);
    refused([](FaultOptions& f) { f.bumpedViews = 11; }, scenario);
    refused([](FaultOptions& f) { f.wrongTemplates = 77; }, scenario);
    refused([](FaultOptions& f) { f.movedPatches = 4; }, scenario);
}

TEST(Faults, WhatCanNotBeIsRefused) {
    FaultOptions options;
    options.wrongTemplates = 1;
    EXPECT_THROW((void)faulty(options, 1, *findScenario("freeform")), std::logic_error) << "one template";
    Scenario scenario = *findScenario("freeform");
    scenario.templates.push_back(triangleTemplate());
    scenario.templates.back().ports.clear();
    EXPECT_THROW((void)faulty(options, 1, scenario), std::logic_error) << "the other has no ports";
    options = {};
    options.bumpedViews = 1;
    EXPECT_THROW((void)faulty(options, 1, *findScenario("coded")), std::logic_error) << "pictures";
    scenario = hexagonsOnly();
    scenario.patches.resize(1);
    scenario.patches[0].modules = 7;
    EXPECT_THROW((void)faulty(options, 1, scenario), std::logic_error) << "three modules before the knock";
    options = {};
    options.movedPatches = 1;
    EXPECT_THROW((void)faulty(options, 1, scenario), std::logic_error) << "against what?";
}

TEST(Faults, SizesAreNumbers) {
    for (double FaultOptions::*size :
         {&FaultOptions::moveShift, &FaultOptions::moveTilt, &FaultOptions::shake, &FaultOptions::tremble,
          &FaultOptions::bumpShift, &FaultOptions::bumpTurn, &FaultOptions::patchTurn}) {
        for (const double bad : {-1e-3, std::nan(""), HUGE_VAL}) {
            FaultOptions options;
            options.*size = bad;
            EXPECT_THROW((void)faulty(options, 1), std::logic_error);
        }
    }
}

}  // namespace
}  // namespace skincal
