#include "core/geometry/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "core/geometry/random.h"

namespace skincal {
namespace {

TEST(Median, IsTheMiddleOfTheSortedValues) {
    Random random(1, "median");
    for (int i = 0; i < 1000; ++i) {
        std::vector<double> values(1 + random.index(40));
        // Whole numbers, so that many are equal.
        for (double& value : values)
            value = static_cast<double>(random.index(30)) - 15;
        const double found = median(values);
        std::sort(values.begin(), values.end());
        const std::size_t half = values.size() / 2;
        const double expected = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
        EXPECT_EQ(found, expected);
    }
}

TEST(Median, OfAnEvenCountIsTheMeanOfTheTwoInTheMiddle) {
    EXPECT_EQ(median({4, 1}), 2.5);
    EXPECT_EQ(median({100, 2, 3, -100}), 2.5);
    constexpr double kLargest = std::numeric_limits<double>::max();
    EXPECT_EQ(median({kLargest, kLargest}), kLargest);
}

TEST(Median, StaysAmongTheOthersWhateverLessThanHalfOfThemAre) {
    Random random(2, "outliers");
    for (int i = 0; i < 200; ++i) {
        const std::size_t good = 2 + random.index(20);
        std::vector<double> values;
        for (std::size_t k = 0; k < good; ++k)
            values.push_back(random.uniform(3, 4));
        for (std::size_t k = 0; k + 1 < good; ++k)
            values.push_back(1e9 * random.normal());
        const double found = median(values);
        EXPECT_GE(found, 3);
        EXPECT_LE(found, 4);
    }
}

TEST(Median, OfNothingIsABrokenContract) {
    EXPECT_THROW((void)median({}), std::logic_error);
}

}  // namespace
}  // namespace skincal
