#include "core/vision/series_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "core/geometry/statistics.h"

namespace skincal {

Eigen::VectorXd offDrift(const Codebook& codebook, const Ambient& ambient, const Eigen::VectorXd& y) {
    Eigen::VectorXd off = y - codebook.drift * (codebook.drift.transpose() * y);
    if (ambient.light.size() > 0) {
        const Eigen::VectorXd a = ambient.light - codebook.drift * (codebook.drift.transpose() * ambient.light);
        off -= a * (a.dot(off) / (a.squaredNorm() + ambient.ridge));
    }
    return off;
}

SeriesFit::SeriesFit(const Codebook& codebook, const Eigen::VectorXd& y, double sigma, double strength,
                     const Ambient& ambient, const WordMatchOptions& options)
    : codebook_(codebook), ambient_(ambient), options_(options), y_(y), cameraSigma_(sigma) {
    const double spread = codebook.coloured ? options.colourSpread : options.brightnessSpread;
    sigma_ = std::hypot(sigma, spread * strength);
    baseColumns_ = codebook.drift.cols();
    base_ = Rows::Zero(y.size(), kMostColumns);
    base_.leftCols(baseColumns_) = codebook.drift;
    if (ambient.light.size() > 0)
        base_.col(baseColumns_++) = ambient.light;
}

Explanation SeriesFit::explain(const std::vector<std::size_t>& words) const {
    Rows rows = base_;
    Eigen::Index columns = baseColumns_;
    for (const std::size_t word : words) {
        for (const std::size_t plane : codebook_.lit[word])
            rows(static_cast<Eigen::Index>(plane), columns) = 1;
        ++columns;
    }
    // The best of two starts: plain least squares, and (for single words) levels that hidden planes don't move.
    Explanation best = refine(rows, columns, words, std::vector<std::uint8_t>(codebook_.planes(), 1));
    if (words.size() == 1 && !best.isClean()) {
        std::vector<std::uint8_t> used(codebook_.planes());
        (void)divide(residualsFromLevels(words[0]), used);
        Explanation other = refine(rows, columns, words, std::move(used));
        if (other.cost < best.cost)
            best = std::move(other);
    }
    return best;
}

/// Planes in which nothing but light that blinks changes, as far as the used planes and the surroundings tell.
std::vector<std::uint8_t> SeriesFit::calmPlanes(const Explanation& e) const {
    std::vector<std::uint8_t> isCalm = e.used;
    // Channels have surroundings of their own.
    if (ambient_.light.size() == 0 || codebook_.coloured)
        return isCalm;
    const double* light = ambient_.light.data();
    const double middle = median({light, light + ambient_.light.size()});
    std::vector<double> away;
    for (std::size_t k = 0; k < isCalm.size(); ++k)
        away.push_back(std::abs(light[k] - middle));
    // What four planes in five stay below is what lamps do all the time.
    std::vector<double> sorted = away;
    const auto usual = sorted.begin() + static_cast<std::ptrdiff_t>(4 * (sorted.size() - 1) / 5);
    std::nth_element(sorted.begin(), usual, sorted.end());
    constexpr double kTimesUsual = 3;
    const double most = kTimesUsual * *usual + options_.outlier * cameraSigma_;
    for (std::size_t k = 0; k < isCalm.size(); ++k) {
        if (away[k] > most)
            isCalm[k] = 0;
    }
    return isCalm;
}

/// A word that shines in a frame or two looks like a flash, and what disturbs the frames next to it may well do so.
bool SeriesFit::mayBeDisturbance(const Explanation& e) const {
    constexpr std::size_t kEnough = 3;
    constexpr std::size_t kNear = 3;
    const std::size_t perFrame = codebook_.coloured ? 3 : 1;
    const std::vector<std::uint8_t> isCalm = calmPlanes(e);
    for (const std::size_t word : e.words) {
        std::vector<std::size_t> seen;
        std::copy_if(codebook_.lit[word].begin(), codebook_.lit[word].end(), std::back_inserter(seen),
                     [&](std::size_t plane) { return e.used[plane] != 0; });
        if (seen.size() >= kEnough)
            continue;
        for (const std::size_t plane : seen) {
            const std::size_t reach = kNear * perFrame;
            const std::size_t last = std::min(plane + reach, isCalm.size() - 1);
            for (std::size_t k = plane - std::min(plane, reach); k <= last; ++k) {
                // In its own frame the LED's halo changes its surroundings.
                if (isCalm[k] == 0 && k / perFrame != plane / perFrame)
                    return true;
            }
        }
    }
    return false;
}

bool SeriesFit::believable(const Explanation& e) const {
    // Of two words there are so many that some will fit what two do not make, once planes may be left out.
    const bool two = e.words.size() > 1;
    const double most = two ? 0 : e.runs > 1 ? options_.maxDisturbed : options_.maxHidden;
    if (!e.significant || mayBeDisturbance(e))
        return false;
    return static_cast<double>(e.disturbed) <= most * static_cast<double>(codebook_.planes()) &&
           e.reducedCost <= options_.maxReducedCost &&
           e.explained >= (two ? options_.minExplainedByTwo : options_.minExplained);
}

double SeriesFit::costOfDarkness(const std::vector<std::uint8_t>& used) const {
    double least = explain({}).cost;
    Rows rows = base_;
    const std::vector<std::uint8_t> all(codebook_.planes(), 1);
    for (std::size_t k = used.size(); k-- > 1;) {
        rows(static_cast<Eigen::Index>(k), baseColumns_) = 1;
        // A step that a word can be taken for lies where the word had to be helped.
        if (used[k] != used[k - 1])
            least = std::min(least, options_.outlier * options_.outlier + refine(rows, baseColumns_ + 1, {}, all).cost);
    }
    return least;
}

/// Dark is the median of the dark planes. Of the lit ones three in ten may be disturbed by more light and nearly seven
/// by less, as by who stands in front.
Eigen::VectorXd SeriesFit::residualsFromLevels(std::size_t word) const {
    const std::size_t channels = codebook_.coloured ? 3 : 1;
    std::vector<std::uint8_t> lit(codebook_.planes(), 0);
    for (const std::size_t plane : codebook_.lit[word])
        lit[plane] = 1;
    std::array<double, 3> dark{};
    std::vector<double> steps;
    for (std::size_t channel = 0; channel < channels; ++channel) {
        std::vector<double> off;
        for (std::size_t k = 0; k < lit.size(); ++k) {
            if (codebook_.channelOf[k] == channel && lit[k] == 0)
                off.push_back(y_[static_cast<Eigen::Index>(k)]);
        }
        if (off.empty())
            continue;
        dark.at(channel) = median(std::move(off));
        for (std::size_t k = 0; k < lit.size(); ++k) {
            if (codebook_.channelOf[k] == channel && lit[k] != 0)
                steps.push_back(y_[static_cast<Eigen::Index>(k)] - dark.at(channel));
        }
    }
    double step = 0;
    if (!steps.empty()) {
        const auto high = steps.begin() + static_cast<std::ptrdiff_t>(7 * (steps.size() - 1) / 10);
        std::nth_element(steps.begin(), high, steps.end());
        step = *high;
    }
    Eigen::VectorXd residuals = y_;
    for (std::size_t k = 0; k < lit.size(); ++k)
        residuals[static_cast<Eigen::Index>(k)] -= dark.at(codebook_.channelOf[k]) + (lit[k] != 0 ? step : 0.0);
    return residuals;
}

/// The cheapest division of the planes into used and disturbed ones (Viterbi), and its cost. A plane is used, the first
/// of a run of disturbed ones, the second, or a later one.
double SeriesFit::divide(const Eigen::VectorXd& residuals, std::vector<std::uint8_t>& used) const {
    constexpr std::uint8_t kUsed = 0;
    constexpr std::uint8_t kFirst = 1;
    constexpr std::uint8_t kSecond = 2;
    constexpr std::uint8_t kLater = 3;
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const double enter = options_.outlier * options_.outlier;
    const double stay = options_.hiddenCost * options_.hiddenCost;
    std::array<double, 4> cost{0, kNever, kNever, kNever};
    std::vector<std::array<std::uint8_t, 4>> from(used.size());
    const auto cheapest = [&] {
        return static_cast<std::uint8_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    };
    for (std::size_t k = 0; k < used.size(); ++k) {
        const double misfit = std::pow(residuals[static_cast<Eigen::Index>(k)] / sigma_, 2);
        const std::uint8_t goesOn = cost[kSecond] < cost[kLater] ? kSecond : kLater;
        from[k] = {cheapest(), kUsed, kFirst, goesOn};
        cost = {cost.at(cheapest()) + misfit, cost[kUsed] + enter, cost[kFirst] + enter, cost.at(goesOn) + stay};
    }
    std::uint8_t state = cheapest();
    const double least = cost.at(state);
    for (std::size_t k = used.size(); k-- > 0; state = from[k].at(state))
        used[k] = state == kUsed ? 1 : 0;
    return least;
}

double SeriesFit::costOfNothing() const {
    const auto planes = static_cast<double>(codebook_.planes());
    return std::min(planes, 2.0) * options_.outlier * options_.outlier +
           std::max(0.0, planes - 2) * options_.hiddenCost * options_.hiddenCost;
}

Explanation SeriesFit::refine(Rows rows, Eigen::Index columns, const std::vector<std::size_t>& words,
                              std::vector<std::uint8_t> used) const {
    // Small enough for the stack: this is done some ten times per spot.
    using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostColumns, kMostColumns>;
    using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostColumns, 1>;
    Explanation e;
    e.words = words;
    const auto count = static_cast<Eigen::Index>(words.size());
    Eigen::VectorXd residuals(y_.size());
    std::vector<std::uint8_t> next(used.size());
    for (int iteration = 1; iteration <= options_.maxIterations; ++iteration) {
        if (ambient_.light.size() > 0)
            rows.col(codebook_.drift.cols()) = centred(ambient_, used).light;
        Square N = Square::Zero(columns, columns);
        Column moment = Column::Zero(columns);
        for (Eigen::Index k = 0; k < rows.rows(); ++k) {
            if (used[static_cast<std::size_t>(k)] == 0)
                continue;
            for (Eigen::Index i = 0; i < columns; ++i) {
                const double value = rows(k, i);
                moment[i] += value * y_[k];
                for (Eigen::Index j = 0; j <= i; ++j)
                    N(i, j) += value * rows(k, j);
            }
        }
        // The ambient's ridge is for camera noise; here LEDs that shine unevenly are noise, too.
        const double ridge = ambient_.ridge * std::pow(sigma_ / cameraSigma_, 2);
        if (ambient_.light.size() > 0)
            N(codebook_.drift.cols(), codebook_.drift.cols()) += ridge;
        const Eigen::LDLT<Square, Eigen::Lower> factor(N);
        // The drift columns are normalised, so small numbers here mean dependence, not scale.
        if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() < 1e-3) {
            // So few planes are left that nothing is known: as if all of them were disturbed.
            if (count == 0)
                e.cost = costOfNothing();
            return e;
        }
        const Column solution = factor.solve(moment);
        residuals.noalias() = y_ - rows.leftCols(columns) * solution;
        if (ambient_.light.size() > 0)
            e.ambient = solution[codebook_.drift.cols()];
        const double cost = divide(residuals, next) + ridge * std::pow(e.ambient / sigma_, 2);
        const bool settled = next == used;
        std::swap(used, next);
        if (!settled && iteration < options_.maxIterations)
            continue;
        e.amplitudes = solution.tail(count);
        e.drift = solution.head(codebook_.drift.cols());
        if ((e.amplitudes.array() <= 0).any())
            return e;
        const Square inverse = factor.solve(Square::Identity(columns, columns));
        const Column sigmas = cameraSigma_ * inverse.diagonal().cwiseSqrt();
        // Planes that come and go leave no fit: what was solved and what would be kept belong to different planes,
        // over which the words need not even be separable. Its cost is a cost all the same, which others must beat.
        e.significant = settled && (e.amplitudes.array() > options_.minSignificance * sigmas.tail(count).array()).all();
        e.cost = cost;
        double left = 0;
        for (std::size_t k = 0; k < used.size(); ++k) {
            if (used[k] != 0) {
                left += std::pow(residuals[static_cast<Eigen::Index>(k)], 2);
            } else {
                ++e.disturbed;
                e.runs += k == 0 || used[k - 1] != 0 ? 1U : 0U;
            }
        }
        const double freedom =
            static_cast<double>(used.size()) - static_cast<double>(e.disturbed) - static_cast<double>(columns);
        e.reducedCost = freedom > 0 ? left / (sigma_ * sigma_) / freedom : 0.0;
        if (count > 0) {
            // What the sum of squares falls by where the words are let in.
            const double energy = e.amplitudes.dot(inverse.bottomRightCorner(count, count).inverse() * e.amplitudes);
            const double strange = std::max(0.0, left - cameraSigma_ * cameraSigma_ * std::max(0.0, freedom));
            e.explained = energy / (energy + strange);
        }
        e.used = std::move(used);
        break;
    }
    return e;
}

}  // namespace skincal
