#include "core/skin/cable_detection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/skin/grids.h"

namespace skincal {
namespace {

using test::link;
using testing::HasSubstr;

/// R_a_b of a link whose modules are bent about an axis in the plane of the skin, then turned about the normal.
Matrix3d arranged(const Skin& skin, const GraphLink& l, double bend, double twist, double axisAzimuth = 0.7) {
    const Vector3d axis(std::cos(axisAzimuth), std::sin(axisAzimuth), 0);
    return so3Exp(axis * bend) * so3Exp(Vector3d::UnitZ() * twist) *
           flatNeighbourRotation(test::portOf(skin, l.a, l.a_port), test::portOf(skin, l.b, l.b_port));
}

LinkVerdict judge(const Skin& skin, double bend, double twist, std::optional<double> separation = std::nullopt) {
    const SkinGraph graph = buildSkinGraph(skin);
    CableEvidence evidence = noEvidence(graph);
    evidence.R_a_b[0] = arranged(skin, graph.links()[0], bend, twist);
    evidence.separation[0] = separation;
    return detectCables(skin, graph, evidence).at(0);
}

Skin pairOfHexagons() {
    Skin skin = test::looseModules(paperHexagon(), 2);
    skin.links = {link(1, 0, 2, 3)};
    return skin;
}

TEST(FlatNeighbourRotation, IsTheOneOfThePlane) {
    for (const KnownSkin& grid : {test::hexagonGrid(3, 3), test::rectangleGrid(3, 3), test::triangleGrid(3, 3)}) {
        const SkinGraph graph = buildSkinGraph(grid.skin);
        for (const GraphLink& l : graph.links()) {
            const Vector3d p_a = test::portOf(grid.skin, l.a, l.a_port);
            const Vector3d p_b = test::portOf(grid.skin, l.b, l.b_port);
            const Isometry3d T_a_b = grid.T_s_u[l.a].inverse() * grid.T_s_u[l.b];
            EXPECT_LT((flatNeighbourRotation(p_a, p_b) - T_a_b.linear()).norm(), 1e-9);
            EXPECT_LT((T_a_b * p_b - p_a).norm(), 1e-9);
            // From the other end it is the inverse.
            EXPECT_LT((flatNeighbourRotation(p_b, p_a) * flatNeighbourRotation(p_a, p_b) - Matrix3d::Identity()).norm(),
                      1e-12);
        }
    }
}

TEST(BendAndTwist, TakesApartWhatWasPutTogether) {
    Random random(1, "bend");
    for (int i = 0; i < 1000; ++i) {
        const Matrix3d flat = so3Exp(Vector3d::UnitZ() * random.uniform(-3, 3));
        const double bend = random.uniform(0, 3.1);
        const double twist = random.uniform(-3.1, 3.1);
        const double azimuth = random.uniform(-3, 3);
        const Vector3d axis(std::cos(azimuth), std::sin(azimuth), 0);
        const Matrix3d R = so3Exp(axis * bend) * so3Exp(Vector3d::UnitZ() * twist) * flat;
        const BendAndTwist found = bendAndTwist(R, flat);
        EXPECT_NEAR(found.bend, bend, 1e-7);
        EXPECT_NEAR(found.twist, std::abs(twist), 1e-7);
        // Neither depends on which end is asked.
        const BendAndTwist back = bendAndTwist(R.transpose(), flat.transpose());
        EXPECT_NEAR(back.bend, found.bend, 1e-9);
        EXPECT_NEAR(back.twist, found.twist, 1e-9);
    }
    EXPECT_NEAR(bendAndTwist(Matrix3d::Identity(), Matrix3d::Identity()).bend, 0, 1e-12);
}

TEST(DetectCables, NothingSpeaksAgainstALinkWithoutEvidence) {
    const Skin skin = pairOfHexagons();
    const SkinGraph graph = buildSkinGraph(skin);
    const LinkVerdict verdict = detectCables(skin, graph, noEvidence(graph)).at(0);
    EXPECT_EQ(verdict.kind, LinkKind::Adjacent);
    EXPECT_EQ(verdict.reason, LinkReason::Neighbours);
    EXPECT_FALSE(verdict.bend || verdict.twist);
    EXPECT_EQ(verdict.explanation, "nothing measured contradicts neighbours");
}

TEST(DetectCables, NeighboursMayBendAndTwistALittle) {
    const LinkVerdict verdict = judge(pairOfHexagons(), 74 * kDegree, -24 * kDegree, 2.1);
    EXPECT_EQ(verdict.kind, LinkKind::Adjacent);
    EXPECT_EQ(verdict.reason, LinkReason::Neighbours);
    EXPECT_NEAR(verdict.bend.value(), 74 * kDegree, 1e-9);
    EXPECT_NEAR(verdict.twist.value(), 24 * kDegree, 1e-9);
    EXPECT_THAT(verdict.explanation, HasSubstr("bend 74.0°, twist 24.0°"));
}

TEST(DetectCables, NamesBendTwistAndSeparation) {
    const LinkVerdict bent = judge(pairOfHexagons(), 90 * kDegree, 0);
    EXPECT_EQ(bent.kind, LinkKind::Cable);
    EXPECT_EQ(bent.reason, LinkReason::Bend);
    EXPECT_THAT(bent.explanation, HasSubstr("folded by 90°, neighbours by 75° at most"));

    const LinkVerdict twisted = judge(pairOfHexagons(), 0.1, -60 * kDegree);
    EXPECT_EQ(twisted.kind, LinkKind::Cable);
    EXPECT_EQ(twisted.reason, LinkReason::Twist);
    EXPECT_THAT(twisted.explanation, HasSubstr("turned by 60° in the plane of the skin, neighbours by 25° at most"));

    const LinkVerdict far = judge(pairOfHexagons(), 0.1, 0.1, 7.25);
    EXPECT_EQ(far.kind, LinkKind::Cable);
    EXPECT_EQ(far.reason, LinkReason::Separation);
    EXPECT_THAT(far.explanation, HasSubstr("the LEDs are 7.2 times as far apart as those of neighbours, 2.2 at most"));
    EXPECT_TRUE(far.bend && far.twist);
}

TEST(DetectCables, ALinkAcrossAJointIsACable) {
    const Skin skin = pairOfHexagons();
    const SkinGraph graph = buildSkinGraph(skin);
    CableEvidence evidence = noEvidence(graph);
    evidence.R_a_b[0] = arranged(skin, graph.links()[0], 0.2, 0.1);
    evidence.rotationResidual[0] = 2.0;  // two uncalibrated accelerometers
    EXPECT_EQ(detectCables(skin, graph, evidence).at(0).kind, LinkKind::Adjacent);
    evidence.rotationResidual[0] = 4.1;
    const LinkVerdict verdict = detectCables(skin, graph, evidence).at(0);
    EXPECT_EQ(verdict.kind, LinkKind::Cable);
    EXPECT_EQ(verdict.reason, LinkReason::Movement);
    EXPECT_THAT(verdict.explanation, HasSubstr("differ by 4.1 m/s², those of neighbours by 3.5 at most"));
}

TEST(DetectCables, WhatAnEarlierSolutionShowedCounts) {
    const Skin skin = pairOfHexagons();
    const SkinGraph graph = buildSkinGraph(skin);
    CableEvidence evidence = noEvidence(graph);
    evidence.R_a_b[0] = arranged(skin, graph.links()[0], 0.2, 0.1);
    evidence.gap[0] = 23e-3;
    const LinkVerdict apart = detectCables(skin, graph, evidence).at(0);
    EXPECT_EQ(apart.reason, LinkReason::Gap);
    EXPECT_THAT(apart.explanation, HasSubstr("23.0 mm apart, 5.0 at most"));
    // Ports that met are neighbours, however far apart a false detection puts their LEDs.
    evidence.gap[0] = 1e-3;
    evidence.separation[0] = 7;
    EXPECT_EQ(detectCables(skin, graph, evidence).at(0).kind, LinkKind::Adjacent);
}

TEST(DetectCables, PortsDecideWhatIsFlat) {
    // The same rotation is a flat neighbour through one pair of ports and a cable through another.
    Skin skin = test::looseModules(paperHexagon(), 2);
    skin.links = {link(1, 0, 2, 3)};
    const SkinGraph graph = buildSkinGraph(skin);
    CableEvidence evidence = noEvidence(graph);
    evidence.R_a_b[0] = Matrix3d::Identity();
    EXPECT_EQ(detectCables(skin, graph, evidence)[0].reason, LinkReason::Neighbours);
    skin.links = {link(1, 0, 2, 0)};
    EXPECT_EQ(detectCables(skin, buildSkinGraph(skin), evidence)[0].reason, LinkReason::Twist);
}

TEST(DetectCables, LimitsAreOptions) {
    const Skin skin = pairOfHexagons();
    const SkinGraph graph = buildSkinGraph(skin);
    CableEvidence evidence = noEvidence(graph);
    evidence.R_a_b[0] = arranged(skin, graph.links()[0], 0.5, 0);
    CableOptions options;
    options.maxBend = 0.4;
    EXPECT_EQ(detectCables(skin, graph, evidence, options)[0].reason, LinkReason::Bend);
    options.maxBend = 0.6;
    EXPECT_EQ(detectCables(skin, graph, evidence, options)[0].reason, LinkReason::Neighbours);
}

TEST(DetectCables, SelfLinksAndComputerPortsAreCables) {
    Skin skin = pairOfHexagons();
    skin.links.push_back(link(1, 1, 1, 2, LinkKind::Adjacent));
    skin.hostLinks = {{ModuleId(2), 3}};
    const SkinGraph graph = buildSkinGraph(skin);
    const auto verdicts = detectCables(skin, graph, noEvidence(graph));
    EXPECT_EQ(verdicts[0].kind, LinkKind::Cable);
    EXPECT_EQ(verdicts[0].reason, LinkReason::ComputerPort);
    EXPECT_THAT(verdicts[0].explanation, HasSubstr("wired to the computer"));
    // Nobody's word makes a module its own neighbour.
    EXPECT_EQ(verdicts[1].kind, LinkKind::Cable);
    EXPECT_EQ(verdicts[1].reason, LinkReason::SelfLink);
    EXPECT_THAT(verdicts[1].explanation, HasSubstr("same module"));
}

TEST(DetectCables, TheOperatorsWordBeatsAllEvidence) {
    Skin skin = pairOfHexagons();
    skin.links[0].decided = LinkKind::Adjacent;
    skin.hostLinks = {{ModuleId(1), 0}};
    const LinkVerdict folded = judge(skin, 2.5, 0, 9.0);
    EXPECT_EQ(folded.kind, LinkKind::Adjacent);
    EXPECT_EQ(folded.reason, LinkReason::OperatorsWord);
    skin.links[0].decided = LinkKind::Cable;
    const LinkVerdict flat = judge(skin, 0, 0, 1.0);
    EXPECT_EQ(flat.kind, LinkKind::Cable);
    EXPECT_EQ(flat.reason, LinkReason::OperatorsWord);
    EXPECT_THAT(flat.explanation, HasSubstr("operator"));
}

TEST(DetectCables, BrokenContractsThrow) {
    const Skin skin = pairOfHexagons();
    const SkinGraph graph = buildSkinGraph(skin);
    CableEvidence evidence = noEvidence(graph);
    evidence.R_a_b.emplace_back();
    EXPECT_THROW((void)detectCables(skin, graph, evidence), std::logic_error);
    evidence = noEvidence(graph);
    evidence.separation.clear();
    EXPECT_THROW((void)detectCables(skin, graph, evidence), std::logic_error);

    std::vector<CableOptions> bad(8);
    bad[0].maxBend = 0;
    bad[1].maxBend = 4;
    bad[2].maxTwist = -1;
    bad[3].maxTwist = 4;
    bad[4].maxSeparation = 1;
    bad[5].maxBend = std::nan("");
    bad[6].maxRotationResidual = 0;
    bad[7].maxGap = 0;
    EXPECT_TRUE(CableOptions{}.validate());
    for (const CableOptions& options : bad) {
        EXPECT_FALSE(options.validate());
        EXPECT_THROW((void)detectCables(skin, graph, noEvidence(graph), options), std::logic_error);
    }
}

}  // namespace
}  // namespace skincal
