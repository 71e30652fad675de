#include "core/estimation/spot_settlement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/geometry/random.h"
#include "core/study/random_world.h"
#include "tests/unit/estimation/solved_world.h"

namespace skincal::testing {
namespace {

using ::testing::HasSubstr;

/// A module of a view with several spots, one of which is where its LED was detected, or none.
struct Ambiguity {
    std::size_t view = 0;
    std::size_t module = 0;
    std::optional<Vector2d> led;
};

/// Takes a detection away and hands on spots in its place.
Ambiguity doubt(Measurements& measurements, std::size_t view, std::size_t at, const std::vector<Vector2d>& others,
                bool isLedSeen = true) {
    auto& found = measurements.views[view].found;
    const LedDetection detection = found[at];
    found.erase(found.begin() + static_cast<std::ptrdiff_t>(at));
    Undetected undetected{detection.module, DetectionVerdict::Ambiguous, Sentence::verbatim("spots blink its word")};
    for (const Vector2d& other : others)
        undetected.spots.push_back({other, detection.sigma_px, 1});
    if (isLedSeen)
        undetected.spots.insert(undetected.spots.begin() + 1, {detection.pixel, detection.sigma_px, 0.9});
    measurements.views[view].undetected.push_back(undetected);
    return {view, measurements.skin.indexById().at(detection.module),
            isLedSeen ? std::optional(detection.pixel) : std::nullopt};
}

const SpotVerdict* verdictOf(const BodySolution& solution, std::size_t view, std::size_t module) {
    for (const SpotVerdict& verdict : solution.estimate.spots) {
        if (verdict.view == view && verdict.module == module)
            return &verdict;
    }
    return nullptr;
}

Vector2d anywhere(Random& random, const CameraModel& camera) {
    return {random.uniform(0, camera.width), random.uniform(0, camera.height)};
}

Vector2d nearby(Random& random, const Vector2d& pixel, double from_px, double to_px) {
    const double angle = random.uniform(0, 6.283);
    return pixel +
           std::exp(random.uniform(std::log(from_px), std::log(to_px))) * Vector2d(std::cos(angle), std::sin(angle));
}

Vector2d mirrored(const Vector2d& pixel, const CameraModel& camera) {
    return {pixel.x(), 1.32 * camera.height - pixel.y()};
}

/// About one detection in six becomes doubtful; in one of eight of these the LED itself is hidden.
std::vector<Ambiguity> doubtMany(Measurements& measurements, Random& random) {
    std::vector<Ambiguity> all;
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        for (std::size_t at = measurements.views[v].found.size(); at-- > 0;) {
            if (random.uniform() > 1.0 / 6)
                continue;
            const Vector2d led = measurements.views[v].found[at].pixel;
            const bool isHidden = random.uniform() < 1.0 / 8;
            std::vector<Vector2d> others;
            const double kind = random.uniform();
            others.push_back(isHidden || kind < 0.2 ? anywhere(random, measurements.camera)
                             : kind < 0.6           ? nearby(random, led, 1, 60)
                                                    : mirrored(led, measurements.camera));
            if (isHidden || random.uniform() < 0.3)
                others.push_back(anywhere(random, measurements.camera));
            all.push_back(doubt(measurements, v, at, others, !isHidden));
        }
    }
    return all;
}

/// Where the LED of a false detection really is, no spot shows.
bool isTrue(const World& world, const Ambiguity& ambiguity) {
    const Vector3d led_r = world.T_r_u[ambiguity.module] * world.skin.templateOf(ambiguity.module).led;
    const auto pixel = world.scenario.camera.project(world.T_r_v[ambiguity.view].inverse() * led_r);
    return ambiguity.led && pixel &&
           (*pixel - *ambiguity.led).norm() < 8 * std::max(0.05, world.scenario.views.pixelNoise);
}

struct Taken {
    std::size_t taken = 0;
    std::size_t all = 0;  ///< whose LED is among the spots
};

/// Doubts many detections of a world and expects that no spot is taken that is not the LED's.
void expectNoneWrong(const World& world, std::uint64_t seed, Taken& count) {
    Random random(seed, "spots of " + world.scenario.name);
    Measurements measurements = measurementsOf(world);
    const std::vector<Ambiguity> ambiguities = doubtMany(measurements, random);
    const SolvedWorld solved(world, measurements);
    const bool isFaulty = !world.faults.bumpedViews.empty();
    for (const Ambiguity& ambiguity : ambiguities) {
        const SpotVerdict* verdict = verdictOf(solved.solution, ambiguity.view, ambiguity.module);
        ASSERT_NE(verdict, nullptr);
        EXPECT_THAT(verdict->reason, HasSubstr("blink"));
        const bool isThere = isTrue(world, ambiguity);
        count.all += isThere ? 1 : 0;
        if (!verdict->pixel)
            continue;
        ++count.taken;
        // A knocked camera saw its later LEDs elsewhere.
        EXPECT_TRUE(isThere || isFaulty) << world.scenario.name << ' ' << seed << ": " << verdict->reason;
        ASSERT_LT(*verdict->pixel, solved.solution.input.pixels.size());
        const PixelObservation& o = solved.solution.input.pixels[*verdict->pixel];
        EXPECT_EQ(o.view, ambiguity.view);
        EXPECT_EQ(o.module, ambiguity.module);
        ASSERT_TRUE(ambiguity.led);
        EXPECT_EQ(o.pixel, *ambiguity.led) << world.scenario.name << ' ' << seed << ": " << verdict->reason;
    }
}

class SpotWorlds : public ::testing::TestWithParam<std::string> {};

TEST_P(SpotWorlds, ASpotThatIsNotTheLedIsNeverTaken) {
    Taken count;
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
        expectNoneWrong(scenarioWorld(GetParam(), seed), seed, count);
    EXPECT_GT(count.all, 40U);
    EXPECT_GT(count.taken * 10, count.all * 8) << count.taken << " of " << count.all;
}

INSTANTIATE_TEST_SUITE_P(Scenarios, SpotWorlds,
                         ::testing::Values("plane", "cylinder", "freeform", "mixed-shapes", "outliers", "faults"),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(SpotSettlement, InRandomWorldsNoneIsWrongEither) {
    Taken count;
    for (std::uint64_t seed = 1; seed <= 16; ++seed)
        expectNoneWrong(randomWorld(seed), seed, count);
    EXPECT_GT(count.all, 40U);
    EXPECT_GT(count.taken * 10, count.all * 6) << count.taken << " of " << count.all;
}

// No sure detection shows the module: links and gravity have to say which spot is its LED.
TEST(SpotSettlement, AModuleThatNothingElseShowsIsFoundWhereLinksAndGravityHaveIt) {
    std::size_t taken = 0;
    std::size_t all = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const World world = scenarioWorld("freeform", seed);
        Random random(seed, "unseen");
        Measurements measurements = measurementsOf(world);
        const std::size_t unseen = seed % world.T_r_u.size();
        const ModuleId id = world.skin.modules[unseen].id;
        std::vector<Ambiguity> ambiguities;
        for (std::size_t v = 0; v < measurements.views.size(); ++v) {
            const auto& found = measurements.views[v].found;
            for (std::size_t at = found.size(); at-- > 0;) {
                if (found[at].module == id) {
                    ambiguities.push_back(doubt(measurements, v, at, {nearby(random, found[at].pixel, 60, 300)}));
                    break;
                }
            }
        }
        const SolvedWorld solved(world, measurements);
        bool isSeen = false;
        for (const Ambiguity& ambiguity : ambiguities) {
            const SpotVerdict* verdict = verdictOf(solved.solution, ambiguity.view, ambiguity.module);
            ASSERT_NE(verdict, nullptr);
            ++all;
            if (!verdict->pixel)
                continue;
            ++taken;
            isSeen = true;
            EXPECT_EQ(solved.solution.input.pixels[*verdict->pixel].pixel, *ambiguity.led);
        }
        const BodyModel body = describeSolution(solved.solution, {});
        EXPECT_EQ(body.modules[unseen].seen, isSeen);
        ASSERT_TRUE(body.modules[unseen].T_body_module);
        if (isSeen) {
            EXPECT_LT(
                (solved.T_w_r() * body.modules[unseen].T_body_module->translation() - world.T_r_u[unseen].translation())
                    .norm(),
                2e-3);
        }
    }
    EXPECT_GT(all, 10U);
    EXPECT_GT(taken * 10, all * 7) << taken << " of " << all;
}

// The decoder hands on a single spot where it may be a reflection.
TEST(SpotSettlement, ASingleSpotIsTakenWhereItLiesWhereTheBodyHasTheLed) {
    const World world = scenarioWorld("cylinder", 3);
    Measurements measurements = measurementsOf(world);
    std::vector<Ambiguity> ambiguities;
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        const Vector2d led = measurements.views[v].found.front().pixel;
        ambiguities.push_back(doubt(measurements, v, 0, {mirrored(led, measurements.camera)}, v % 2 == 0));
        // Of two, one is left: the LED or the reflection.
        auto& spots = measurements.views[v].undetected.back().spots;
        spots.erase(spots.begin(), spots.end() - 1);
    }
    const SolvedWorld solved(world, measurements);
    for (const Ambiguity& ambiguity : ambiguities) {
        const SpotVerdict* verdict = verdictOf(solved.solution, ambiguity.view, ambiguity.module);
        ASSERT_NE(verdict, nullptr);
        EXPECT_EQ(verdict->pixel.has_value(), ambiguity.led.has_value()) << verdict->reason;
        EXPECT_THAT(verdict->reason, HasSubstr(ambiguity.led ? "it lies where the body has it" : "sigma off"));
        EXPECT_THAT(verdict->reason, ::testing::Not(HasSubstr("inf")));
    }
}

// What the spots add is as good as if the picture had been sure.
TEST(SpotSettlement, TheBodyIsThatOfSureDetections) {
    const World world = scenarioWorld("cylinder", 2);
    const SolvedWorld sure(world);
    Measurements measurements = measurementsOf(world);
    std::size_t doubts = 0;
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        const Vector2d led = measurements.views[v].found.front().pixel;
        (void)doubt(measurements, v, 0, {led + Vector2d(40, 90)});
        ++doubts;
    }
    const SolvedWorld solved(world, measurements);
    ASSERT_EQ(solved.solution.estimate.spots.size(), doubts);
    for (const SpotVerdict& verdict : solved.solution.estimate.spots)
        EXPECT_TRUE(verdict.pixel) << verdict.reason;
    EXPECT_EQ(solved.solution.input.pixels.size(), sure.solution.input.pixels.size());
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        ASSERT_EQ(solved.solution.solved.T_r_u[u].has_value(), sure.solution.solved.T_r_u[u].has_value());
        if (sure.solution.solved.T_r_u[u]) {
            EXPECT_LT(
                (solved.solution.solved.T_r_u[u]->translation() - sure.solution.solved.T_r_u[u]->translation()).norm(),
                2e-5);
        }
    }
    const BodyModel body = describeSolution(solved.solution, {});
    std::size_t told = 0;
    for (const BodyView& view : body.views) {
        for (const BodyObservation& o : view.observations) {
            EXPECT_NE(o.verdict, ObservationVerdict::Ambiguous);
            told += o.verdict == ObservationVerdict::Used && !o.reason.empty() ? 1 : 0;
        }
    }
    EXPECT_EQ(told, doubts);
    EXPECT_EQ(body.quality.condition.at("spots taken"), static_cast<double>(doubts));
    EXPECT_EQ(body.quality.condition.at("spots open"), 0);
}

/// One doubtful module in a world that is otherwise well known.
struct OneDoubt {
    Ambiguity ambiguity;
    SolvedWorld solved;

    explicit OneDoubt(const std::vector<Vector2d>& offsets, bool isLedSeen = true)
        : OneDoubt(scenarioWorld("plane", 1), offsets, isLedSeen) {}
    OneDoubt(const World& world, const std::vector<Vector2d>& offsets, bool isLedSeen)
        : OneDoubt(world, measurementsOf(world), offsets, isLedSeen) {}
    OneDoubt(const World& world, Measurements m, const std::vector<Vector2d>& offsets, bool isLedSeen)
        : ambiguity(doubt(m, 1, 2, from(m.views[1].found[2].pixel, offsets), isLedSeen)), solved(world, std::move(m)) {}

    static std::vector<Vector2d> from(const Vector2d& led, const std::vector<Vector2d>& offsets) {
        std::vector<Vector2d> places;
        for (const Vector2d& offset : offsets)
            places.emplace_back(led + offset);
        return places;
    }
    [[nodiscard]] const SpotVerdict& verdictIn(const BodySolution& solution) const {
        const SpotVerdict* verdict = verdictOf(solution, ambiguity.view, ambiguity.module);
        if (verdict == nullptr)
            throw std::logic_error("no verdict");
        return *verdict;
    }
    /// As if nothing had been settled.
    [[nodiscard]] BodySolution open() const {
        BodySolution solution = solved.solution;
        for (SpotVerdict& verdict : solution.estimate.spots)
            solution.estimate.rejected[*verdict.pixel] = true;
        dropRejectedSpots(solution);
        return solution;
    }
};

TEST(SpotSettlement, NoneIsTakenWhereNoneFits) {
    const OneDoubt one({{50, 0}, {0, 80}}, false);
    EXPECT_FALSE(one.verdictIn(one.solved.solution).pixel);
    EXPECT_THAT(one.verdictIn(one.solved.solution).reason, HasSubstr("none lies where the body has it"));
    const BodyModel body = describeSolution(one.solved.solution, {});
    const auto& observations = body.views[1].observations;
    EXPECT_TRUE(std::any_of(observations.begin(), observations.end(), [](const BodyObservation& o) {
        return o.verdict == ObservationVerdict::Ambiguous && o.reason.english().find("none lies") != std::string::npos;
    }));
}

TEST(SpotSettlement, NoneIsTakenWhereAnotherFitsToo) {
    const OneDoubt one({{0.05, 0.05}, {100, 0}});
    EXPECT_FALSE(one.verdictIn(one.solved.solution).pixel);
    EXPECT_THAT(one.verdictIn(one.solved.solution).reason, HasSubstr("another lies"));
}

TEST(SpotSettlement, WhatTheBodyDoesNotTellStaysOpenAndSaysWhy) {
    const OneDoubt one({{50, 0}});
    ASSERT_TRUE(one.verdictIn(one.solved.solution).pixel);
    const auto reasonOf = [&](const auto& change, const SpotOptions& options = {}) {
        BodySolution solution = one.open();
        change(solution);
        const auto taken = settleSpots(solution, options);
        EXPECT_TRUE(taken);
        EXPECT_EQ(taken.value_or(9), 0U);
        EXPECT_FALSE(one.verdictIn(solution).pixel);
        return one.verdictIn(solution).reason;
    };
    const auto [view, module, led] = one.ambiguity;
    EXPECT_THAT(reasonOf([v = view](BodySolution& s) { s.solved.T_r_v[v].reset(); }), HasSubstr("view has no pose"));
    EXPECT_THAT(reasonOf([u = module](BodySolution& s) { s.solved.T_r_u[u].reset(); }),
                HasSubstr("module has no pose"));
    EXPECT_THAT(reasonOf([v = view](BodySolution& s) { s.estimate.undecidedViews = {v}; }), HasSubstr("two places"));
    EXPECT_THAT(reasonOf([u = module](BodySolution& s) {
                    s.solved.T_r_u[u]->linear() *= so3Exp(Vector3d(0, 180 * kDegree, 0));
                }),
                HasSubstr("turned away"));
    EXPECT_THAT(reasonOf([](BodySolution& s) { s.gauge = {}; }), HasSubstr("do not tell"));
    SpotOptions exacting;
    exacting.maxSigma_px = 1e-4;
    EXPECT_THAT(reasonOf([](BodySolution&) {}, exacting), HasSubstr("px only"));
}

TEST(SpotSettlement, ASpotThatDoesNotStandIsOpenAgain) {
    const OneDoubt one({{50, 0}});
    const std::size_t before = one.solved.solution.input.pixels.size();
    BodySolution solution = one.open();
    EXPECT_EQ(solution.input.pixels.size(), before - 1);
    EXPECT_EQ(solution.estimate.rejected.size(), before - 1);
    EXPECT_EQ(solution.estimate.setAside.size(), before - 1);
    EXPECT_THAT(one.verdictIn(solution).reason, HasSubstr("did not stand"));
    EXPECT_EQ(settleSpots(solution), 1U);
    EXPECT_EQ(solution.input.pixels.back().pixel, *one.ambiguity.led);
    EXPECT_EQ(settleSpots(solution), 0U) << "what was taken is not asked again";
    EXPECT_TRUE(one.verdictIn(solution).pixel);
}

TEST(SpotSettlement, AnUpdateKeepsWhatWasTakenAndSettlesWhatIsNew) {
    const World world = scenarioWorld("freeform", 3);
    Measurements all = measurementsOf(world);
    const Ambiguity early = doubt(all, 1, 0, {all.views[1].found[0].pixel + Vector2d(70, 20)});
    const std::size_t last = all.views.size() - 1;
    const Ambiguity late = doubt(all, last, 0, {all.views[last].found[0].pixel + Vector2d(-70, 20)});
    Measurements first = all;
    first.views.pop_back();
    const SolvedWorld solved(world, first);
    ASSERT_NE(verdictOf(solved.solution, early.view, early.module), nullptr);
    ASSERT_TRUE(verdictOf(solved.solution, early.view, early.module)->pixel);
    const GravityTable gravity(all.skin, all.gravity);
    const auto next = updateJointly(solved.solution, all, gravity);
    ASSERT_TRUE(next);
    EXPECT_EQ(next->input.pixels.size(), next->estimate.rejected.size());
    for (const Ambiguity& ambiguity : {early, late}) {
        const SpotVerdict* verdict = verdictOf(*next, ambiguity.view, ambiguity.module);
        ASSERT_NE(verdict, nullptr);
        ASSERT_TRUE(verdict->pixel) << verdict->reason;
        EXPECT_EQ(next->input.pixels[*verdict->pixel].pixel, *ambiguity.led);
    }
    // The picture was decoded anew, and is sure now.
    Measurements sure = all;
    for (ViewDetections& view : sure.views)
        view.undetected.clear();
    const auto without = updateJointly(*next, sure, gravity);
    ASSERT_TRUE(without);
    EXPECT_TRUE(without->estimate.spots.empty());
}

TEST(SpotSettlement, WithoutSeveralSpotsThereIsNothingToSettle) {
    SolvedWorld solved(scenarioWorld("plane", 2));
    EXPECT_TRUE(solved.solution.estimate.spots.empty());
    EXPECT_EQ(settleSpots(solved.solution), 0U);
}

TEST(SpotSettlement, CanBeCancelledAndChecksItsOptions) {
    const OneDoubt one({{50, 0}});
    BodySolution solution = one.open();
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto cancelled = settleSpots(solution, {}, context);
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
    SpotOptions options;
    options.others = options.fits;
    EXPECT_THROW((void)settleSpots(solution, options), std::logic_error);
}

}  // namespace
}  // namespace skincal::testing
