#include "core/adjustment/selected_inverse.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace skincal {

void WideOrdering::operator()(const Eigen::SparseMatrix<double>& symmetric, PermutationType& permutation) const {
    // Of the values nothing is used.
    using Wide = Eigen::SparseMatrix<char, Eigen::ColMajor, std::int64_t>;
    Wide lower(symmetric.rows(), symmetric.cols());
    lower.reserve(symmetric.nonZeros() / 2 + symmetric.cols());
    for (Eigen::Index j = 0; j < symmetric.outerSize(); ++j) {
        lower.startVec(j);
        for (Eigen::SparseMatrix<double>::InnerIterator it(symmetric, j); it; ++it) {
            if (it.row() >= j)
                lower.insertBack(it.row(), j) = 1;
        }
    }
    lower.finalize();
    Eigen::AMDOrdering<std::int64_t>::PermutationType wide;
    Eigen::AMDOrdering<std::int64_t>()(lower.selfadjointView<Eigen::Lower>(), wide);
    permutation.resize(symmetric.cols());
    permutation.indices() = wide.indices().cast<int>();
}

SelectedInverse::SelectedInverse(const SparseCholesky& factor, const RunContext& context)
    : position_(factor.permutationP().indices()), lower_(factor.matrixL()) {
    const Eigen::Index n = lower_.cols();
    if (position_.size() == 0) {
        // Eigen leaves the permutation empty where it is the identity.
        position_.resize(n);
        for (int i = 0; i < n; ++i)
            position_[i] = i;
    }
    const int* first = lower_.outerIndexPtr();
    const int* row = lower_.innerIndexPtr();
    double* value = lower_.valuePtr();
    // From the last column to the first, L's values give way to Z's:
    //   Z_ij = (i == j) / L_jj^2 - sum_{k > j} Z_ik L_kj / L_jj
    std::vector<double> l;
    std::vector<double> sum;
    std::vector<int> slot(static_cast<std::size_t>(n), -1);
    constexpr Eigen::Index kColumnsBetweenPolls = 1024;
    for (Eigen::Index j = n - 1; j >= 0; --j) {
        if (j % kColumnsBetweenPolls == 0 && context.isCancelled())
            return;
        const int begin = first[j];
        const int end = first[j + 1];
        const double diagonal = value[begin];
        const auto below = static_cast<std::size_t>(end - begin - 1);
        l.assign(below, 0);
        sum.assign(below, 0);
        for (std::size_t a = 0; a < below; ++a) {
            l[a] = value[begin + 1 + static_cast<int>(a)] / diagonal;
            slot[static_cast<std::size_t>(row[begin + 1 + static_cast<int>(a)])] = static_cast<int>(a);
        }
        // Column k of Z holds Z_ik for i >= k; each entry serves the sums of both i and k.
        for (std::size_t a = 0; a < below; ++a) {
            const int k = row[begin + 1 + static_cast<int>(a)];
            for (int e = first[k]; e < first[k + 1]; ++e) {
                const int b = slot[static_cast<std::size_t>(row[e])];
                if (b < 0)
                    continue;
                sum[static_cast<std::size_t>(b)] += value[e] * l[a];
                if (row[e] != k)
                    sum[a] += value[e] * l[static_cast<std::size_t>(b)];
            }
        }
        double own = 1 / (diagonal * diagonal);
        for (std::size_t a = 0; a < below; ++a) {
            own += sum[a] * l[a];
            value[begin + 1 + static_cast<int>(a)] = -sum[a];
            slot[static_cast<std::size_t>(row[begin + 1 + static_cast<int>(a)])] = -1;
        }
        value[begin] = own;
    }
}

double SelectedInverse::operator()(Eigen::Index i, Eigen::Index j) const {
    int a = position_[i];
    int b = position_[j];
    if (a < b)
        std::swap(a, b);
    const int* begin = lower_.innerIndexPtr() + lower_.outerIndexPtr()[b];
    const int* end = lower_.innerIndexPtr() + lower_.outerIndexPtr()[b + 1];
    const int* found = std::lower_bound(begin, end, a);
    if (found == end || *found != a)
        throw std::out_of_range("SelectedInverse: the entry is not in the factor's pattern");
    return lower_.valuePtr()[found - lower_.innerIndexPtr()];
}

}  // namespace skincal
