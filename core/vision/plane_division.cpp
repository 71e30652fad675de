#include "core/vision/plane_division.h"

#include <algorithm>
#include <limits>

namespace skincal {

double PlaneDivision::divide(const Eigen::VectorXd& residuals, double sigma, std::vector<std::uint8_t>& used) {
    enum State : std::uint8_t { kUsed, kFirst, kSecond, kLater };
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const double enter = options_.outlier * options_.outlier;
    const double stay = options_.hiddenCost * options_.hiddenCost;
    // Where each plane is worth less than the cheapest disturbed one, and that is nearly everywhere, none is.
    const double scale = 1 / (sigma * sigma);
    if (scale * residuals.cwiseAbs2().maxCoeff() <= stay) {
        std::fill(used.begin(), used.end(), std::uint8_t{1});
        return scale * residuals.squaredNorm();
    }
    double isUsed = 0;
    double first = kNever;
    double second = kNever;
    double later = kNever;
    std::uint8_t cheapest = kUsed;
    const auto findCheapest = [&] {
        const double disturbed = std::min(first, std::min(second, later));
        cheapest = disturbed == first ? kFirst : disturbed == second ? kSecond : kLater;
        cheapest = disturbed < isUsed ? cheapest : std::uint8_t{kUsed};
        return std::min(isUsed, disturbed);
    };
    // Of a used plane which state was before it, and of a later one; the others leave no choice.
    from_.resize(used.size());
    for (std::size_t k = 0; k < used.size(); ++k) {
        const double residual = residuals[static_cast<Eigen::Index>(k)];
        const double least = findCheapest();
        from_[k] = {cheapest, second < later ? std::uint8_t{kSecond} : std::uint8_t{kLater}};
        later = std::min(second, later) + stay;
        second = first + enter;
        first = isUsed + enter;
        isUsed = least + scale * residual * residual;
    }
    const double least = findCheapest();
    std::uint8_t state = cheapest;
    for (std::size_t k = used.size(); k-- > 0;) {
        used[k] = state == kUsed ? 1 : 0;
        state = state == kUsed ? from_[k][0] : state == kLater ? from_[k][1] : static_cast<std::uint8_t>(state - 1);
    }
    return least;
}

double PlaneDivision::costOfNothing(std::size_t count) const {
    const auto planes = static_cast<double>(count);
    return std::min(planes, 2.0) * options_.outlier * options_.outlier +
           std::max(0.0, planes - 2) * options_.hiddenCost * options_.hiddenCost;
}

}  // namespace skincal
