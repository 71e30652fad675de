#include "core/vision/spot_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace skincal {
namespace {

constexpr Eigen::Index kMostAcross = 61;

/// Pixels below each other, with which processors reckon at once.
using Pair = Eigen::Array2d;

using Line = std::array<double, kMostAcross + 1>;

/// exp(-u^2 / 2s^2) at u = first, first + 1, …: each is the one before times what itself shrinks by the same factor
/// each time. From the middle outwards, so that what gets too small to be a number comes last.
void fillGaussian(double first, Eigen::Index count, double inverse, Line& line) {
    // Where a fit has gone astray, the first is no number.
    const double nearest = -std::round(first);
    const auto middle =
        static_cast<std::ptrdiff_t>(nearest > 0 ? std::min(nearest, static_cast<double>(count - 1)) : 0.0);
    const double u = first + static_cast<double>(middle);
    const double top = std::exp(-0.5 * u * u * inverse);
    const double shrink = std::exp(-inverse);
    double up = std::exp(-(u + 0.5) * inverse);
    double down = std::exp((u - 0.5) * inverse);
    line[static_cast<std::size_t>(middle)] = top;
    double value = top;
    for (std::ptrdiff_t i = middle + 1; i < count; ++i, up *= shrink)
        line[static_cast<std::size_t>(i)] = value *= up;
    value = top;
    for (std::ptrdiff_t i = middle; i-- > 0; down *= shrink)
        line[static_cast<std::size_t>(i)] = value *= down;
}

/// Core and halo along an axis.
struct Profile {
    Line away{};
    Line core{};
    Line halo{};

    Profile(int first, Eigen::Index count, double centre, double inverse, double haloInverse) {
        for (Eigen::Index i = 0; i < count; ++i)
            away[static_cast<std::size_t>(i)] = first + static_cast<double>(i) - centre;
        fillGaussian(first - centre, count, inverse, core);
        fillGaussian(first - centre, count, haloInverse, halo);
    }
};

}  // namespace

SpotModel::SpotModel(const SpotWindow& window, const SpotPrior& prior, double haloWidth)
    : window_(window), prior_(prior), haloWidth_(haloWidth) {
    const Eigen::Index rows = window.value.rows();
    const Eigen::Index cols = window.value.cols();
    if (rows > kMostAcross || cols > kMostAcross)
        throw std::logic_error("SpotModel: the window is too large");
    weight_ = Eigen::ArrayXXd::Zero(rows + rows % 2, cols);
    value_ = weight_;
    bound_ = Eigen::ArrayXXd::Constant(weight_.rows(), cols, std::numeric_limits<double>::infinity());
    value_.topRows(rows) = window.value;
    for (Eigen::Index col = 0; col < cols; ++col) {
        for (Eigen::Index row = 0; row < rows; ++row) {
            if (window.state(row, col) != PixelState::Excluded)
                weight_(row, col) = 1 / window.variance(row, col);
            if (window.state(row, col) == PixelState::Saturated)
                bound_(row, col) = 0;
        }
    }
}

SpotModel::Normals SpotModel::at(const SpotParameters& p) const {
    const double amplitude = std::exp(p[2]);
    const double inverse = std::exp(-2 * p[3]);
    const double haloInverse = inverse / (haloWidth_ * haloWidth_);
    const Profile x(window_.x0, weight_.cols(), p[0], inverse, haloInverse);
    const Profile y(window_.y0, weight_.rows(), p[1], inverse, haloInverse);
    Normals normals;
    // Lower triangle, row by row.
    std::array<Pair, 21> N;
    std::array<Pair, 6> g;
    N.fill(Pair::Zero());
    g.fill(Pair::Zero());
    Pair misfit = Pair::Zero();
    for (Eigen::Index col = 0; col < weight_.cols(); ++col) {
        const auto i = static_cast<std::size_t>(col);
        const double core = amplitude * x.core.at(i);
        const double halo = amplitude * x.halo.at(i);
        const double dx = x.away.at(i);
        for (Eigen::Index row = 0; row < weight_.rows(); row += 2) {
            const auto j = static_cast<std::size_t>(row);
            const Pair inCore = core * Pair(y.core[j], y.core[j + 1]);
            const Pair inHalo = halo * Pair(y.halo[j], y.halo[j + 1]);
            const Pair light = inCore + p[5] * inHalo;
            const Pair residual = p[4] + light - value_.block<2, 1>(row, col);
            Pair weight = weight_.block<2, 1>(row, col);
            // A bound that is met says nothing.
            weight *= (residual < bound_.block<2, 1>(row, col)).cast<double>();
            normals.informative += static_cast<int>((weight > 0).count());
            misfit += weight * residual * residual;
            const Pair slope = inCore * inverse + p[5] * inHalo * haloInverse;
            const Pair dy(y.away[j], y.away[j + 1]);
            const std::array<Pair, 6> J{slope * dx, slope * dy, light, slope * (dx * dx + dy * dy), Pair(1, 1), inHalo};
            std::size_t k = 0;
            for (std::size_t a = 0; a < 6; ++a) {
                const Pair weighted = weight * J[a];
                g[a] += weighted * residual;
                for (std::size_t b = 0; b <= a; ++b)
                    N[k++] += weighted * J[b];
            }
        }
    }
    normals.misfit = misfit.sum();
    std::size_t k = 0;
    for (Eigen::Index a = 0; a < 6; ++a) {
        normals.g[a] = g.at(static_cast<std::size_t>(a)).sum();
        for (Eigen::Index b = 0; b <= a; ++b)
            normals.N(a, b) = normals.N(b, a) = N.at(k++).sum();
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

SpotModel::Explained SpotModel::explained(const SpotParameters& p) const {
    const auto eachGood = [&](const auto& visit) {
        for (Eigen::Index col = 0; col < window_.value.cols(); ++col) {
            for (Eigen::Index row = 0; row < window_.value.rows(); ++row) {
                const Vector2d away(window_.x0 + static_cast<double>(col) - p[0],
                                    window_.y0 + static_cast<double>(row) - p[1]);
                if (window_.state(row, col) == PixelState::Good)
                    visit(away, weight_(row, col), window_.value(row, col));
            }
        }
    };
    // Weighted sums of 1, x and y with each other and with the light.
    Matrix3d slopes = Matrix3d::Zero();
    Vector3d moment = Vector3d::Zero();
    double squares = 0;
    eachGood([&](const Vector2d& away, double weight, double value) {
        const Vector3d plane(1, away.x(), away.y());
        slopes += weight * plane * plane.transpose();
        moment += weight * value * plane;
        squares += weight * value * value;
    });
    // Bounds that are not met are misfit, too, but not of these pixels.
    double met = 0;
    const double amplitude = std::exp(p[2]);
    const double inverse = std::exp(-2 * p[3]);
    eachGood([&](const Vector2d& away, double weight, double value) {
        const double r2 = 0.5 * inverse * away.squaredNorm();
        const double light = amplitude * (std::exp(-r2) + p[5] * std::exp(-r2 / (haloWidth_ * haloWidth_)));
        met += weight * std::pow(p[4] + light - value, 2);
    });
    const double even = squares - moment[0] * moment[0] / slopes(0, 0);
    const double sloping = squares - moment.dot(slopes.ldlt().solve(moment));
    return {sloping - met, even > 0 ? 1 - met / even : 0.0};
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
