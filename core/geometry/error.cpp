#include "core/geometry/error.h"

#include <fmt/format.h>

#include <stdexcept>

namespace skincal {

std::string_view name(ErrorCode code) {
    switch (code) {
        case ErrorCode::TooFewPoses:
            return "too few gravity poses";
        case ErrorCode::ParallelGravity:
            return "gravity has the same direction in all poses";
        case ErrorCode::TooFewPoints:
            return "too few points";
        case ErrorCode::DegeneratePoints:
            return "the measurements leave a pose undetermined, as points on a line do";
        case ErrorCode::NoConsensus:
            return "no pose explains enough of the points";
        case ErrorCode::SizeMismatch:
            return "paired inputs differ in length";
        case ErrorCode::NotFinite:
            return "a measurement is not a finite number";
        case ErrorCode::NotConverged:
            return "the solver did not converge";
        case ErrorCode::InvalidOptions:
            return "an option is outside its range";
        case ErrorCode::Cancelled:
            return "cancelled";
        case ErrorCode::NothingPlaced:
            return "no module could be placed on the body";
        case ErrorCode::NoDisplay:
            return "no display to draw with";
    }
    throw std::logic_error("unknown ErrorCode");
}

std::string CalibrationError::message() const {
    std::string text{name(code)};
    std::string separator = " (";
    for (const auto& [key, number] : numbers) {
        text += fmt::format("{}{} {:g}", separator, key, number);
        separator = ", ";
    }
    return numbers.empty() ? text : text + ")";
}

}  // namespace skincal
