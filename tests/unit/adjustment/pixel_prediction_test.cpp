#include "core/adjustment/pixel_prediction.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

struct Predicted {
    SyntheticWorld world;
    GravityTable gravity;
    AdjustmentInput input;
    AdjustmentOptions options;

    explicit Predicted(const SyntheticOptions& o, std::uint64_t seed)
        : world(make(o, seed)),
          gravity(world.measurements.skin, world.measurements.gravity),
          input(world.input(gravity)) {
        options.pixelSigmaFloor_px = 1e-3;
        options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
        options.accelerometerSigma = 0.03;
        for (PixelObservation& observation : input.pixels)
            observation.sigma_px = 0.1;
    }
    static SyntheticWorld make(SyntheticOptions o, std::uint64_t seed) {
        Random random(seed, "prediction");
        return makeWorld(random, o);
    }
    [[nodiscard]] auto ask(const std::vector<LedInView>& leds, const RunContext& context = {}) const {
        return predictPixels(input, world.state(), Gauge{{0}, {}}, options, leds, context);
    }
};

bool isOf(const PixelObservation& o, const LedInView& led) {
    return o.view == led.view && o.module == led.module;
}

// Monte Carlo: errors of the predicted pixel against its covariance, for an LED that this view does not show and for
// one that no view shows.
TEST(PixelPrediction, CovarianceIsThatOfTheErrors) {
    for (const bool isUnseen : {false, true}) {
        Predicted p({}, 3);
        const LedInView led{2, 4};
        std::erase_if(p.input.pixels,
                      [&](const PixelObservation& o) { return isOf(o, led) || (isUnseen && o.module == led.module); });
        const auto prediction = p.ask({led});
        ASSERT_TRUE(prediction);
        ASSERT_TRUE((*prediction)[0]);
        const Eigen::Matrix2d expected = (*prediction)[0]->covariance;
        const Vector2d truth = (*prediction)[0]->pixel;
        Random random(1, "errors");
        constexpr int kRounds = 200;
        Eigen::Matrix2d found = Eigen::Matrix2d::Zero();
        for (int round = 0; round < kRounds; ++round) {
            AdjustmentInput noisy = p.input;
            for (PixelObservation& o : noisy.pixels)
                o.pixel += o.sigma_px * Vector2d(random.normal(), random.normal());
            for (PortPair& link : noisy.links)
                link.port_a += p.world.T_r_u[link.a].linear().transpose() * random.normal3() * p.options.linkSigma;
            auto readings = p.world.measurements.gravity;
            for (GravityReading& reading : readings)
                reading.acceleration += p.options.accelerometerSigma * random.normal3();
            const GravityTable gravity(p.world.measurements.skin, readings);
            noisy.gravity = &gravity;
            const auto solved = adjustBody(noisy, p.world.state(), Gauge{{0}, {}}, p.options).value();
            const auto residual = pixelResidual(noisy, solved.state, {led.view, led.module, truth, 1});
            ASSERT_TRUE(residual);
            found += *residual * residual->transpose() / kRounds;
        }
        // Whitened, it is the identity: 200 rounds fix each entry to 10 %.
        const Eigen::Matrix2d L = Eigen::LLT<Eigen::Matrix2d>(expected).matrixL();
        const Eigen::Matrix2d whitened = L.inverse() * found * L.inverse().transpose();
        EXPECT_LT((whitened - Eigen::Matrix2d::Identity()).cwiseAbs().maxCoeff(), 0.35) << whitened;
    }
}

TEST(PixelPrediction, EachIsTheSameWhateverElseIsAsked) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Predicted p({}, seed);
        std::vector<LedInView> all;
        for (std::size_t v = 0; v < p.world.T_r_v.size(); ++v) {
            for (std::size_t u = 0; u < p.world.T_r_u.size(); ++u)
                all.push_back({v, u});
        }
        const auto together = p.ask(all);
        ASSERT_TRUE(together);
        for (std::size_t i = 0; i < all.size(); i += 3) {
            const auto alone = p.ask({all[i]});
            ASSERT_TRUE(alone);
            ASSERT_EQ((*alone)[0].has_value(), (*together)[i].has_value());
            if (!(*alone)[0])
                continue;
            const Eigen::Matrix2d& C = (*alone)[0]->covariance;
            EXPECT_LT((C - (*together)[i]->covariance).norm(), 1e-6 * C.norm());
            EXPECT_GT(C.determinant(), 0);
        }
    }
}

TEST(PixelPrediction, NothingIsMadeUp) {
    Predicted p({}, 6);
    BodyState state = p.world.state();
    state.T_r_u[1].reset();
    state.T_r_v[1].reset();
    // A module that has a pose, but of which nothing was measured.
    std::erase_if(p.input.pixels, [](const PixelObservation& o) { return o.module == 3; });
    std::erase_if(p.input.links, [](const PortPair& link) { return link.a == 3 || link.b == 3; });
    auto readings = p.world.measurements.gravity;
    std::erase_if(readings,
                  [&](const GravityReading& r) { return r.module == p.world.measurements.skin.modules[3].id; });
    const GravityTable gravity(p.world.measurements.skin, readings);
    p.input.gravity = &gravity;
    const auto predictions = predictPixels(p.input, state, Gauge{{0}, {}}, p.options, {{0, 1}, {1, 0}, {0, 3}, {0, 0}});
    ASSERT_TRUE(predictions);
    EXPECT_FALSE((*predictions)[0]);
    EXPECT_FALSE((*predictions)[1]);
    EXPECT_FALSE((*predictions)[2]);
    EXPECT_TRUE((*predictions)[3]);
}

TEST(PixelPrediction, FailsWhereTheDataFixNothing) {
    Predicted p({}, 7);
    const auto noGauge = predictPixels(p.input, p.world.state(), Gauge{}, p.options, {{0, 0}});
    ASSERT_FALSE(noGauge);
    EXPECT_EQ(noGauge.error().code, ErrorCode::DegeneratePoints);
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto cancelled = p.ask({{0, 0}}, context);
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
    EXPECT_THROW((void)p.ask({{99, 0}}), std::logic_error);
    EXPECT_THROW((void)p.ask({{0, 999}}), std::logic_error);
    EXPECT_TRUE(p.ask({})->empty());
}

}  // namespace
}  // namespace skincal
