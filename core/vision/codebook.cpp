#include "core/vision/codebook.h"

#include <Eigen/Dense>
#include <algorithm>
#include <map>

namespace skincal {

Codebook makeCodebook(const LitWords& words) {
    Codebook book;
    book.coloured = words.coloured;
    book.lit = words.lit;
    const auto planes = static_cast<Eigen::Index>(words.planes.size());
    const Eigen::Index channels = words.coloured ? 3 : 1;
    const std::size_t frames = words.planes.size() / words.planesPerFrame();
    const bool slope = frames >= 8;
    book.drift = Eigen::MatrixXd::Zero(planes, channels + (slope ? 1 : 0));
    for (Eigen::Index k = 0; k < planes; ++k) {
        const Plane& plane = words.planes[static_cast<std::size_t>(k)];
        const auto channel = static_cast<std::size_t>(std::max(plane.channel, 0));
        book.channelOf.push_back(channel);
        book.drift(k, static_cast<Eigen::Index>(channel)) = 1;
        if (slope)
            book.drift(k, channels) = static_cast<double>(plane.frame) - 0.5 * static_cast<double>(frames - 1);
    }
    // Centred time is orthogonal to the constants already.
    for (Eigen::Index j = 0; j < book.drift.cols(); ++j) {
        if (const double norm = book.drift.col(j).norm(); norm > 0)
            book.drift.col(j) /= norm;
    }
    std::map<std::vector<std::size_t>, std::size_t> first;
    for (std::size_t u = 0; u < book.lit.size(); ++u) {
        Eigen::VectorXd projection = Eigen::VectorXd::Zero(book.drift.cols());
        for (const std::size_t plane : book.lit[u])
            projection += book.drift.row(static_cast<Eigen::Index>(plane)).transpose();
        book.energy.push_back(static_cast<double>(book.lit[u].size()) - projection.squaredNorm());
        book.representative.push_back(first.emplace(book.lit[u], u).first->second);
    }
    return book;
}

Ambient centred(const Ambient& ambient, std::span<const std::uint8_t> used) {
    Ambient result = ambient;
    double sum = 0;
    double count = 0;
    for (Eigen::Index k = 0; k < ambient.light.size(); ++k) {
        if (used[static_cast<std::size_t>(k)] != 0) {
            sum += ambient.light[k];
            ++count;
        }
    }
    if (count > 0)
        result.light.array() -= sum / count;
    return result;
}

Eigen::MatrixXd designMatrix(const Codebook& codebook, std::span<const std::size_t> words, const Ambient& ambient) {
    const Eigen::Index drifts = codebook.drift.cols();
    const Eigen::Index first = drifts + (ambient.light.size() > 0 ? 1 : 0);
    Eigen::MatrixXd X(codebook.drift.rows(), first + static_cast<Eigen::Index>(words.size()));
    X.leftCols(drifts) = codebook.drift;
    if (first > drifts)
        X.col(drifts) = ambient.light;
    X.rightCols(static_cast<Eigen::Index>(words.size())).setZero();
    for (std::size_t j = 0; j < words.size(); ++j) {
        for (const std::size_t plane : codebook.lit[words[j]])
            X(static_cast<Eigen::Index>(plane), first + static_cast<Eigen::Index>(j)) = 1;
    }
    return X;
}

std::optional<Eigen::MatrixXd> inverseNormalMatrix(const Eigen::MatrixXd& X, std::span<const std::uint8_t> used,
                                                   const Codebook& codebook, const Ambient& ambient) {
    Eigen::MatrixXd there = X;
    for (Eigen::Index k = 0; k < X.rows(); ++k) {
        if (used[static_cast<std::size_t>(k)] == 0)
            there.row(k).setZero();
    }
    // So small that Eigen's way with large matrices takes longer.
    Eigen::MatrixXd N = there.transpose().lazyProduct(there);
    if (ambient.light.size() > 0)
        N(codebook.drift.cols(), codebook.drift.cols()) += ambient.ridge;
    const Eigen::LDLT<Eigen::MatrixXd, Eigen::Lower> factor(N);
    // The drift columns are normalised, so small numbers here mean dependence, not scale.
    if (factor.info() != Eigen::Success || factor.vectorD().minCoeff() < 1e-3)
        return std::nullopt;
    return factor.solve(Eigen::MatrixXd::Identity(N.rows(), N.cols()));
}

Eigen::MatrixXd amplitudeWeights(const Codebook& codebook, std::span<const std::size_t> words,
                                 std::span<const std::uint8_t> used, const Ambient& ambient) {
    const Eigen::MatrixXd X = designMatrix(codebook, words, centred(ambient, used));
    const auto inverse = inverseNormalMatrix(X, used, codebook, ambient);
    return inverse ? amplitudeWeights(X, *inverse, words.size(), used) : Eigen::MatrixXd();
}

Eigen::MatrixXd amplitudeWeights(const Eigen::MatrixXd& X, const Eigen::MatrixXd& inverse, std::size_t words,
                                 std::span<const std::uint8_t> used) {
    Eigen::MatrixXd weights = inverse.bottomRows(static_cast<Eigen::Index>(words)) * X.transpose();
    for (Eigen::Index k = 0; k < weights.cols(); ++k) {
        if (used[static_cast<std::size_t>(k)] == 0)
            weights.col(k).setZero();
    }
    return weights;
}

Eigen::MatrixXd explainedSpace(const Codebook& codebook, std::span<const std::size_t> words,
                               std::span<const std::uint8_t> used, const Ambient& ambient) {
    Eigen::MatrixXd X = designMatrix(codebook, words, centred(ambient, used));
    for (Eigen::Index k = 0; k < X.rows(); ++k) {
        if (used[static_cast<std::size_t>(k)] == 0)
            X.row(k).setZero();
    }
    // By the Cholesky factor of the normal matrix, which is quick, but where that is nearly singular.
    constexpr double kNearlySingular = 1e-6;
    const Eigen::MatrixXd N = X.transpose().lazyProduct(X);
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(N);
    const Eigen::MatrixXd& L = factor.matrixLLT();
    if (factor.info() == Eigen::Success &&
        (L.diagonal().array().square() > kNearlySingular * N.diagonal().array()).all()) {
        factor.matrixU().solveInPlace<Eigen::OnTheRight>(X);
        return X;
    }
    const Eigen::HouseholderQR<Eigen::MatrixXd> orthogonal(X);
    return orthogonal.householderQ() * Eigen::MatrixXd::Identity(X.rows(), X.cols());
}

}  // namespace skincal
