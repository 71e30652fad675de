#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace skincal {

/// What a scan has to put up with, and what its strength counts.
enum class Disturbance {
    None,        ///< strength is nothing
    Ambient,     ///< mean grey level of the room, texture in proportion; from 255 on it is overexposed
    Reflection,  ///< share of each LED's light that a mirror below the body returns
    Hidden,      ///< the same where some are out of the camera's sight, and the mirror shows them
    Screen,      ///< grey levels between the cells of a picture in the room that changes with every frame
    Mains50,     ///< grey levels of a lamp at 100 Hz
    Mains60,     ///< grey levels of a lamp at 120 Hz
    Sun,         ///< share by which the room grows brighter through the scan, with a cloud in between
    Person,      ///< somebody walks through: 1 yes
    Exposure,    ///< share by which the camera steps its exposure down and up again
    Bump,        ///< px by which the camera is knocked half-way
    Focus,       ///< px of the lens's blur, the standard deviation of a point's light; 0.9 elsewhere
    Crowding,    ///< px between the two LEDs that are nearest to each other
};
[[nodiscard]] std::string_view name(Disturbance disturbance);
/// Whether LEDs show twice, so that what the picture leaves open is asked of the body.
[[nodiscard]] bool hasMirror(Disturbance disturbance);
[[nodiscard]] std::optional<Disturbance> findDisturbance(std::string_view name);
/// Strengths that make a curve of it, up to more than any scan can bear.
[[nodiscard]] const std::vector<double>& strengthsOf(Disturbance disturbance);

enum class ScanMethod {
    Coded,        ///< codedScan and decodeView, and FurtherLooks for what they leave undecided
    CodedOnce,    ///< a single look
    OneAtATime,   ///< the paper's scan, with decodeView
    PaperSingle,  ///< the paper's scan and its detector
};
[[nodiscard]] std::string_view name(ScanMethod method);

struct ScanCase {
    Disturbance disturbance = Disturbance::None;
    double strength = 0;
    std::size_t modules = 55;
    double distance = 0.8;  ///< m
    ScanMethod method = ScanMethod::Coded;
};

/// Every disturbance at each of its strengths by each method with 55 modules; coded scans of the sizes and at the
/// distances that the project promises, and again with every disturbance half-way up its curve.
[[nodiscard]] std::vector<ScanCase> allScanCases();

}  // namespace skincal
