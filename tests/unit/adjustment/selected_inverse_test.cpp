#include "core/adjustment/selected_inverse.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/geometry/random.h"

namespace skincal {
namespace {

TEST(SelectedInverse, HasTheEntriesOfTheDenseOne) {
    Random random(12, "selected");
    for (int round = 0; round < 20; ++round) {
        const auto n = static_cast<Eigen::Index>(2 + random.index(40));
        Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(n, n);
        for (Eigen::Index k = 0; k < 3 * n; ++k) {
            const auto i = static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(n)));
            const auto j = static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(n)));
            Eigen::VectorXd v = Eigen::VectorXd::Zero(n);
            v[i] = random.normal();
            v[j] += random.normal();
            dense += v * v.transpose();
        }
        const Eigen::SparseMatrix<double> A = dense.sparseView();
        const SparseCholesky factor(A);
        const SelectedInverse inverse(factor);
        const Eigen::MatrixXd expected = dense.inverse();
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index j = 0; j < n; ++j) {
                if (dense(i, j) != 0) {
                    EXPECT_NEAR(inverse(i, j), expected(i, j), 1e-10 * expected.norm());
                }
            }
        }
    }
    const SparseCholesky two(Eigen::MatrixXd(Eigen::Vector2d(4, 9).asDiagonal()).sparseView());
    EXPECT_THROW((void)SelectedInverse(two)(0, 1), std::out_of_range);
    EXPECT_DOUBLE_EQ(SelectedInverse(two)(1, 1), 1.0 / 9);
}

}  // namespace
}  // namespace skincal
