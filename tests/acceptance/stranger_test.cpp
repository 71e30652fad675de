// A skin that somebody wrote in Python who had nothing but the protocol's specification: resources/bridges.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/acceptance/program.h"

namespace skincal::test {
namespace {

nlohmann::json explored(const std::string& arguments) {
    const Outcome outcome =
        run("explore --json 'exec:python3 " SKINCAL_SOURCES "/tests/acceptance/stranger_skin.py " + arguments + "'");
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.output, nullptr, false);
}

void expectAChain(const nlohmann::json& skin, std::size_t cells) {
    ASSERT_TRUE(skin.is_object());
    EXPECT_EQ(skin["modules"].size(), cells);
    EXPECT_EQ(skin["links"].size(), cells - 1);
    EXPECT_EQ(skin["host_links"].size(), 1U);
    EXPECT_TRUE(skin["silent_cells"].empty());
    std::map<unsigned, std::string> uniqueIds;
    for (const auto& module : skin["modules"]) {
        EXPECT_EQ(module["type"], "hex");
        uniqueIds[module["id"]] = module["unique_id"];
    }
    std::set<std::string> ids;
    for (const auto& [id, uniqueId] : uniqueIds)
        ids.insert(uniqueId);
    EXPECT_EQ(ids.size(), cells);
    for (const auto& link : skin["links"])
        EXPECT_EQ(int(link["a_port"]) + int(link["b_port"]), 2) << "from port 2 of one to port 0 of the next";
}

TEST(Stranger, IsUnderstood) {
    expectAChain(explored("7"), 7);
    expectAChain(explored("300"), 300);
}

TEST(Stranger, OnABadLineToo) {
    for (int seed = 1; seed <= 3; ++seed)
        expectAChain(explored("60 --drop 0.05 --flip 0.001 --seed " + std::to_string(seed)), 60);
}

}  // namespace
}  // namespace skincal::test
