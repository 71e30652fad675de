#include "core/estimation/candidate_selection.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"

namespace skincal {
namespace {

PatchPose candidate(const Matrix3d& R_v_o, double cost) {
    PatchPose pose;
    pose.T_v_o = makeIsometry(R_v_o, {0, 0, 0.5});
    pose.inliers.assign(8, true);
    pose.cost = cost;
    return pose;
}

/// Flat patches in several views: each sighting has its true pose and a flipped one, in either order.
struct Flips {
    std::vector<Matrix3d> R_r_o;
    std::vector<SightingCandidates> sightings;
    std::vector<std::size_t> truth;  ///< which candidate is true

    Flips(Random& random, std::size_t patches, std::size_t views, double noise) {
        for (std::size_t k = 0; k < patches; ++k)
            R_r_o.push_back(random.rotation());
        for (std::size_t v = 0; v < views; ++v) {
            const Matrix3d R_v_r = random.rotation();
            for (std::size_t k = 0; k < patches; ++k) {
                const Matrix3d R = so3Exp(random.normal3() * noise) * R_v_r * R_r_o[k];
                const Matrix3d flipped = so3Exp(random.direction() * random.uniform(0.7, 1.5)) * R;
                const bool first = random.uniform() < 0.5;
                sightings.push_back({v, k, {candidate(first ? R : flipped, 1.0), candidate(first ? flipped : R, 1.1)}});
                truth.push_back(first ? 0 : 1);
            }
        }
    }
    [[nodiscard]] std::vector<std::optional<Matrix3d>> gravity(const Matrix3d& R_g_r) const {
        std::vector<std::optional<Matrix3d>> R_g_o;
        for (const Matrix3d& R : R_r_o)
            R_g_o.emplace_back(R_g_r * R);
        return R_g_o;
    }
    void expectTruth(const std::vector<Selection>& selections) const {
        ASSERT_EQ(selections.size(), truth.size());
        for (std::size_t s = 0; s < truth.size(); ++s) {
            EXPECT_EQ(selections[s].candidate, truth[s]) << s;
            EXPECT_FALSE(selections[s].undecided) << s;
        }
    }
};

TEST(SelectCandidates, GravityTellsTheTruthInASingleView) {
    Random random(1, "gravity");
    for (int i = 0; i < 100; ++i) {
        const Flips flips(random, 4 + random.index(4), 1, 0.01);
        flips.expectTruth(selectCandidates(flips.sightings, flips.gravity(random.rotation())));
    }
}

TEST(SelectCandidates, OtherViewsTellItWithoutGravity) {
    Random random(2, "views");
    for (int i = 0; i < 50; ++i) {
        const Flips flips(random, 3, 5, 0.01);
        flips.expectTruth(selectCandidates(flips.sightings, {std::nullopt, std::nullopt, std::nullopt}));
    }
}

TEST(SelectCandidates, OneViewWithoutGravityStaysUndecided) {
    Random random(3, "undecided");
    const Flips flips(random, 3, 1, 0.01);
    for (const Selection& selection : selectCandidates(flips.sightings, {std::nullopt, std::nullopt, std::nullopt})) {
        EXPECT_TRUE(selection.candidate);
        EXPECT_TRUE(selection.undecided);
    }
    // A lone patch has nothing to be compared with, gravity or not.
    const Flips lone(random, 1, 4, 0.01);
    for (const Selection& selection : selectCandidates(lone.sightings, lone.gravity(random.rotation())))
        EXPECT_TRUE(selection.undecided);
}

TEST(SelectCandidates, APictureThatIsMuchBetterDecidesAlone) {
    Random random(4, "picture");
    Flips flips(random, 1, 1, 0);
    flips.sightings[0].poses[1].cost = 4;
    const Selection decided = selectCandidates(flips.sightings, {std::nullopt})[0];
    EXPECT_EQ(decided.candidate, 0U);
    EXPECT_FALSE(decided.undecided);
    EXPECT_EQ(decided.rivals, std::vector<std::size_t>{1}) << "only the picture speaks against it";
    SelectionOptions strict;
    strict.decisiveCostRatio = 5;
    EXPECT_TRUE(selectCandidates(flips.sightings, {std::nullopt}, strict)[0].undecided);
    flips.sightings[0].poses.pop_back();
    EXPECT_FALSE(selectCandidates(flips.sightings, {std::nullopt}, strict)[0].undecided);
}

TEST(SelectCandidates, ASightingThatFitsNeitherWayIsDropped) {
    Random random(5, "misfit");
    for (int i = 0; i < 50; ++i) {
        Flips flips(random, 5, 1, 0.01);
        for (PatchPose& pose : flips.sightings[2].poses)
            pose.T_v_o.linear() = so3Exp(random.direction() * 2.5) * flips.sightings[2].poses[0].T_v_o.linear();
        flips.sightings[2].poses.pop_back();
        const Matrix3d R_g_r = random.rotation();
        const auto selections = selectCandidates(flips.sightings, flips.gravity(R_g_r));
        EXPECT_FALSE(selections[2].candidate);
        EXPECT_EQ(selections[1].candidate, flips.truth[1]);
    }
}

TEST(SelectCandidates, SightingsWithoutCandidatesStayWithout) {
    Random random(6, "empty");
    Flips flips(random, 4, 2, 0.01);
    flips.sightings[1].poses.clear();
    const auto selections = selectCandidates(flips.sightings, flips.gravity(random.rotation()));
    EXPECT_FALSE(selections[1].candidate);
    EXPECT_TRUE(selections[0].candidate);
    EXPECT_TRUE(selectCandidates({}, {}).empty());
    for (const SelectionOptions& options : {SelectionOptions{0, 1.5}, SelectionOptions{0.2, 0.9}})
        EXPECT_THROW((void)selectCandidates({}, {}, options), std::logic_error);
}

}  // namespace
}  // namespace skincal
