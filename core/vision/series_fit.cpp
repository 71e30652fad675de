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

SeriesFit::SeriesFit(const Codebook& codebook, const FittedSeries& series, const Ambient& ambient,
                     const WordMatchOptions& options)
    : codebook_(codebook),
      ambient_(ambient),
      options_(options),
      y_(series.y),
      cameraSigma_(series.sigma),
      division_(options) {
    for (std::size_t k = 0; k < series.atLeast.size(); ++k) {
        if (series.atLeast[k] != 0)
            bounds_.push_back(k);
    }
    const Eigen::VectorXd& y = series.y;
    const double spread = codebook.coloured ? options.colourSpread : options.brightnessSpread;
    sigma_ = std::hypot(series.sigma, spread * series.strength);
    baseCount_ = codebook.drift.cols() + (hasAmbient() ? 1 : 0);
    columns_.resize(y.size(), kMostUnknowns);
    columns_.leftCols(codebook.drift.cols()) = codebook.drift;
    if (hasAmbient())
        columns_.col(baseCount_ - 1) = ambient.light.array() - ambient.light.mean();
    const auto base = columns_.leftCols(baseCount_);
    N_ = UnknownsSquare::Zero(kMostUnknowns, kMostUnknowns);
    moment_ = Unknowns::Zero(kMostUnknowns);
    N_.topLeftCorner(baseCount_, baseCount_) = base.transpose().lazyProduct(base);
    moment_.head(baseCount_) = base.transpose() * y;
    count_ = baseCount_;
    residuals_.resize(y.size());
}

/// Adds a column with ones in these planes.
void SeriesFit::appendColumn(std::span<const std::size_t> planes) {
    auto column = columns_.col(count_);
    column.setZero();
    for (const std::size_t plane : planes)
        column[static_cast<Eigen::Index>(plane)] = 1;
    for (Eigen::Index j = 0; j <= count_; ++j) {
        double sum = 0;
        for (const std::size_t plane : planes)
            sum += columns_(static_cast<Eigen::Index>(plane), j);
        N_(count_, j) = sum;
    }
    double sum = 0;
    for (const std::size_t plane : planes)
        sum += y_[static_cast<Eigen::Index>(plane)];
    moment_[count_++] = sum;
}

Explanation SeriesFit::explainPlainly(const std::vector<std::size_t>& words) {
    count_ = baseCount_;
    for (const std::size_t word : words)
        appendColumn(codebook_.lit[word]);
    return refine(words, std::vector<std::uint8_t>(codebook_.planes(), 1));
}

Explanation SeriesFit::explain(const std::vector<std::size_t>& words) {
    Explanation best = explainPlainly(words);
    if (words.size() == 1 && !best.isClean()) {
        std::vector<std::uint8_t> used(codebook_.planes());
        Eigen::VectorXd residuals = residualsFromLevels(words[0]);
        met_.assign(used.size(), 0);
        meetBounds(residuals, met_);
        (void)division_.divide(residuals, sigma_, used);
        Explanation other = refine(words, std::move(used));
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
    std::vector<std::uint8_t> isCalm;  // once that is asked
    for (const std::size_t word : e.words) {
        std::vector<std::size_t> seen;
        std::copy_if(codebook_.lit[word].begin(), codebook_.lit[word].end(), std::back_inserter(seen),
                     [&](std::size_t plane) { return e.used[plane] != 0 && e.met[plane] == 0; });
        if (seen.size() >= kEnough)
            continue;
        if (isCalm.empty())
            isCalm = calmPlanes(e);
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
    if (!e.significant)
        return false;
    // Bounds that are met say little, however cheap they are.
    constexpr double kLeastFitted = 0.25;
    if (static_cast<double>(e.fitted) < kLeastFitted * static_cast<double>(codebook_.planes()))
        return false;
    return static_cast<double>(e.disturbed) <= most * static_cast<double>(codebook_.planes()) &&
           e.reducedCost <= options_.maxReducedCost &&
           e.explained >= (two ? options_.minExplainedByTwo : options_.minExplained) && !mayBeDisturbance(e);
}

double SeriesFit::costOfDarkness(const std::vector<std::uint8_t>& used) {
    double least = explain({}).cost;
    const std::vector<std::uint8_t> all(codebook_.planes(), 1);
    std::vector<std::size_t> after;
    for (std::size_t k = used.size(); k-- > 1;) {
        after.push_back(k);
        // A step that a word can be taken for lies where the word had to be helped.
        if (used[k] == used[k - 1])
            continue;
        count_ = baseCount_;
        appendColumn(after);
        least = std::min(least, options_.outlier * options_.outlier + refine({}, all).cost);
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

/// Nothing where the planes can't tell the columns apart.
std::optional<SeriesFit::Solution> SeriesFit::solve(const std::vector<std::uint8_t>& fitted) const {
    UnknownsSquare N = N_.topLeftCorner(count_, count_);
    Unknowns moment = moment_.head(count_);
    for (std::size_t plane = 0; plane < fitted.size(); ++plane) {
        if (fitted[plane] != 0)
            continue;
        const auto k = static_cast<Eigen::Index>(plane);
        for (Eigen::Index i = 0; i < count_; ++i) {
            const double value = columns_(k, i);
            moment[i] -= value * y_[k];
            for (Eigen::Index j = 0; j <= i; ++j)
                N(i, j) -= value * columns_(k, j);
        }
    }
    Solution solution;
    if (hasAmbient()) {
        // Off its mean over the used planes (centred): the ambient less so much of the intercept's column.
        const Eigen::Index a = baseCount_ - 1;
        const double share = N(0, 0) > 0 ? N(a, 0) / N(0, 0) : 0.0;
        N(a, a) -= share * N(a, 0);
        for (Eigen::Index j = 0; j < a; ++j)
            N(a, j) -= share * N(j, 0);
        for (Eigen::Index i = a + 1; i < count_; ++i)
            N(i, a) -= share * N(i, 0);
        moment[a] -= share * moment[0];
        N(a, a) += ridge();
        solution.drifted = share;
    }
    solution.factor.compute(N);
    // The drift columns are normalised, so small numbers here mean dependence, not scale.
    if (solution.factor.info() != Eigen::Success || solution.factor.vectorD().minCoeff() < 1e-3)
        return std::nullopt;
    solution.values = solution.factor.solve(moment);
    return solution;
}

void SeriesFit::setResiduals(const Solution& solution) {
    Unknowns values = solution.values;
    if (hasAmbient())
        values[0] -= solution.drifted * values[baseCount_ - 1];
    residuals_ = y_;
    for (Eigen::Index j = 0; j < count_; ++j)
        residuals_ -= values[j] * columns_.col(j);
}

void SeriesFit::meetBounds(Eigen::VectorXd& residuals, std::vector<std::uint8_t>& met) const {
    for (const std::size_t k : bounds_) {
        double& residual = residuals[static_cast<Eigen::Index>(k)];
        // What is met by less than noise counts as a value: else none might be left that the words are fitted to.
        if (residual >= -sigma_)
            continue;
        residual = 0;
        met[k] = 1;
    }
}

/// The used planes without bounds that are met.
const std::vector<std::uint8_t>& SeriesFit::fittedOf(const std::vector<std::uint8_t>& used) {
    if (bounds_.empty())
        return used;
    fitted_ = used;
    for (const std::size_t k : bounds_)
        fitted_[k] = met_[k] != 0 ? 0 : used[k];
    return fitted_;
}

/// Fits and drops disturbed planes, and bounds that are met, in turn. Bounds first: before they are met, values far
/// from the truth would make others look disturbed.
Explanation SeriesFit::refine(const std::vector<std::size_t>& words, std::vector<std::uint8_t> used) {
    Explanation e;
    e.words = words;
    next_.resize(used.size());
    met_.assign(used.size(), 0);
    bool isBounded = !bounds_.empty();
    bool hasMet = !isBounded;
    for (int iteration = 1; iteration <= options_.maxIterations; ++iteration) {
        const auto solution = solve(fittedOf(used));
        // Without what tells little nothing is left: then it counts as any other.
        if (!solution && isBounded) {
            met_.assign(used.size(), 0);
            isBounded = false;
            hasMet = true;
            continue;
        }
        if (!solution) {
            // So few planes are left that nothing is known: as if all of them were disturbed.
            if (words.empty())
                e.cost = division_.costOfNothing(codebook_.planes());
            return e;
        }
        setResiduals(*solution);
        if (hasAmbient())
            e.ambient = solution->values[baseCount_ - 1];
        nextMet_.assign(used.size(), 0);
        if (isBounded)
            meetBounds(residuals_, nextMet_);
        if (!hasMet && nextMet_ != met_ && iteration < options_.maxIterations / 2) {
            std::swap(met_, nextMet_);
            continue;
        }
        hasMet = true;
        const double cost = division_.divide(residuals_, sigma_, next_) + ridge() * std::pow(e.ambient / sigma_, 2);
        const bool settled = next_ == used && nextMet_ == met_;
        std::swap(used, next_);
        std::swap(met_, nextMet_);
        if (!settled && iteration < options_.maxIterations)
            continue;
        e.amplitudes = solution->values.tail(static_cast<Eigen::Index>(words.size()));
        e.drift = solution->values.head(codebook_.drift.cols());
        if ((e.amplitudes.array() <= 0).any())
            return e;
        e.cost = cost;
        e.used = std::move(used);
        e.met = met_;
        judge(*solution, settled, e);
        return e;
    }
    return e;
}

/// What there is to say of a fit besides its cost.
void SeriesFit::judge(const Solution& solution, bool settled, Explanation& e) const {
    const Eigen::Index words = e.amplitudes.size();
    const UnknownsSquare inverse = solution.factor.solve(UnknownsSquare::Identity(count_, count_));
    const Unknowns sigmas = cameraSigma_ * inverse.diagonal().tail(words).cwiseSqrt();
    // Planes that come and go leave no fit: what was solved and what would be kept belong to different planes,
    // over which the words need not even be separable. Its cost is a cost all the same, which others must beat.
    e.significant = settled && (e.amplitudes.array() > options_.minSignificance * sigmas.array()).all();
    double left = 0;
    for (std::size_t k = 0; k < e.used.size(); ++k) {
        if (e.used[k] != 0) {
            left += std::pow(residuals_[static_cast<Eigen::Index>(k)], 2);
            e.fitted += met_[k] != 0 ? 0U : 1U;
        } else {
            ++e.disturbed;
            e.runs += k == 0 || e.used[k - 1] != 0 ? 1U : 0U;
        }
    }
    const double freedom = static_cast<double>(e.fitted) - static_cast<double>(count_);
    e.reducedCost = freedom > 0 ? left / (sigma_ * sigma_) / freedom : 0.0;
    if (words > 0) {
        // What the sum of squares falls by where the words are let in.
        const UnknownsSquare ofWords = inverse.bottomRightCorner(words, words);
        const double energy = e.amplitudes.dot(ofWords.inverse() * e.amplitudes);
        const double strange = std::max(0.0, left - cameraSigma_ * cameraSigma_ * std::max(0.0, freedom));
        e.explained = energy / (energy + strange);
    }
}

}  // namespace skincal
