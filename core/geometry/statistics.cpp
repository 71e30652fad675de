#include "core/geometry/statistics.h"

#include <algorithm>
#include <stdexcept>

namespace skincal {

double median(std::vector<double> values) {
    if (values.empty())
        throw std::logic_error("median: of no values");
    const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), upper, values.end());
    if (values.size() % 2 == 1)
        return *upper;
    // What nth_element leaves in front is no larger, so that its largest is the other one in the middle.
    const double lower = *std::max_element(values.begin(), upper);
    // Not half their sum, which can overflow.
    return 0.5 * lower + 0.5 * *upper;
}

}  // namespace skincal
