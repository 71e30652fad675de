#include "core/estimation/next_measurement.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <regex>

#include "core/estimation/advice_basis.h"
#include "core/geometry/random.h"
#include "tests/unit/estimation/solved_world.h"

namespace skincal {
namespace {

double worstSigma(const BodySolution& solution) {
    const AdviceBasis basis = adviceBasis(solution);
    return bodyPrecision(basis.used, basis.state, solution.gauge, solution.weights).value().worstSigma();
}

/// The same measurements and those of one more pose, really simulated. Sensors keep their errors; what was read before
/// stays as it was.
SolvedWorld withPose(const SolvedWorld& before, const Vector3d& up_r) {
    World world = before.world;
    const int pose = static_cast<int>(world.gravity_r.size());
    world.gravity_r.emplace_back(kStandardGravity * (before.T_w_r().linear() * up_r));
    Measurements measurements = before.measurements;
    for (const GravityReading& reading : simulateGravity(world)) {
        if (reading.pose == pose)
            measurements.gravity.push_back(reading);
    }
    return SolvedWorld(std::move(world), std::move(measurements));
}

SolvedWorld withView(const SolvedWorld& before, const Isometry3d& T_r_v) {
    World world = before.world;
    world.T_r_v.push_back(before.T_w_r() * T_r_v);
    Measurements measurements = before.measurements;
    measurements.views.push_back(simulateDetections(world).back());
    return SolvedWorld(std::move(world), std::move(measurements));
}

/// Two poses and views of one end: much is to be gained.
World poorlyPosed(std::uint64_t seed) {
    Scenario scenario = *findScenario("freeform");
    scenario.patches.resize(3);
    scenario.sensors.noise = 0.1;
    World world = buildWorld(scenario, seed);
    Random random(seed, "poorly posed");
    const Vector3d first = random.direction();
    world.gravity_r.clear();
    for (int p = 0; p < 4; ++p)
        world.gravity_r.emplace_back(kStandardGravity * (so3Exp(5 * kDegree * random.normal3()) * first));
    world.T_r_v.resize(2);
    return world;
}

void expectBetweenNothingAndAll(const ForecastGain& gain) {
    EXPECT_GE(gain.worstAfter, 0);
    EXPECT_LE(gain.worstAfter, gain.worstBefore * (1 + 1e-9));
    EXPECT_LE(gain.rmsAfter, gain.rmsBefore * (1 + 1e-9));
    EXPECT_LE(gain.rmsAfter, gain.worstAfter * (1 + 1e-9));
}

TEST(NextPose, TheBestReallyHelpsAsForecastAndMoreThanTheWorst) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const SolvedWorld before(poorlyPosed(seed));
        const auto ranked = rankNextPoses(before.solution);
        ASSERT_TRUE(ranked) << ranked.error().message();
        ASSERT_GT(ranked->size(), 10U);
        for (const NextPose& pose : *ranked) {
            EXPECT_NEAR(pose.up_r.norm(), 1, 1e-9);
            expectBetweenNothingAndAll(pose.gain);
        }
        EXPECT_NEAR(ranked->front().gain.worstBefore, worstSigma(before.solution), 1e-12);
        EXPECT_GT(ranked->front().gain.worstDrop(), ranked->back().gain.worstDrop());
        const double found = worstSigma(withPose(before, ranked->front().up_r).solution);
        EXPECT_NEAR(found, ranked->front().gain.worstAfter, 0.08 * found) << seed;
        EXPECT_LT(ranked->front().gain.worstAfter, 0.85 * ranked->front().gain.worstBefore) << "worth its while";
        EXPECT_LT(found, worstSigma(withPose(before, ranked->back().up_r).solution)) << seed;
    }
}

TEST(NextView, TheBestReallyHelpsAsForecastAndMoreThanTheWorst) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const SolvedWorld before(poorlyPosed(seed));
        const auto ranked = rankNextViews(before.solution);
        ASSERT_TRUE(ranked) << ranked.error().message();
        ASSERT_GT(ranked->size(), 5U);
        for (const NextView& view : *ranked) {
            EXPECT_TRUE(isRigid(view.T_r_v));
            EXPECT_FALSE(view.patches.empty());
            EXPECT_GE(view.gain.modules, 6U);
            expectBetweenNothingAndAll(view.gain);
        }
        const SolvedWorld after = withView(before, ranked->front().T_r_v);
        EXPECT_NEAR(static_cast<double>(after.measurements.views.back().found.size()),
                    static_cast<double>(ranked->front().gain.modules), 4)
            << "sees what was forecast";
        const double found = worstSigma(after.solution);
        EXPECT_NEAR(found, ranked->front().gain.worstAfter, 0.08 * found) << seed;
        EXPECT_LT(found, worstSigma(withView(before, ranked->back().T_r_v).solution)) << seed;
    }
}

TEST(NextView, ModulesThatNoViewLooksAtAreLookedAt) {
    const SolvedWorld solved(scenarioWorld("arm", 1));
    const AdviceBasis basis = adviceBasis(solved.solution);
    const UnseenModules dark = unseenModules(basis, {});
    ASSERT_FALSE(dark.unseen.empty());
    const auto ranked = rankNextViews(solved.solution);
    ASSERT_TRUE(ranked && !ranked->empty());
    ASSERT_FALSE(ranked->front().firstSeen.empty());
    for (const ModuleId id : ranked->front().firstSeen)
        EXPECT_TRUE(forecastPixels(basis, ranked->front().T_r_v, {})[solved.world.skin.indexById().at(id)]);
}

TEST(NextView, DoesNotCountOnModulesThatViewsLookedAtInVain) {
    const SolvedWorld solved(scenarioWorld("shoe-sole", 1));
    const AdviceBasis basis = adviceBasis(solved.solution);
    EXPECT_EQ(unseenModules(basis, {}).hidden, solved.world.covered);
    const auto ranked = rankNextViews(solved.solution);
    ASSERT_TRUE(ranked && !ranked->empty());
    for (const NextView& view : *ranked) {
        EXPECT_TRUE(view.firstSeen.empty());
        EXPECT_LE(view.gain.modules, solved.world.T_r_u.size() - solved.world.covered.size());
    }
}

TEST(NextView, SeesNothingFromBehindNorPastTheBorder) {
    const SolvedWorld solved(scenarioWorld("plane", 1));
    const AdviceBasis basis = adviceBasis(solved.solution);
    const auto count = [&](const Isometry3d& T_r_v) {
        const auto pixels = forecastPixels(basis, T_r_v, {});
        return std::count_if(pixels.begin(), pixels.end(), [](const auto& p) { return p.has_value(); });
    };
    const auto candidates = viewCandidates(solved.solution, basis, {}, {});
    ASSERT_FALSE(candidates.empty());
    EXPECT_GT(count(candidates.front().T_r_v), 6);
    const Isometry3d turned = candidates.front().T_r_v * Eigen::AngleAxisd(3, Vector3d::UnitX());
    EXPECT_EQ(count(turned), 0) << "looks away";
    const Isometry3d behind = candidates.front().T_r_v * Eigen::Translation3d(0, 0, 1.2) *
                              Eigen::AngleAxisd(180 * kDegree, Vector3d::UnitX());
    EXPECT_EQ(count(behind), 0) << "under the table";
}

TEST(NextView, BoardsOfTheBodyHideWhatIsBehind) {
    // A ring: from outside, LEDs of the far side face away, and those of the near side hide what is inside.
    const SolvedWorld solved(scenarioWorld("cylinder", 1));
    const AdviceBasis basis = adviceBasis(solved.solution);
    const auto ranked = rankNextViews(solved.solution);
    ASSERT_TRUE(ranked);
    World world = solved.world;
    for (const NextView& view : *ranked) {
        world.T_r_v = {solved.T_w_r() * view.T_r_v};
        std::size_t wrong = 0;
        const auto pixels = forecastPixels(basis, view.T_r_v, {});
        for (std::size_t u = 0; u < pixels.size(); ++u)
            wrong += pixels[u].has_value() != visiblePixel(world, 0, u).has_value() ? 1 : 0;
        EXPECT_LE(wrong, 3U) << view.words;
    }
}

TEST(NextView, WordsLeadThereFromWhereTheCameraStood) {
    const std::map<std::string, Vector3d> ways{{"right", Vector3d::UnitX()},   {"left", -Vector3d::UnitX()},
                                               {"down", Vector3d::UnitY()},    {"up", -Vector3d::UnitY()},
                                               {"forward", Vector3d::UnitZ()}, {"back", -Vector3d::UnitZ()}};
    for (const std::string scenario : {"plane", "cylinder"}) {
        const SolvedWorld solved(scenarioWorld(scenario, 1));
        const AdviceBasis basis = adviceBasis(solved.solution);
        const auto ranked = rankNextViews(solved.solution);
        ASSERT_TRUE(ranked && !ranked->empty());
        for (const NextView& view : *ranked) {
            const std::string words = view.words.english();
            const std::string way = words.substr(words.find(": "));
            std::size_t from = 0;
            while (!way.ends_with(solved.solution.measurements->views[from].name + " was"))
                ASSERT_LT(++from, basis.state.T_r_v.size()) << view.words;
            Vector3d said_cm = Vector3d::Zero();
            static const std::regex kPart("([0-9]+) cm ([a-z]+)");
            for (std::sregex_iterator part(way.begin(), way.end(), kPart), end; part != end; ++part)
                said_cm += std::stod((*part)[1]) * ways.at((*part)[2]);
            const Vector3d is_cm = 100 * (basis.state.T_r_v[from]->inverse() * view.T_r_v.translation());
            EXPECT_LT((said_cm - is_cm).norm(), 2 + 0.3 * is_cm.norm()) << view.words;
        }
    }
}

TEST(NextMeasurement, StopsWhenCancelled) {
    const SolvedWorld solved(scenarioWorld("plane", 1));
    for (const int after : {0, 1, 5}) {
        for (const bool poses : {true, false}) {
            int asked = 0;
            RunContext context;
            context.isCancelled = [&] { return asked++ >= after; };
            ErrorCode code{};
            if (poses)
                code = rankNextPoses(solved.solution, {}, context).error().code;
            else
                code = rankNextViews(solved.solution, {}, context).error().code;
            EXPECT_EQ(code, ErrorCode::Cancelled);
            EXPECT_EQ(asked, after + 1);
        }
    }
}

TEST(NextMeasurement, NothingIsForecastOfNothing) {
    World world = scenarioWorld("plane", 1);
    world.T_r_v.clear();
    const SolvedWorld solved(world);
    EXPECT_EQ(rankNextPoses(solved.solution).error().code, ErrorCode::NothingPlaced);
    EXPECT_EQ(rankNextViews(solved.solution).error().code, ErrorCode::NothingPlaced);
    NextMeasurementOptions options;
    options.directions = 0;
    EXPECT_THROW((void)rankNextPoses(solved.solution, options), std::logic_error);
}

TEST(NextMeasurement, LargeBodiesAreTriedInFewerPlaces) {
    const SolvedWorld solved(scenarioWorld("plane", 2));
    NextMeasurementOptions options;
    options.maxWork = 36 * 10;
    EXPECT_EQ(rankNextPoses(solved.solution, options).value().size(), 10U);
    EXPECT_EQ(rankNextViews(solved.solution, options).value().size(), 10U);
    options.maxWork = 1;
    EXPECT_EQ(rankNextPoses(solved.solution, options).value().size(), 8U);
}

}  // namespace
}  // namespace skincal
