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

/// Pairs of which one at least is among the likeliest few.
void explainPairs(const SeriesFit& fit, const Words& pool, std::vector<Explanation>& tried) {
    constexpr std::size_t kLikely = 3;
    for (std::size_t i = 0; i < std::min(kLikely, pool.size()); ++i) {
        for (std::size_t j = i + 1; j < pool.size(); ++j)
            tried.push_back(fit.explain({pool[i], pool[j]}));
    }
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

SeriesMatch WordMatcher::match(std::span<const double> series, double sigma, const Ambient& ambient) const {
    if (series.size() != codebook_.planes() || !(sigma > 0) ||
        (ambient.light.size() > 0 && ambient.light.size() != codebook_.drift.rows()))
        throw std::logic_error("WordMatcher: the series does not belong to this codebook");

    SeriesMatch match;
    const Eigen::VectorXd y =
        Eigen::Map<const Eigen::VectorXd>(series.data(), static_cast<Eigen::Index>(series.size()));
    const auto shortlist = static_cast<std::size_t>(options_.shortlist);
    const Eigen::VectorXd off = offDrift(codebook_, ambient, y);
    const std::vector<RankedWord> ranked = ranking_.best(off, shortlist);
    if (ranked.empty())
        return match;
    const RankedWord& lead = ranked.front();
    const double strength = std::sqrt(lead.score / codebook_.energy[lead.word]);
    const SeriesFit fit(codebook_, y, sigma, strength, ambient, options_);

    std::vector<Explanation> tried;
    // Where the first leaves nothing to explain, only the next few could have been meant.
    constexpr std::size_t kRivals = 3;
    for (const RankedWord& word : ranked) {
        if (tried.size() > kRivals && tried.front().isClean())
            break;
        tried.push_back(fit.explain({word.word}));
    }
    // A second word must earn its place, against all others that would have done.
    const double second = options_.minMargin + 2 * std::log(static_cast<double>(codebook_.lit.size()));
    const auto price = [&](const Explanation& e) { return e.cost + (e.words.size() > 1 ? second : 0.0); };
    const auto better = [&](const Explanation& a, const Explanation& b) {
        return std::tuple(!a.significant, price(a)) < std::tuple(!b.significant, price(b));
    };
    auto best = std::min_element(tried.begin(), tried.end(), better);
    const auto isKnown = [&](std::size_t word) {
        return std::any_of(tried.begin(), tried.end(), [&](const Explanation& e) { return e.words == Words{word}; });
    };
    // What hides an LED for long also hides its word from a ranking over all planes: once more over those that remain.
    if (best->significant && best->disturbed > 0) {
        const std::vector<std::uint8_t> used = best->used;
        const Ambient there = centred(ambient, used);
        Eigen::VectorXd rest = y;
        rest -= there.light.size() > 0 ? Eigen::VectorXd(best->ambient * there.light) : Eigen::VectorXd::Zero(y.size());
        for (const RankedWord& word : ranking_.best(offMean(rest, used), shortlist)) {
            if (!isKnown(word.word))
                tried.push_back(fit.explain({word.word}));
        }
        best = std::min_element(tried.begin(), tried.end(), better);
    }
    if (best->disturbed > 0 || !fit.believable(*best)) {
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
        explainPairs(fit, pool, tried);
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
    match.drift = best->drift;
    match.ambient = best->ambient;
    match.margin = fit.costOfDarkness(best->used) - price(*best);
    for (const Explanation& other : tried) {
        // A pair that contains the best word says the same about that word.
        const bool same = std::all_of(best->words.begin(), best->words.end(),
                                      [&](std::size_t word) { return contains(other.words, word); });
        const double ahead = price(other) - price(*best);
        if (same || !(ahead < match.margin))
            continue;
        match.margin = ahead;
        for (const std::size_t word : other.words) {
            if (!contains(best->words, word))
                match.runnerUp = word;
        }
    }
    // Asked once more with the brightest word first, as callers will: near a dependence the order can decide.
    const bool separable = amplitudeWeights(codebook_, match.words, match.used, ambient).size() > 0;
    if (!separable || !fit.believable(*best))
        match.verdict = SeriesVerdict::Unlike;
    else
        match.verdict = match.margin >= options_.minMargin ? SeriesVerdict::Matched : SeriesVerdict::Ambiguous;
    return match;
}

}  // namespace skincal
