#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "core/geometry/run_context.h"

namespace skincal {

/// Eigen's approximate minimum degree ordering in 64 bits: that of 32 adds up indices of neighbours, which overflows
/// from some 350,000 unknowns on and then writes where it should not.
class WideOrdering {
  public:
    using PermutationType = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
    /// @param symmetric  both triangles of it.
    void operator()(const Eigen::SparseMatrix<double>& symmetric, PermutationType& permutation) const;
};

using SparseCholesky = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, WideOrdering>;

/// Entries of the inverse of a sparse positive definite matrix where its Cholesky factor has entries, without the
/// others:
///   Z = A^-1,  Z_ij for all (i, j) in the pattern of L + L^T   (P A P^T = L L^T)
/// Every nonzero of A is in it, so a covariance between any two unknowns that some measurement ties together. Time is
/// of the order of the factorisation, memory of its factor. Ref: Takahashi, Fagan and Chin, 1973; Erisman and Tinney,
/// Comm. ACM 18, 1975.
class SelectedInverse {
  public:
    /// @param factor  factorised successfully.
    /// @param context  polled; what was cancelled has wrong entries.
    explicit SelectedInverse(const SparseCholesky& factor, const RunContext& context = {});

    /// Z_ij in the order of A. Throws std::out_of_range outside the pattern.
    [[nodiscard]] double operator()(Eigen::Index i, Eigen::Index j) const;

  private:
    Eigen::VectorXi position_;           ///< of each unknown of A in the factor's order
    Eigen::SparseMatrix<double> lower_;  ///< Z's lower triangle in the factor's order
};

}  // namespace skincal
