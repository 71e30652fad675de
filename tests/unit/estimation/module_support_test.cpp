#include "core/estimation/module_support.h"

#include <gtest/gtest.h>

namespace skincal {
namespace {

/// A row of hexagons 0 … n-1, of which some were measured.
class HeldModulesTest : public testing::Test {
  protected:
    HeldModulesTest() {
        skin_.templates = {paperHexagon()};
        skin_.modules.assign(4, {ModuleId(1), 0});
        input_.skin = &skin_;
        state_.T_r_u.assign(4, Isometry3d::Identity());
        state_.T_r_v = {Isometry3d::Identity(), std::nullopt, Isometry3d::Identity()};
    }
    void link(std::size_t a, int a_port, std::size_t b, int b_port) {
        const auto& ports = skin_.templates[0].ports;
        input_.links.push_back(
            {a, b, ports[static_cast<std::size_t>(a_port)], ports[static_cast<std::size_t>(b_port)]});
    }
    [[nodiscard]] std::vector<bool> held(std::vector<bool> measured) const {
        return heldModules(input_, state_, std::move(measured));
    }
    Skin skin_;
    AdjustmentInput input_;
    BodyState state_;
};

TEST_F(HeldModulesTest, GravityHoldsAndAHingeDoesNot) {
    link(0, 0, 1, 3);
    link(0, 1, 1, 2);
    EXPECT_EQ(held({true, false, true, true}), (std::vector<bool>{true, false, true, true}));
    link(2, 0, 1, 0);  // a third point, off the line of the other two
    EXPECT_TRUE(held({true, false, true, true})[1]);
}

TEST_F(HeldModulesTest, TheLedClosesAHingeWhereTwoPlacedViewsSawIt) {
    link(0, 0, 1, 3);
    link(0, 3, 1, 0);
    input_.pixels = {{1, 1, {}, 0.1}};
    EXPECT_FALSE(held({true, false, true, true})[1]) << "that view has no pose";
    input_.pixels = {{0, 1, {}, 0.1}, {1, 1, {}, 0.1}};
    EXPECT_FALSE(held({true, false, true, true})[1]) << "one ray leaves the depth open";
    input_.pixels = {{0, 1, {}, 0.1}, {2, 1, {}, 0.1}};
    EXPECT_TRUE(held({true, false, true, true})[1]);
}

TEST_F(HeldModulesTest, WhatIsHeldHoldsOthers) {
    for (int port = 0; port < 3; ++port) {
        link(0, port, 1, port);
        link(1, port, 2, port);
        link(2, port, 3, port);
    }
    EXPECT_EQ(held({true, false, false, false}), (std::vector<bool>(4, true)));
    EXPECT_EQ(held({false, false, false, false}), (std::vector<bool>(4, false)));
    state_.T_r_u[1].reset();
    EXPECT_EQ(held({true, true, false, false}), (std::vector<bool>{true, false, false, false})) << "adrift";
}

TEST_F(HeldModulesTest, WithoutAnyGravityLedsOfTwoViewsHoldWhatHoldsTogether) {
    for (int port = 0; port < 3; ++port) {
        for (std::size_t u = 0; u < 3; ++u)
            link(u, port, u + 1, port);
    }
    for (const std::size_t view : {0U, 2U}) {
        for (std::size_t u = 0; u < 2; ++u)
            input_.pixels.push_back({view, u, {}, 0.1});
    }
    EXPECT_EQ(held({false, false, false, false}), (std::vector<bool>(4, false))) << "two points leave a turn open";
    input_.pixels.push_back({0, 3, {}, 0.1});
    input_.pixels.push_back({2, 3, {}, 0.1});
    EXPECT_EQ(held({false, false, false, false}), (std::vector<bool>(4, true)));
}

}  // namespace
}  // namespace skincal
