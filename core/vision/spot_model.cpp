#include "core/vision/spot_model.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <stdexcept>

namespace skincal {
namespace {

constexpr Eigen::Index kMostAcross = 61;

/// exp(-u^2 / 2s^2) along an axis.
struct Profile {
    std::array<double, kMostAcross> away{};
    std::array<double, kMostAcross> core{};
    std::array<double, kMostAcross> halo{};

    Profile(int first, Eigen::Index count, double centre, double inverse, double haloInverse) {
        for (Eigen::Index i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const double u = first + static_cast<double>(i) - centre;
            away.at(at) = u;
            core.at(at) = std::exp(-0.5 * u * u * inverse);
            halo.at(at) = std::exp(-0.5 * u * u * haloInverse);
        }
    }
};

}  // namespace

SpotModel::SpotModel(const SpotWindow& window, const SpotPrior& prior, double haloWidth)
    : window_(window), prior_(prior), haloWidth_(haloWidth), weight_(window.value.rows(), window.value.cols()) {
    if (weight_.rows() > kMostAcross || weight_.cols() > kMostAcross)
        throw std::logic_error("SpotModel: the window is too large");
    for (Eigen::Index i = 0; i < weight_.size(); ++i)
        weight_(i) = window.state(i) == PixelState::Excluded ? 0 : 1 / window.variance(i);
}

SpotModel::Normals SpotModel::at(const SpotParameters& p) const {
    const double amplitude = std::exp(p[2]);
    const double inverse = std::exp(-2 * p[3]);
    const double haloInverse = inverse / (haloWidth_ * haloWidth_);
    const Profile x(window_.x0, weight_.cols(), p[0], inverse, haloInverse);
    const Profile y(window_.y0, weight_.rows(), p[1], inverse, haloInverse);
    Normals normals;
    // Lower triangle, row by row: the compiler keeps plain numbers in registers.
    std::array<double, 21> N{};
    std::array<double, 6> g{};
    for (Eigen::Index col = 0; col < weight_.cols(); ++col) {
        const auto i = static_cast<std::size_t>(col);
        const double core = amplitude * x.core.at(i);
        const double halo = amplitude * x.halo.at(i);
        const double dx = x.away.at(i);
        for (Eigen::Index row = 0; row < weight_.rows(); ++row) {
            const double weight = weight_(row, col);
            if (weight == 0)
                continue;
            const auto j = static_cast<std::size_t>(row);
            const double inCore = core * y.core.at(j);
            const double inHalo = halo * y.halo.at(j);
            const double light = inCore + p[5] * inHalo;
            const double residual = p[4] + light - window_.value(row, col);
            if (residual >= 0 && window_.state(row, col) == PixelState::Saturated)
                continue;
            ++normals.informative;
            normals.misfit += weight * residual * residual;
            const double slope = inCore * inverse + p[5] * inHalo * haloInverse;
            const double dy = y.away.at(j);
            const std::array<double, 6> J{slope * dx, slope * dy, light, slope * (dx * dx + dy * dy), 1, inHalo};
            std::size_t k = 0;
            for (std::size_t a = 0; a < 6; ++a) {
                const double weighted = weight * J[a];
                g[a] += weighted * residual;
                for (std::size_t b = 0; b <= a; ++b)
                    N[k++] += weighted * J[b];
            }
        }
    }
    std::size_t k = 0;
    for (Eigen::Index a = 0; a < 6; ++a) {
        normals.g[a] = g.at(static_cast<std::size_t>(a));
        for (Eigen::Index b = 0; b <= a; ++b)
            normals.N(a, b) = normals.N(b, a) = N.at(k++);
    }
    normals.cost = normals.misfit;
    const auto believe = [&](Eigen::Index parameter, double mean, double sigma) {
        const double away = (p[parameter] - mean) / sigma;
        normals.N(parameter, parameter) += 1 / (sigma * sigma);
        normals.g[parameter] += away / sigma;
        normals.cost += away * away;
    };
    believe(3, prior_.logWidth, prior_.logWidthSigma);
    believe(5, prior_.halo, prior_.haloSigma);
    return normals;
}

double SpotModel::explainedShare(const SpotParameters& p) const {
    double weights = 0;
    double mean = 0;
    const auto isGood = [&](Eigen::Index i) { return window_.state(i) == PixelState::Good; };
    for (Eigen::Index i = 0; i < weight_.size(); ++i) {
        if (isGood(i)) {
            weights += weight_(i);
            mean += weight_(i) * window_.value(i);
        }
    }
    mean /= weights;
    double total = 0;
    double met = 0;
    for (Eigen::Index i = 0; i < weight_.size(); ++i) {
        if (isGood(i))
            total += weight_(i) * std::pow(window_.value(i) - mean, 2);
    }
    // Bounds that are not met are misfit, too, but not of these pixels.
    const double amplitude = std::exp(p[2]);
    const double inverse = std::exp(-2 * p[3]);
    for (Eigen::Index i = 0; i < weight_.size(); ++i) {
        if (!isGood(i))
            continue;
        const double dx = window_.x0 + static_cast<double>(i / weight_.rows()) - p[0];
        const double dy = window_.y0 + static_cast<double>(i % weight_.rows()) - p[1];
        const double r2 = 0.5 * inverse * (dx * dx + dy * dy);
        const double light = amplitude * (std::exp(-r2) + p[5] * std::exp(-r2 / (haloWidth_ * haloWidth_)));
        met += weight_(i) * std::pow(p[4] + light - window_.value(i), 2);
    }
    return total > 0 ? 1 - met / total : 0.0;
}

SpotModel::Normals SpotModel::minimise(SpotParameters& p) const {
    constexpr int kMostSteps = 60;
    constexpr double kSettled = 1e-4;  // (a hundredth of a standard deviation)^2
    constexpr double kLeastDamping = 1e-7;
    double damping = 1e-3;
    Normals here = at(p);
    for (int step = 0; step < kMostSteps && std::isfinite(here.cost); ++step) {
        Matrix6d damped = here.N;
        damped.diagonal() *= 1 + damping;
        const Vector6d d = damped.ldlt().solve(-here.g);
        const SpotParameters next = p + d;
        // Of a damped step, what it would be without.
        const double moves = (1 + damping) * (1 + damping) * d.dot(here.N * d);
        const Normals there = at(next);
        if (there.cost <= here.cost) {
            p = next;
            here = there;
            damping = std::max(kLeastDamping, damping / 10);
            if (moves < kSettled)
                break;
        } else {
            // Rounding alone keeps it from getting better.
            if (moves < kSettled)
                break;
            damping *= 10;
        }
    }
    return here;
}

}  // namespace skincal
