#include "core/vision/word_match.h"

#include <Eigen/Dense>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

using Words = std::vector<std::size_t>;

struct Explanation {
    Words words;
    Eigen::VectorXd amplitudes;
    std::vector<std::uint8_t> used;
    double cost = std::numeric_limits<double>::infinity();
    std::size_t disturbed = 0;
    double reducedCost = 0;
    bool significant = false;  ///< and settled; else it may compete, but not win
};

// Residuals of a single word from medians: planes that a hand or a flash spoilt don't move it.
Eigen::VectorXd medianResiduals(const Codebook& codebook, std::size_t word, const Eigen::VectorXd& y) {
    const std::size_t channels = codebook.coloured ? 3 : 1;
    std::vector<std::uint8_t> lit(codebook.planes(), 0);
    for (const std::size_t plane : codebook.lit[word])
        lit[plane] = 1;
    std::vector<double> dark(channels, 0.0);
    std::vector<double> steps;
    for (std::size_t channel = 0; channel < channels; ++channel) {
        std::vector<double> off;
        for (std::size_t k = 0; k < lit.size(); ++k) {
            if (codebook.channelOf[k] == channel && lit[k] == 0)
                off.push_back(y[static_cast<Eigen::Index>(k)]);
        }
        if (off.empty())
            continue;
        dark[channel] = median(std::move(off));
        for (std::size_t k = 0; k < lit.size(); ++k) {
            if (codebook.channelOf[k] == channel && lit[k] != 0)
                steps.push_back(y[static_cast<Eigen::Index>(k)] - dark[channel]);
        }
    }
    const double step = steps.empty() ? 0.0 : median(std::move(steps));
    Eigen::VectorXd residuals = y;
    for (std::size_t k = 0; k < lit.size(); ++k)
        residuals[static_cast<Eigen::Index>(k)] -= dark[codebook.channelOf[k]] + (lit[k] != 0 ? step : 0.0);
    return residuals;
}

class Matcher {
  public:
    Matcher(const Codebook& codebook, Eigen::VectorXd y, double sigma, const WordMatchOptions& options)
        : codebook_(codebook), y_(std::move(y)), cameraSigma_(sigma), sigma_(sigma), options_(options) {}

    void raiseSigma(double amplitude) {
        const double spread = codebook_.coloured ? options_.colourSpread : options_.brightnessSpread;
        sigma_ = std::hypot(sigma_, spread * amplitude);
    }

    // The best of two starts: plain least squares, and (for single words) medians.
    [[nodiscard]] Explanation explain(const Words& words) const {
        const Eigen::MatrixXd X = designMatrix(codebook_, words);
        std::vector<std::uint8_t> all(codebook_.planes(), 1);
        Explanation best = refine(X, words, all);
        if (words.size() == 1 && best.disturbed + best.reducedCost > 1) {
            const Explanation other = refine(X, words, keep(medianResiduals(codebook_, words[0], y_)));
            if (other.cost < best.cost)
                best = other;
        }
        return best;
    }

    // No LED at all, only drift and disturbances.
    [[nodiscard]] double costOfDarkness() const {
        const Eigen::MatrixXd X = designMatrix(codebook_, {});
        const std::vector<std::uint8_t> all(codebook_.planes(), 1);
        return std::min(refine(X, {}, all).cost, refine(X, {}, keep(y_.array() - medianOfAll())).cost);
    }

    [[nodiscard]] bool believable(const Explanation& e) const {
        return static_cast<double>(e.disturbed) <= options_.maxDisturbed * static_cast<double>(codebook_.planes()) &&
               e.reducedCost <= options_.maxReducedCost;
    }

  private:
    [[nodiscard]] double medianOfAll() const { return median({y_.data(), y_.data() + y_.size()}); }

    [[nodiscard]] std::vector<std::uint8_t> keep(const Eigen::VectorXd& residuals) const {
        std::vector<std::uint8_t> used(static_cast<std::size_t>(residuals.size()));
        for (std::size_t k = 0; k < used.size(); ++k)
            used[k] = std::abs(residuals[static_cast<Eigen::Index>(k)]) <= options_.outlier * sigma_ ? 1 : 0;
        return used;
    }

    [[nodiscard]] Explanation refine(const Eigen::MatrixXd& X, const Words& words,
                                     std::vector<std::uint8_t> used) const {
        Explanation e;
        e.words = words;
        const auto count = static_cast<Eigen::Index>(words.size());
        for (int iteration = 1; iteration <= options_.maxIterations; ++iteration) {
            const auto inverse = inverseNormalMatrix(X, used);
            if (!inverse)
                return e;
            Eigen::VectorXd moment = Eigen::VectorXd::Zero(X.cols());
            for (Eigen::Index k = 0; k < X.rows(); ++k) {
                if (used[static_cast<std::size_t>(k)] != 0)
                    moment += y_[k] * X.row(k).transpose();
            }
            const Eigen::VectorXd solution = *inverse * moment;
            const Eigen::VectorXd residuals = y_ - X * solution;
            std::vector<std::uint8_t> next = keep(residuals);
            const bool settled = next == used;
            used = std::move(next);
            if (!settled && iteration < options_.maxIterations)
                continue;
            e.amplitudes = solution.tail(count);
            if ((e.amplitudes.array() <= 0).any())
                return e;
            const Eigen::VectorXd sigmas = cameraSigma_ * inverse->diagonal().tail(count).cwiseSqrt();
            // Planes that come and go leave no fit: what was solved and what would be kept belong to different planes,
            // over which the words need not even be separable. Its cost is a cost all the same, which others must beat.
            e.significant = settled && (e.amplitudes.array() > options_.minSignificance * sigmas.array()).all();
            finish(e, residuals, used, X.cols());
            break;
        }
        return e;
    }

    void finish(Explanation& e, const Eigen::VectorXd& residuals, const std::vector<std::uint8_t>& used,
                Eigen::Index unknowns) const {
        double kept = 0;
        for (std::size_t k = 0; k < used.size(); ++k) {
            if (used[k] != 0)
                kept += std::pow(residuals[static_cast<Eigen::Index>(k)] / sigma_, 2);
            else
                ++e.disturbed;
        }
        e.cost = kept + options_.outlier * options_.outlier * static_cast<double>(e.disturbed);
        const auto freedom =
            static_cast<double>(used.size()) - static_cast<double>(e.disturbed) - static_cast<double>(unknowns);
        e.reducedCost = freedom > 0 ? kept / freedom : 0.0;
        e.used = used;
    }

    const Codebook& codebook_;
    Eigen::VectorXd y_;
    double cameraSigma_;
    double sigma_;  ///< with the uneven brightness of the LEDs
    const WordMatchOptions& options_;
};

// Words by how much of the series they explain on their own, brightest light first.
std::vector<std::pair<double, std::size_t>> rank(const Codebook& codebook, const Eigen::VectorXd& y,
                                                 std::size_t count) {
    const Eigen::VectorXd off = y - codebook.drift * (codebook.drift.transpose() * y);
    std::vector<std::pair<double, std::size_t>> scores;
    for (std::size_t u = 0; u < codebook.lit.size(); ++u) {
        if (codebook.representative[u] != u || !codebook.blinks(u))
            continue;
        double product = 0;
        for (const std::size_t plane : codebook.lit[u])
            product += off[static_cast<Eigen::Index>(plane)];
        if (product > 0)
            scores.emplace_back(product * product / codebook.energy[u], u);
    }
    const std::size_t kept = std::min(count, scores.size());
    std::partial_sort(scores.begin(), scores.begin() + static_cast<std::ptrdiff_t>(kept), scores.end(),
                      std::greater<>());
    scores.resize(kept);
    return scores;
}

}  // namespace

bool WordMatchOptions::validate() const {
    return outlier > 0 && minSignificance > 0 && minMargin > 0 && maxReducedCost > 0 && maxDisturbed >= 0 &&
           maxDisturbed < 0.5 && brightnessSpread >= 0 && brightnessSpread < 1 && colourSpread >= 0 &&
           colourSpread < 1 && shortlist >= 2 && maxIterations >= 1;
}

SeriesMatch matchSeries(const Codebook& codebook, std::span<const double> series, double sigma,
                        const WordMatchOptions& options) {
    if (series.size() != codebook.planes() || !(sigma > 0))
        throw std::logic_error("matchSeries: the series does not belong to this codebook");
    if (!options.validate())
        throw std::logic_error("matchSeries: options out of range");

    SeriesMatch match;
    const Eigen::VectorXd y =
        Eigen::Map<const Eigen::VectorXd>(series.data(), static_cast<Eigen::Index>(series.size()));
    const auto shortlist = static_cast<std::size_t>(options.shortlist);
    const auto scores = rank(codebook, y, shortlist);
    if (scores.empty())
        return match;
    Matcher matcher(codebook, y, sigma, options);
    matcher.raiseSigma(std::sqrt(scores[0].first / codebook.energy[scores[0].second]));

    std::vector<Explanation> tried;
    for (const auto& [score, word] : scores)
        tried.push_back(matcher.explain({word}));
    // A second word must earn its place.
    const auto price = [&](const Explanation& e) { return e.cost + (e.words.size() > 1 ? options.minMargin : 0.0); };
    const auto better = [&](const Explanation& a, const Explanation& b) {
        return std::tuple(!a.significant, price(a)) < std::tuple(!b.significant, price(b));
    };
    auto best = std::min_element(tried.begin(), tried.end(), better);
    const bool clean = best->disturbed == 0 && matcher.believable(*best);
    if (!clean) {
        // Two LEDs in one spot: the other one shows best in what the first leaves.
        Words pool;
        for (const auto& [score, word] : scores)
            pool.push_back(word);
        const std::size_t lead = scores[0].second;
        Eigen::VectorXd rest = y;
        for (const std::size_t plane : codebook.lit[lead])
            rest[static_cast<Eigen::Index>(plane)] -= std::sqrt(scores[0].first / codebook.energy[lead]);
        for (const auto& [score, word] : rank(codebook, rest, shortlist)) {
            if (std::find(pool.begin(), pool.end(), word) == pool.end())
                pool.push_back(word);
        }
        for (std::size_t i = 0; i < pool.size(); ++i) {
            for (std::size_t j = i + 1; j < pool.size(); ++j)
                tried.push_back(matcher.explain({pool[i], pool[j]}));
        }
        best = std::min_element(tried.begin(), tried.end(), better);
    }
    if (!best->significant)
        return match;

    std::vector<std::size_t> order(best->words.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return best->amplitudes[static_cast<Eigen::Index>(a)] > best->amplitudes[static_cast<Eigen::Index>(b)];
    });
    for (const std::size_t j : order) {
        match.words.push_back(best->words[j]);
        match.amplitudes.push_back(best->amplitudes[static_cast<Eigen::Index>(j)]);
    }
    match.used = best->used;
    match.margin = matcher.costOfDarkness() - best->cost;
    for (const Explanation& other : tried) {
        // A pair that contains the best word says the same about that word.
        const bool same = std::all_of(best->words.begin(), best->words.end(), [&](std::size_t word) {
            return std::find(other.words.begin(), other.words.end(), word) != other.words.end();
        });
        const double lead = price(other) - price(*best);
        if (same || !(lead < match.margin))
            continue;
        match.margin = lead;
        for (const std::size_t word : other.words) {
            if (std::find(best->words.begin(), best->words.end(), word) == best->words.end())
                match.runnerUp = word;
        }
    }
    // Asked once more with the brightest word first, as callers will: near a dependence the order can decide.
    const bool separable = amplitudeWeights(codebook, match.words, match.used).size() > 0;
    if (!separable || !matcher.believable(*best))
        match.verdict = SeriesVerdict::Unlike;
    else
        match.verdict = match.margin >= options.minMargin ? SeriesVerdict::Matched : SeriesVerdict::Ambiguous;
    return match;
}

}  // namespace skincal
