#include "core/vision/word_match.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "core/vision/series_fit.h"

namespace skincal {
namespace {

using Words = std::vector<std::size_t>;

bool contains(const Words& words, std::size_t word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

/// Off its mean over the used planes, zero in the others.
Eigen::VectorXd offMean(const Eigen::VectorXd& y, const std::vector<std::uint8_t>& used) {
    double sum = 0;
    double count = 0;
    for (std::size_t k = 0; k < used.size(); ++k) {
        sum += used[k] != 0 ? y[static_cast<Eigen::Index>(k)] : 0;
        count += used[k] != 0 ? 1 : 0;
    }
    Eigen::VectorXd off = Eigen::VectorXd::Zero(y.size());
    for (std::size_t k = 0; k < used.size(); ++k) {
        if (used[k] != 0)
            off[static_cast<Eigen::Index>(k)] = y[static_cast<Eigen::Index>(k)] - sum / count;
    }
    return off;
}

/// What of a series remains where the surroundings do what the explanation says, in the planes that it uses.
Eigen::VectorXd visibleRest(const Eigen::VectorXd& y, const Ambient& ambient, const Explanation& e) {
    const Ambient there = centred(ambient, e.used);
    return offMean(there.light.size() > 0 ? Eigen::VectorXd(y - e.ambient * there.light) : y, e.used);
}

/// Explanations of one series against each other.
class Contest {
  public:
    Contest(const Codebook& codebook, const WordMatchOptions& options, SeriesFit& fit)
        : fit_(fit),
          // A second word must earn its place, against all others that would have done.
          second_(options.minMargin + 2 * std::log(static_cast<double>(codebook.lit.size()))) {}

    void enterLeaders(std::span<const RankedWord> ranked);
    void enterNew(std::span<const RankedWord> ranked);
    /// Pairs of which one at least is among the likeliest few.
    void enterPairs(const Words& pool);
    [[nodiscard]] const Explanation& best() const {
        return *std::min_element(tried_.begin(), tried_.end(), [this](const Explanation& a, const Explanation& b) {
            return std::tuple(!a.significant, price(a)) < std::tuple(!b.significant, price(b));
        });
    }
    /// Of the best over no light at all and over any other, and a word that is in what is nearest to it.
    [[nodiscard]] std::pair<double, std::optional<std::size_t>> lead();

  private:
    [[nodiscard]] double price(const Explanation& e) const { return e.cost + (e.words.size() > 1 ? second_ : 0.0); }

    SeriesFit& fit_;
    double second_;
    std::vector<Explanation> tried_;
};

void Contest::enterLeaders(std::span<const RankedWord> ranked) {
    // Where the first leaves nothing to explain, only the next few could have been meant. Nor has anything hidden the
    // LED then, and which planes speak against the others is plain.
    constexpr std::size_t kRivals = 3;
    for (const RankedWord& word : ranked) {
        const bool isDone = !tried_.empty() && tried_.front().isClean();
        if (isDone && tried_.size() > kRivals)
            break;
        tried_.push_back(isDone ? fit_.explainPlainly({word.word}) : fit_.explain({word.word}));
    }
}

void Contest::enterNew(std::span<const RankedWord> ranked) {
    for (const RankedWord& word : ranked) {
        const bool isKnown = std::any_of(tried_.begin(), tried_.end(),
                                         [&](const Explanation& e) { return e.words == Words{word.word}; });
        if (!isKnown)
            tried_.push_back(fit_.explain({word.word}));
    }
}

void Contest::enterPairs(const Words& pool) {
    constexpr std::size_t kLikely = 3;
    for (std::size_t i = 0; i < std::min(kLikely, pool.size()); ++i) {
        for (std::size_t j = i + 1; j < pool.size(); ++j)
            tried_.push_back(fit_.explain({pool[i], pool[j]}));
    }
}

std::pair<double, std::optional<std::size_t>> Contest::lead() {
    const Explanation& first = best();
    double margin = fit_.costOfDarkness(first.used) - price(first);
    std::optional<std::size_t> runnerUp;
    for (const Explanation& other : tried_) {
        // A pair that contains the best word says the same about that word.
        const bool same = std::all_of(first.words.begin(), first.words.end(),
                                      [&](std::size_t word) { return contains(other.words, word); });
        const double ahead = price(other) - price(first);
        if (same || !(ahead < margin))
            continue;
        margin = ahead;
        for (const std::size_t word : other.words) {
            if (!contains(first.words, word))
                runnerUp = word;
        }
    }
    return {margin, runnerUp};
}

/// The words with their amplitudes, brightest first.
SeriesMatch matchOf(const Explanation& e) {
    SeriesMatch match;
    std::vector<std::size_t> order(e.words.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto amplitude = [&](std::size_t j) { return e.amplitudes[static_cast<Eigen::Index>(j)]; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return amplitude(a) > amplitude(b); });
    for (const std::size_t j : order) {
        match.words.push_back(e.words[j]);
        match.amplitudes.push_back(amplitude(j));
    }
    match.used = e.used;
    match.met = e.met;
    match.drift = e.drift;
    match.ambient = e.ambient;
    return match;
}

}  // namespace

bool WordMatchOptions::validate() const {
    return outlier > 0 && hiddenCost > 0 && hiddenCost <= outlier && minSignificance > 0 && minMargin > 0 &&
           maxReducedCost > 0 && minExplained > 0 && minExplained <= minExplainedByTwo && minExplainedByTwo < 1 &&
           maxDisturbed >= 0 && maxDisturbed <= maxHidden && maxHidden < 1 && brightnessSpread >= 0 &&
           brightnessSpread < 1 && colourSpread >= 0 && colourSpread < 1 && shortlist >= 2 && maxIterations >= 1;
}

WordMatcher::WordMatcher(const Codebook& codebook, const WordMatchOptions& options)
    : codebook_(codebook), options_(options), ranking_(codebook) {
    if (!options.validate())
        throw std::logic_error("WordMatcher: options out of range");
}

SeriesMatch WordMatcher::match(std::span<const double> series, double sigma, const Ambient& ambient,
                               std::span<const std::uint8_t> atLeast) const {
    if (series.size() != codebook_.planes() || !(sigma > 0) || (!atLeast.empty() && atLeast.size() != series.size()) ||
        (ambient.light.size() > 0 && ambient.light.size() != codebook_.drift.rows()))
        throw std::logic_error("WordMatcher: the series does not belong to this codebook");

    const Eigen::VectorXd y =
        Eigen::Map<const Eigen::VectorXd>(series.data(), static_cast<Eigen::Index>(series.size()));
    const auto shortlist = static_cast<std::size_t>(options_.shortlist);
    const std::vector<RankedWord> ranked = ranking_.best(offDrift(codebook_, ambient, y), shortlist);
    if (ranked.empty())
        return {};
    const RankedWord& lead = ranked.front();
    const double strength = std::sqrt(lead.score / codebook_.energy[lead.word]);
    SeriesFit fit(codebook_, {y, sigma, strength, atLeast}, ambient, options_);
    Contest contest(codebook_, options_, fit);
    contest.enterLeaders(ranked);
    // What hides an LED for long also hides its word from a ranking over all planes: once more over those that remain.
    if (contest.best().significant && contest.best().disturbed > 0)
        contest.enterNew(ranking_.best(visibleRest(y, ambient, contest.best()), shortlist));
    if (contest.best().disturbed > 0 || !fit.believable(contest.best())) {
        // Two LEDs in one spot: the other one shows best in what the first leaves.
        Words pool;
        for (const RankedWord& word : ranked)
            pool.push_back(word.word);
        Eigen::VectorXd rest = y;
        for (const std::size_t plane : codebook_.lit[lead.word])
            rest[static_cast<Eigen::Index>(plane)] -= strength;
        for (const RankedWord& word : ranking_.best(offDrift(codebook_, ambient, rest), shortlist)) {
            if (!contains(pool, word.word))
                pool.push_back(word.word);
        }
        contest.enterPairs(pool);
    }
    const Explanation& best = contest.best();
    if (!best.significant)
        return {};
    SeriesMatch match = matchOf(best);
    std::tie(match.margin, match.runnerUp) = contest.lead();
    // Asked once more with the brightest word first, as callers will: near a dependence the order can decide.
    const bool separable = amplitudeWeights(codebook_, match.words, match.used, ambient).size() > 0;
    if (!separable || !fit.believable(best))
        match.verdict = SeriesVerdict::Unlike;
    else
        match.verdict = match.margin >= options_.minMargin ? SeriesVerdict::Matched : SeriesVerdict::Ambiguous;
    return match;
}

}  // namespace skincal
