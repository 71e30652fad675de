#include "core/geometry/error.h"

#include <fmt/format.h>

#include <stdexcept>

namespace skincal {

Sentence sentenceOf(ErrorCode code) {
    switch (code) {
        case ErrorCode::TooFewPoses:
            return Sentence::saying("too few gravity poses");
        case ErrorCode::ParallelGravity:
            return Sentence::saying("gravity has the same direction in all poses");
        case ErrorCode::TooFewPoints:
            return Sentence::saying("too few points");
        case ErrorCode::DegeneratePoints:
            return Sentence::saying("the measurements leave a pose undetermined, as points on a line do");
        case ErrorCode::NoConsensus:
            return Sentence::saying("no pose explains enough of the points");
        case ErrorCode::SizeMismatch:
            return Sentence::saying("paired inputs differ in length");
        case ErrorCode::NotFinite:
            return Sentence::saying("a measurement is not a finite number");
        case ErrorCode::NotConverged:
            return Sentence::saying("the solver did not converge");
        case ErrorCode::InvalidOptions:
            return Sentence::saying("an option is outside its range");
        case ErrorCode::Cancelled:
            return Sentence::saying("cancelled");
        case ErrorCode::NothingPlaced:
            return Sentence::saying("no module could be placed on the body");
        case ErrorCode::NoDisplay:
            return Sentence::saying("no display to draw with");
    }
    throw std::logic_error("unknown ErrorCode");
}

namespace {

Sentence inWords(const std::string& what, double number) {
    if (what == "found")
        return Sentence::saying("found {:g}", number);
    if (what == "needed")
        return Sentence::saying("needed {:g}", number);
    if (what == "inliers")
        return Sentence::saying("inliers {:g}", number);
    if (what == "iterations")
        return Sentence::saying("iterations {:g}", number);
    if (what == "pose")
        return Sentence::saying("pose {:g}", number);
    // Symbols, as of frames, are the same in all languages.
    return Sentence::verbatim(fmt::format("{} {:g}", what, number));
}

}  // namespace

Sentence CalibrationError::sentence() const {
    Sentence figures;
    for (const auto& [what, number] : numbers)
        figures = figures.empty() ? inWords(what, number) : Sentence::saying("{}, {}", figures, inWords(what, number));
    return figures.empty() ? sentenceOf(code) : Sentence::saying("{} ({})", sentenceOf(code), figures);
}

}  // namespace skincal
