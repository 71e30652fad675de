#include "core/rig/touch_field.h"

#include <gtest/gtest.h>

namespace skincal {
namespace {

std::shared_ptr<const World> worldOf(const char* name, std::uint64_t seed) {
    return std::make_shared<World>(buildWorld(*findScenario(name), seed));
}

double forceOf(const ModuleTouch& module) {
    return module.force[0] + module.force[1] + module.force[2];
}

TEST(TouchField, NearCellsFeelAHandAndFarOnesDoNot) {
    for (const char* name : {"demo", "plane", "mixed-shapes"}) {
        const auto world = worldOf(name, 2);
        for (std::size_t touched = 0; touched < world->T_r_u.size(); touched += 5) {
            const Vector3d point = world->T_r_u[touched].translation();
            TouchField field(world);
            field.advance(Contact{point, 2.0}, 0.01);
            EXPECT_GT(field.modules()[touched].proximity, 0.99);
            EXPECT_GT(forceOf(field.modules()[touched]), 0.4);
            double all = 0;
            for (std::size_t u = 0; u < world->T_r_u.size(); ++u) {
                const ModuleTouch& module = field.modules()[u];
                const double distance = (world->T_r_u[u].translation() - point).norm();
                all += forceOf(module);
                EXPECT_GE(module.proximity, 0);
                EXPECT_LE(module.proximity, 1);
                if (distance > 0.05) {
                    EXPECT_EQ(module.proximity, 0);
                }
                if (distance > 0.027) {
                    EXPECT_EQ(forceOf(module), 0) << "no sensor is so far from its module's middle";
                }
            }
            EXPECT_LE(all, 2.0 + 1e-9);
            EXPECT_GT(all, 0.5);
        }
    }
}

TEST(TouchField, ProximityFallsWithDistance) {
    const auto world = worldOf("plane", 1);
    const Isometry3d& T = world->T_r_u[0];
    double last = 2;
    for (double height = 0.008; height < 0.05; height += 0.002) {
        TouchField field(world);
        field.advance(Contact{T * Vector3d(0, 0, height), 0}, 0.01);
        EXPECT_LT(field.modules()[0].proximity, last);
        last = field.modules()[0].proximity;
        EXPECT_EQ(forceOf(field.modules()[0]), 0);
    }
    TouchField field(world);
    field.advance(Contact{T * Vector3d(0, 0, -0.02), 1}, 0.01);
    EXPECT_EQ(field.modules()[0].proximity, 0) << "nothing from behind";
}

TEST(TouchField, ATouchedModuleWarmsUpSlowlyAndCoolsDownAgain) {
    const auto world = worldOf("coded", 3);
    TouchField field(world);
    const auto temperatures = [&] {
        std::vector<double> all;
        for (const ModuleTouch& module : field.modules())
            all.push_back(module.temperature);
        return all;
    };
    const auto before = temperatures();
    const Contact contact{world->T_r_u[3].translation(), 1};
    field.advance(contact, 0.01);
    EXPECT_LT(field.modules()[3].temperature, before[3] + 0.1);
    double last = field.modules()[3].temperature;
    for (int i = 0; i < 100; ++i) {
        field.advance(contact, 0.05);
        EXPECT_GT(field.modules()[3].temperature, last);
        last = field.modules()[3].temperature;
    }
    EXPECT_GT(last, before[3] + 4);
    EXPECT_LT(last, 33);
    field.advance(std::nullopt, 60);
    for (std::size_t u = 0; u < before.size(); ++u) {
        EXPECT_NEAR(field.modules()[u].temperature, before[u], 1e-4);
        EXPECT_EQ(field.modules()[u].proximity, 0);
        EXPECT_EQ(forceOf(field.modules()[u]), 0);
    }
}

TEST(TouchField, OneLongTimeIsManyShortOnes) {
    const auto world = worldOf("coded", 3);
    TouchField once(world);
    TouchField often(world);
    const Contact contact{world->T_r_u[1].translation(), 1};
    once.advance(contact, 3);
    for (int i = 0; i < 300; ++i)
        often.advance(contact, 0.01);
    for (std::size_t u = 0; u < world->T_r_u.size(); ++u)
        EXPECT_NEAR(once.modules()[u].temperature, often.modules()[u].temperature, 1e-9);
}

}  // namespace
}  // namespace skincal
