#include "core/geometry/error.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace skincal {
namespace {

TEST(Error, EveryCodeHasItsOwnName) {
    std::set<std::string> names;
    const int last = static_cast<int>(ErrorCode::NoDisplay);
    for (int code = 0; code <= last; ++code) {
        const std::string text = sentenceOf(static_cast<ErrorCode>(code)).english();
        EXPECT_FALSE(text.empty()) << code;
        EXPECT_TRUE(names.insert(text).second) << text;
    }
}

TEST(Error, UnknownCodeIsABrokenContract) {
    EXPECT_THROW((void)sentenceOf(static_cast<ErrorCode>(1000)), std::logic_error);
}

TEST(Error, DegeneratePointsSaysWhatIsTrueOfEveryUse) {
    // It stands for LEDs on a line, but also for a module of which nothing was measured at all.
    const std::string text = CalibrationError{ErrorCode::DegeneratePoints}.message();
    EXPECT_NE(text.find("undetermined"), std::string::npos) << text;
    EXPECT_EQ(text.find("lie on a line"), std::string::npos) << text;
}

TEST(Error, MessageWithoutNumbersIsTheName) {
    EXPECT_EQ((CalibrationError{ErrorCode::Cancelled}.message()), "cancelled");
}

TEST(Error, MessageGivesTheNumbersInOrderOfTheirNames) {
    EXPECT_EQ((CalibrationError{ErrorCode::TooFewPoints, {{"needed", 6}}}.message()), "too few points (needed 6)");
    EXPECT_EQ((CalibrationError{ErrorCode::TooFewPoints, {{"needed", 6}, {"found", 4}}}.message()),
              "too few points (found 4, needed 6)");
    EXPECT_EQ((CalibrationError{ErrorCode::NotConverged, {{"cost", 0.125}}}.message()),
              "the solver did not converge (cost 0.125)");
}

}  // namespace
}  // namespace skincal
