#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/run_context.h"
#include "core/simulation/world.h"

namespace skincal {

/// What a scan has to put up with, and what its strength counts.
enum class Disturbance {
    None,        ///< strength is nothing
    Ambient,     ///< mean grey level of the room, texture in proportion; from 255 on it is overexposed
    Reflection,  ///< share of each LED's light that a mirror beside the body returns
    Screen,      ///< grey levels between the cells of a picture in the room that changes with every frame
    Mains50,     ///< grey levels of a lamp at 100 Hz
    Mains60,     ///< grey levels of a lamp at 120 Hz
    Sun,         ///< share by which the room grows brighter through the scan, with a cloud in between
    Person,      ///< somebody walks through: 1 yes
    Exposure,    ///< share by which the camera steps its exposure down and up again
    Bump,        ///< px by which the camera is knocked half-way
    Crowding,    ///< px between neighbouring LEDs
};
[[nodiscard]] std::string_view name(Disturbance disturbance);
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

/// What came out, of one view or the sum over many.
struct ScanScore {
    std::size_t views = 0;
    std::size_t frames = 0;
    std::size_t visible = 0;   ///< modules that face the camera, in the picture and not hidden by the body
    std::size_t found = 0;     ///< of these, where they are
    std::size_t choices = 0;   ///< of these, not found, but among the spots that were handed on to choose from
    std::size_t wrong = 0;     ///< modules, visible or not, that were reported more than `kElsewhere_px` off, or
                               ///< nearer to another module's LED than to their own
    double squaredError = 0;   ///< px^2, sum over found and both axes
    double squaredSigmas = 0;  ///< the same in units of the reported standard deviation
    std::size_t sharp = 0;     ///< of the found, those that are not clipped and that centreBounds has a bound of
    double squaredBounds = 0;  ///< of these, squared error over the squared bound, sum over both axes
    double sharpSigmas = 0;    ///< of these, the part of squaredSigmas
    double seconds = 0;        ///< that decoding took after the last picture

    static constexpr double kElsewhere_px = 3;
    [[nodiscard]] double foundShare() const;
    [[nodiscard]] double rms_px() const;     ///< per axis
    [[nodiscard]] double rmsSigmas() const;  ///< per axis; one where the standard deviations are right
    [[nodiscard]] double rmsBounds() const;  ///< per axis; one where no unbiased estimate could be better
    void add(const ScanScore& other);
};

/// A skin that fills the picture of its camera: patches of up to 50 modules on a relief, smaller modules where so many
/// would not fit. The world has a single view; it is called 1, in which a bump of the camera happens.
[[nodiscard]] World scanWorld(const ScanCase& what, std::uint64_t seed);

/// Scans view 1 of scanWorld in pictures and decodes them. Cancelled: no views.
[[nodiscard]] ScanScore scoreScan(const ScanCase& what, std::uint64_t seed, const RunContext& context = {});
/// The same of a world of scanWorld in which something was changed.
[[nodiscard]] ScanScore scoreScan(World world, const ScanCase& what, const RunContext& context = {});

struct ScanStudyOptions {
    std::vector<ScanCase> cases;
    int seeds = 10;
    std::uint64_t firstSeed = 1;

    [[nodiscard]] bool validate() const;
};

/// Every disturbance at each of its strengths by each method with 55 modules; coded scans of the sizes and at the
/// distances that the project promises, and again with every disturbance half-way up its curve.
[[nodiscard]] std::vector<ScanCase> allScanCases();

struct ScanStudyRow {
    ScanCase what;
    ScanScore score;
};
struct ScanStudy {
    ScanStudyOptions options;
    std::vector<ScanStudyRow> rows;
    bool cancelled = false;
};

/// Everything but the seconds is the same whenever it runs. Throws std::logic_error where the options are out of range.
[[nodiscard]] ScanStudy runScanStudy(const ScanStudyOptions& options, const RunContext& context = {});

/// As a Markdown table, one line per case, and the sum below it.
[[nodiscard]] std::string scanTable(const ScanStudy& study);

/// As a picture (SVG): for each disturbance, the share found against its strength, one line per method; crosses where
/// anything was taken for what it is not.
[[nodiscard]] std::string scanPlot(const ScanStudy& study);

}  // namespace skincal
