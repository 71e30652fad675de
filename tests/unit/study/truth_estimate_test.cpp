#include "core/study/truth_estimate.h"

#include <gtest/gtest.h>

#include "core/study/random_world.h"
#include "core/study/study_world.h"

namespace skincal {
namespace {

std::size_t placedIn(const TruthEstimate& estimate) {
    std::size_t count = 0;
    for (const auto& T : estimate.state.T_r_u)
        count += T ? 1U : 0U;
    return count;
}

TEST(TruthEstimate, StaysWithinAFewOfItsOwnSigmas) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const World world = randomWorld(seed);
        const auto estimate = estimateFromTruth(measurementsOf(world), knownTruth(world));
        ASSERT_TRUE(estimate) << estimate.error().message();
        EXPECT_EQ(placedIn(*estimate), world.T_r_u.size());
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const Vector3d e = estimate->state.T_r_u[u]->translation() - world.T_r_u[u].translation();
            const Vector3d sigma = estimate->covariances[u]->diagonal().tail<3>().cwiseSqrt();
            EXPECT_LT(e.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 5) << "seed " << seed;
        }
    }
}

TEST(TruthEstimate, LeavesOutAPatchThatNoViewShows) {
    const World world = randomWorld(4);
    Measurements measurements = measurementsOf(world);
    std::size_t hidden = 0;
    std::vector<ModuleId> ids;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        if (world.patchOf[u] != 1)
            continue;
        ++hidden;
        ids.push_back(world.skin.modules[u].id);
    }
    for (ViewDetections& view : measurements.views) {
        view.found.erase(
            std::remove_if(view.found.begin(), view.found.end(),
                           [&](const auto& d) { return std::find(ids.begin(), ids.end(), d.module) != ids.end(); }),
            view.found.end());
    }
    const auto estimate = estimateFromTruth(measurements, knownTruth(world));
    ASSERT_TRUE(estimate) << estimate.error().message();
    EXPECT_EQ(placedIn(*estimate), world.T_r_u.size() - hidden);
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        EXPECT_EQ(estimate->state.T_r_u[u].has_value(), world.patchOf[u] != 1);
}

TEST(TruthEstimate, FailsWithoutPictures) {
    const World world = randomWorld(4);
    Measurements measurements = measurementsOf(world);
    for (ViewDetections& view : measurements.views)
        view.found.clear();
    const auto estimate = estimateFromTruth(measurements, knownTruth(world));
    ASSERT_FALSE(estimate);
    EXPECT_EQ(estimate.error().code, ErrorCode::TooFewPoints);
}

TEST(TruthEstimate, TellsTheNoiseOfThePixelsFromTheTruth) {
    const World world = randomWorld(9);  // with false detections
    Measurements measurements = measurementsOf(world);
    for (ViewDetections& view : measurements.views) {
        for (LedDetection& d : view.found)
            d.sigma_px *= 0.5;
    }
    KnownTruth known = knownTruth(truthOf(world), measurements, {});
    EXPECT_NEAR(known.noise.pixelFactor, 2, 0.2);
    EXPECT_EQ(known.isCable, world.isCable);
    known.T_r_v.pop_back();
    EXPECT_THROW((void)estimateFromTruth(measurements, known), std::logic_error);
    Truth incomplete = truthOf(world);
    incomplete.modules.pop_back();
    EXPECT_THROW((void)knownTruth(incomplete, measurements, {}), std::logic_error);
}

TEST(TruthEstimate, CanBeCancelled) {
    const World world = randomWorld(4);
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto estimate = estimateFromTruth(measurementsOf(world), knownTruth(world), context);
    ASSERT_FALSE(estimate);
    EXPECT_EQ(estimate.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace skincal
