#include "core/skin/skin_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/skin/grids.h"

namespace skincal {
namespace {

using test::link;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Skin, FindsModulesById) {
    Skin skin = test::looseModules(paperHexagon(), 3);
    skin.modules[1].id = ModuleId(4'000'000'000U);
    const auto index = skin.indexById();
    EXPECT_EQ(index.size(), 3U);
    EXPECT_EQ(index.at(ModuleId(1)), 0U);
    EXPECT_EQ(index.at(ModuleId(4'000'000'000U)), 1U);
    EXPECT_EQ(skin.templateOf(2).name, "hex");
}

TEST(SkinGraph, OneLinkReportedFromOneSideOrBothIsOneLink) {
    Skin skin = test::looseModules(paperHexagon(), 2);
    skin.links = {link(1, 0, 2, 3)};
    const SkinGraph once = buildSkinGraph(skin);
    ASSERT_EQ(once.links().size(), 1U);
    EXPECT_THAT(once.links()[0].reported, ElementsAre(0));
    EXPECT_THAT(once.links()[0].issues, IsEmpty());

    for (const Link& second : {link(2, 3, 1, 0), link(1, 0, 2, 3)}) {
        skin.links = {link(1, 0, 2, 3), second};
        const SkinGraph twice = buildSkinGraph(skin);
        ASSERT_EQ(twice.links().size(), 1U);
        const GraphLink& merged = twice.links()[0];
        EXPECT_THAT(merged.reported, ElementsAre(0, 1));
        EXPECT_THAT(merged.issues, IsEmpty());
        EXPECT_EQ(merged.a, 0U);
        EXPECT_EQ(merged.a_port, 0);
        EXPECT_EQ(merged.b, 1U);
        EXPECT_EQ(merged.b_port, 3);
        EXPECT_EQ(boost::num_edges(twice.graph()), 1U);
    }
}

TEST(SkinGraph, EachReportMayCarryTheOperatorsWord) {
    Skin skin = test::looseModules(paperHexagon(), 2);
    skin.links = {link(1, 0, 2, 3, LinkKind::Cable), link(2, 3, 1, 0)};
    EXPECT_EQ(buildSkinGraph(skin).links()[0].decided, LinkKind::Cable);
    skin.links = {link(1, 0, 2, 3), link(2, 3, 1, 0, LinkKind::Adjacent)};
    EXPECT_EQ(buildSkinGraph(skin).links()[0].decided, LinkKind::Adjacent);
    skin.links[0].decided = LinkKind::Adjacent;
    EXPECT_EQ(buildSkinGraph(skin).links()[0].decided, LinkKind::Adjacent);
}

TEST(SkinGraph, ContradictingWordsCancelOutInWhateverOrder) {
    Skin skin = test::looseModules(paperHexagon(), 3);
    std::vector<std::optional<LinkKind>> words{LinkKind::Adjacent, LinkKind::Cable, LinkKind::Cable, std::nullopt};
    std::sort(words.begin(), words.end());
    do {
        skin.links = {link(2, 0, 3, 3, LinkKind::Cable)};
        for (std::size_t i = 0; i < words.size(); ++i)
            skin.links.push_back(i % 2 == 0 ? link(1, 0, 2, 3, words[i]) : link(2, 3, 1, 0, words[i]));
        const auto links = buildSkinGraph(skin).links();
        ASSERT_EQ(links.size(), 2U);
        EXPECT_EQ(links[0].decided, LinkKind::Cable) << "another link's word is none of their business";
        EXPECT_EQ(links[1].decided, std::nullopt);
    } while (std::next_permutation(words.begin(), words.end()));
}

TEST(SkinGraph, NotesTwoClaimsToOnePort) {
    Skin skin = test::looseModules(paperHexagon(), 4);
    skin.links = {link(1, 0, 2, 3), link(3, 3, 1, 0), link(3, 1, 4, 2)};
    const auto links = buildSkinGraph(skin).links();
    ASSERT_EQ(links.size(), 3U);
    EXPECT_TRUE(links[0].has(LinkIssue::Contradictory));
    EXPECT_TRUE(links[1].has(LinkIssue::Contradictory));
    EXPECT_THAT(links[2].issues, IsEmpty());
}

TEST(SkinGraph, NotesSelfLinks) {
    Skin skin = test::looseModules(paperHexagon(), 1);
    skin.links = {link(1, 0, 1, 2), link(1, 3, 1, 3)};
    const auto links = buildSkinGraph(skin).links();
    ASSERT_EQ(links.size(), 2U);
    EXPECT_THAT(links[0].issues, ElementsAre(LinkIssue::SelfLink));
    // A port that hears itself makes one claim, not two.
    EXPECT_THAT(links[1].issues, ElementsAre(LinkIssue::SelfLink));
}

TEST(SkinGraph, NotesThePortThatIsWiredToTheComputer) {
    Skin skin = test::looseModules(paperHexagon(), 3);
    skin.hostLinks = {{ModuleId(2), 3}};
    skin.links = {link(1, 0, 2, 3), link(2, 0, 3, 3)};
    const auto links = buildSkinGraph(skin).links();
    EXPECT_THAT(links[0].issues, ElementsAre(LinkIssue::HostPort));
    EXPECT_THAT(links[1].issues, IsEmpty());
    std::swap(skin.links[0].a, skin.links[0].b);
    std::swap(skin.links[0].a_port, skin.links[0].b_port);
    EXPECT_TRUE(buildSkinGraph(skin).links()[0].has(LinkIssue::HostPort));
}

TEST(SkinGraph, MirrorsTheNetwork) {
    for (const KnownSkin& grid : {test::hexagonGrid(5, 4), test::rectangleGrid(3, 6), test::triangleGrid(4, 3)}) {
        const SkinGraph graph = buildSkinGraph(grid.skin);
        EXPECT_EQ(graph.links().size(), grid.skin.links.size());
        EXPECT_EQ(boost::num_vertices(graph.graph()), grid.skin.modules.size());
        for (std::size_t m = 0; m < grid.skin.modules.size(); ++m)
            EXPECT_EQ(graph.graph()[m].module, m);
        for (const auto& edge : boost::make_iterator_range(boost::edges(graph.graph()))) {
            const GraphLink& l = graph.links()[graph.graph()[edge].link];
            EXPECT_EQ(std::minmax(boost::source(edge, graph.graph()), boost::target(edge, graph.graph())),
                      std::minmax(l.a, l.b));
            EXPECT_THAT(l.issues, IsEmpty());
        }
    }
    EXPECT_TRUE(buildSkinGraph(Skin{}).links().empty());
}

TEST(SkinGraph, RefusesUnknownModulesAndPorts) {
    Skin skin = test::looseModules(paperHexagon(), 2);
    for (const Link& bad : {link(1, 0, 9, 0), link(9, 0, 1, 0), link(1, 4, 2, 0), link(1, 0, 2, -1)}) {
        skin.links = {bad};
        EXPECT_THROW((void)buildSkinGraph(skin), std::logic_error);
    }
    skin.links.clear();
    for (const HostLink& bad : {HostLink{ModuleId(9), 0}, HostLink{ModuleId(1), 4}, HostLink{ModuleId(1), -1}}) {
        skin.hostLinks = {bad};
        EXPECT_THROW((void)buildSkinGraph(skin), std::logic_error);
    }
}

}  // namespace
}  // namespace skincal
