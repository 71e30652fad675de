#pragma once

#include <map>
#include <string>

#include "core/geometry/sentence.h"

namespace skincal {

/// What can go wrong in the field. Broken contracts throw std::logic_error instead.
enum class ErrorCode {
    TooFewPoses,       ///< fewer gravity poses than the estimate needs
    ParallelGravity,   ///< the poses differ only by a turn about gravity
    TooFewPoints,      ///< fewer LEDs than a pose needs
    DegeneratePoints,  ///< what was measured leaves a pose free: points on a line or at one place, or nothing at all
    NoConsensus,       ///< no pose explains enough of the points
    SizeMismatch,      ///< paired inputs of different length
    NotFinite,         ///< NaN or infinity among the measurements
    NotConverged,      ///< the solver stopped before it was done
    InvalidOptions,    ///< an option outside its range
    Cancelled,         ///< the caller asked to stop
    NothingPlaced,     ///< no module could be given a pose in the body
    NoDisplay,         ///< nothing to draw with
};

[[nodiscard]] Sentence sentenceOf(ErrorCode code);

/// A code and the numbers that belong to it ("needed" 6, "found" 4).
struct CalibrationError {
    ErrorCode code{};
    std::map<std::string, double> numbers{};

    /// "too few points (found 4, needed 6)"
    [[nodiscard]] Sentence sentence() const;
    /// The same in English, for logs and the command line.
    [[nodiscard]] std::string message() const { return sentence().english(); }
};

}  // namespace skincal
