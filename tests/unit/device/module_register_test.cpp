#include "core/device/module_register.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace skincal {
namespace {

NetworkCell cell(CellNumber number, std::string uniqueId, std::vector<NetworkCell::Heard> heard = {}) {
    NetworkCell made;
    made.number = number;
    made.uniqueId = std::move(uniqueId);
    made.type = "hex";
    made.ports = 4;
    made.heard = std::move(heard);
    return made;
}

TEST(ModuleRegister, ACellKeepsItsModuleWhateverItsNumber) {
    std::mt19937 random(1);
    ModuleRegister modules;
    std::map<std::string, ModuleId> first;
    for (int round = 0; round < 50; ++round) {
        std::vector<std::string> ids;
        for (int i = 0; i < 40; ++i)
            if (random() % 4 != 0)
                ids.push_back("cell" + std::to_string(i));  // some are missing today
        std::shuffle(ids.begin(), ids.end(), random);
        std::set<ModuleId> given;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const ModuleId id = modules.idOf(cell(static_cast<CellNumber>(i + 1), ids[i]));
            EXPECT_TRUE(given.insert(id).second) << "two cells are one module";
            EXPECT_EQ(first.try_emplace(ids[i], id).first->second, id) << "another module than before";
        }
    }
}

TEST(ModuleRegister, RemembersASkinAndTakesNoIdOfIt) {
    Skin skin;
    skin.templates = {paperHexagon()};
    skin.modules = {{ModuleId(17), 0, "aa"}, {ModuleId(3), 0, ""}, {ModuleId(1), 0, "bb"}};
    ModuleRegister modules;
    modules.remember(skin);
    EXPECT_EQ(modules.idOf(cell(1, "aa")), ModuleId(17));
    EXPECT_EQ(modules.idOf(cell(2, "bb")), ModuleId(1));
    const ModuleId stranger = modules.idOf(cell(3, "cc"));
    EXPECT_NE(stranger, ModuleId(3)) << "belongs to a module whose unique id nobody knows";
    EXPECT_NE(stranger, ModuleId(17));
    EXPECT_EQ(modules.idOf(cell(9, "cc")), stranger);
}

TEST(ModuleRegister, ASkinHasEveryLinkOnceAndThoseThatOneEndReportsToo) {
    SkinNetwork network;
    network.cells = {cell(1, "aa", {{0, 0, 0}, {1, 2, 3}}), cell(2, "bb", {{3, 1, 1}, {0, 3, 2}}), cell(3, "cc")};
    ModuleRegister modules;
    const auto skin = skinOf(network, {rectangleTemplate(), paperHexagon()}, modules);
    ASSERT_TRUE(skin);
    EXPECT_EQ(skin->modules.size(), 3);
    ASSERT_EQ(skin->templates.size(), 1) << "only what is there";
    EXPECT_EQ(skin->links.size(), 2);
    ASSERT_EQ(skin->hostLinks.size(), 1);
    EXPECT_EQ(skin->hostLinks.front().module, ModuleId(1));
    EXPECT_EQ(skin->modules.front().uniqueId, "aa");
}

TEST(ModuleRegister, AnUnknownTypeIsNamed) {
    SkinNetwork network;
    network.cells = {cell(1, "aa")};
    network.cells.front().type = "octagon";
    ModuleRegister modules;
    const auto skin = skinOf(network, {paperHexagon()}, modules);
    ASSERT_FALSE(skin);
    EXPECT_EQ(skin.error(), "octagon");
}

}  // namespace
}  // namespace skincal
