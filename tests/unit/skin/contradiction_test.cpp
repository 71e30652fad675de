// Several links that claim one port: at most one of them can be real.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/skin/cable_detection.h"
#include "tests/unit/skin/synthetic_skin.h"

namespace skincal {
namespace {

using testing::HasSubstr;

const Matrix3d kFits = Matrix3d::Identity();
const Matrix3d kFolded = so3Exp({100 * kDegree, 0, 0});

/// Module 1's port 0 is claimed by the ports 3 of modules 2, 3, …: one link per word.
struct Rivals {
    Skin skin;
    SkinGraph graph;
    CableEvidence evidence;

    explicit Rivals(const std::vector<std::optional<LinkKind>>& words) {
        skin.templates = {paperHexagon()};
        skin.modules = {{ModuleId(1), 0}};
        for (unsigned i = 0; i < words.size(); ++i) {
            skin.modules.push_back({ModuleId(2 + i), 0});
            skin.links.push_back({ModuleId(1), 0, ModuleId(2 + i), 3, words[i]});
        }
        graph = buildSkinGraph(skin);
        evidence = noEvidence(graph);
    }
    [[nodiscard]] std::vector<LinkVerdict> verdicts() const { return detectCables(skin, graph, evidence); }
};

void expectLost(const LinkVerdict& verdict, const char* words) {
    EXPECT_EQ(verdict.kind, LinkKind::Cable);
    EXPECT_EQ(verdict.reason, LinkReason::Contradictory);
    EXPECT_THAT(verdict.explanation, HasSubstr(words));
}

TEST(ContradictoryLinks, TheOneThatAlonePassesTheRotationTestIsTaken) {
    Rivals rivals({{}, {}});
    rivals.evidence.R_a_b = {kFolded, kFits};
    const auto verdicts = rivals.verdicts();
    EXPECT_EQ(verdicts[0].reason, LinkReason::Bend);
    EXPECT_EQ(verdicts[1].kind, LinkKind::Adjacent);
    EXPECT_EQ(verdicts[1].reason, LinkReason::Neighbours);
}

TEST(ContradictoryLinks, WhatWasNotMeasuredYieldsToWhatFits) {
    Rivals rivals({{}, {}, {}});
    rivals.evidence.R_a_b = {std::nullopt, kFits, kFolded};
    const auto verdicts = rivals.verdicts();
    expectLost(verdicts[0], "its measured rotation fits neighbours");
    EXPECT_EQ(verdicts[1].kind, LinkKind::Adjacent);
    EXPECT_EQ(verdicts[2].reason, LinkReason::Bend);
}

TEST(ContradictoryLinks, NoneIsTakenWhereSeveralFit) {
    Rivals rivals({{}, {}});
    rivals.evidence.R_a_b = {kFits, kFits};
    for (const LinkVerdict& verdict : rivals.verdicts())
        expectLost(verdict, "none is believed");
}

TEST(ContradictoryLinks, NoneIsTakenWhereNoneFits) {
    Rivals rivals({{}, {}});
    rivals.evidence.R_a_b = {kFolded, kFolded};
    for (const LinkVerdict& verdict : rivals.verdicts())
        EXPECT_EQ(verdict.reason, LinkReason::Bend);
    // An unmeasured one is not made credible by the other's failure.
    rivals.evidence.R_a_b = {kFolded, std::nullopt};
    expectLost(rivals.verdicts()[1], "none is believed");
    rivals.evidence.R_a_b = {std::nullopt, std::nullopt};
    for (const LinkVerdict& verdict : rivals.verdicts())
        expectLost(verdict, "none is believed");
}

TEST(ContradictoryLinks, FarInThePicturesDoesNotPass) {
    Rivals rivals({{}, {}});
    rivals.evidence.R_a_b = {kFits, kFits};
    rivals.evidence.separation = {1.0, 5.0};
    const auto verdicts = rivals.verdicts();
    EXPECT_EQ(verdicts[0].kind, LinkKind::Adjacent);
    EXPECT_EQ(verdicts[1].reason, LinkReason::Separation);
}

TEST(ContradictoryLinks, TheOperatorsNeighbourIsTaken) {
    Rivals rivals({LinkKind::Adjacent, {}, {}});
    rivals.evidence.R_a_b = {kFolded, kFits, std::nullopt};
    const auto verdicts = rivals.verdicts();
    EXPECT_EQ(verdicts[0].kind, LinkKind::Adjacent);
    EXPECT_EQ(verdicts[0].reason, LinkReason::OperatorsWord);
    expectLost(verdicts[1], "the operator called that one a neighbour");
    expectLost(verdicts[2], "the operator called that one a neighbour");
}

TEST(ContradictoryLinks, TheOperatorsCableLeavesThePortToTheOther) {
    Rivals rivals({LinkKind::Cable, {}});
    rivals.evidence.R_a_b = {kFits, std::nullopt};
    const auto verdicts = rivals.verdicts();
    EXPECT_EQ(verdicts[0].reason, LinkReason::OperatorsWord);
    EXPECT_EQ(verdicts[0].kind, LinkKind::Cable);
    EXPECT_EQ(verdicts[1].kind, LinkKind::Adjacent);
}

TEST(ContradictoryLinks, BothAreKeptWhereTheOperatorSaysSo) {
    const Rivals rivals({LinkKind::Adjacent, LinkKind::Adjacent});
    for (const LinkVerdict& verdict : rivals.verdicts()) {
        EXPECT_EQ(verdict.kind, LinkKind::Adjacent);
        EXPECT_EQ(verdict.reason, LinkReason::OperatorsWord);
    }
}

TEST(ContradictoryLinks, WinningAtOnePortDoesNotHelpAtTheOther) {
    // 1:0-2:3 fits; at 2:3 it stands against 3:0-2:3, which fits as well.
    Rivals rivals({{}, {}});
    rivals.skin.links.push_back({ModuleId(3), 0, ModuleId(2), 3});
    rivals.graph = buildSkinGraph(rivals.skin);
    rivals.evidence = noEvidence(rivals.graph);
    rivals.evidence.R_a_b = {kFits, kFolded, kFits};
    const auto verdicts = rivals.verdicts();
    expectLost(verdicts[0], "none is believed");
    EXPECT_EQ(verdicts[1].reason, LinkReason::Bend);
    expectLost(verdicts[2], "none is believed");
}

TEST(ContradictoryLinks, AreJudgedTheSameInWhateverOrderTheyAreTold) {
    using Key = std::set<std::pair<ModuleId, int>>;
    Random random(1, "order");
    int contradictory = 0;
    for (int i = 0; i < 100; ++i) {
        KnownSkin flat = growFlatSkin(random, paperHexagon(), 20);
        // Claims on random ports, words on some links, and modules that nobody measured.
        for (int k = 0; k < 8; ++k) {
            const auto draw = [&] { return flat.skin.modules[random.index(20)].id; };
            const auto port = [&] { return static_cast<int>(random.index(4)); };
            flat.skin.links.push_back({draw(), port(), draw(), port()});
        }
        std::set<Key> told;
        std::vector<Link> distinct;
        for (Link& link : flat.skin.links) {
            if (random.uniform() < 0.1)
                link.decided = random.uniform() < 0.5 ? LinkKind::Adjacent : LinkKind::Cable;
            if (told.insert({{link.a, link.a_port}, {link.b, link.b_port}}).second)
                distinct.push_back(link);
        }
        flat.skin.links = distinct;
        flat.skin.hostLinks = {{flat.skin.modules[0].id, 0}};
        std::map<ModuleId, std::optional<Matrix3d>> R_r_u;
        for (std::size_t u = 0; u < 20; ++u) {
            if (random.uniform() < 0.8)
                R_r_u[flat.skin.modules[u].id] = flat.T_s_u[u].linear();
        }
        const auto judged = [&](const Skin& skin) {
            const SkinGraph graph = buildSkinGraph(skin);
            CableEvidence evidence = noEvidence(graph);
            for (std::size_t l = 0; l < graph.links().size(); ++l) {
                const auto& R_r_a = R_r_u[skin.modules[graph.links()[l].a].id];
                const auto& R_r_b = R_r_u[skin.modules[graph.links()[l].b].id];
                if (R_r_a && R_r_b)
                    evidence.R_a_b[l] = R_r_a->transpose() * *R_r_b;
            }
            const auto verdicts = detectCables(skin, graph, evidence);
            std::map<Key, std::pair<LinkKind, LinkReason>> result;
            for (std::size_t l = 0; l < verdicts.size(); ++l) {
                const GraphLink& link = graph.links()[l];
                result[{{skin.modules[link.a].id, link.a_port}, {skin.modules[link.b].id, link.b_port}}] = {
                    verdicts[l].kind, verdicts[l].reason};
                contradictory += verdicts[l].reason == LinkReason::Contradictory ? 1 : 0;
            }
            return result;
        };
        EXPECT_EQ(judged(flat.skin), judged(retold(random, flat.skin)));
    }
    EXPECT_GT(contradictory, 100);
}

}  // namespace
}  // namespace skincal
