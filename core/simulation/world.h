#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/simulation/scenario.h"
#include "core/simulation/truth.h"
#include "core/skin/skin.h"
#include "core/vision/detection.h"
#include "core/vision/frame.h"

namespace skincal {

/// A tube that hides what lies behind it (an arm's link, the cylinder under a skin).
struct Tube {
    Vector3d from = Vector3d::Zero();
    Vector3d to = Vector3d::Zero();
    double radius = 0;
};

/// Something flat and opaque that lies on the skin.
struct Card {
    Isometry3d T_r_k = Isometry3d::Identity();  ///< middle of the card, z away from the skin
    double width = 0.0856;                      ///< m, along x; a business card
    double height = 0.054;                      ///< m, along y
};

/// What really is. Everything in it follows from a scenario and a seed.
struct World {
    Scenario scenario;
    std::uint64_t seed = 0;
    Skin skin;                          ///< as the network reports it: no word on what is a cable
    std::vector<std::size_t> trueType;  ///< per module, index into Scenario::templates, whatever the network reports
    std::vector<Isometry3d> T_r_u;      ///< per module
    std::vector<int> patchOf;           ///< per module
    std::vector<bool> isCable;          ///< per link
    std::vector<Vector3d> gravity_r;    ///< per pose: what an ideal accelerometer reads, body frame, m/s^2
    std::vector<Isometry3d> T_r_v;      ///< per view
    std::vector<Tube> tubes;
    std::vector<Card> cards;
    std::vector<std::size_t> covered;  ///< modules whose LED lies under a card, in increasing order

    /// What a module really is; skin.templateOf says what it is reported to be.
    [[nodiscard]] const ModuleTemplate& trueTemplate(std::size_t module) const {
        return scenario.templates[trueType[module]];
    }
};

/// Lays a business card on the middle of the first patch, turned and shifted so that it covers the LEDs of exactly
/// `count` modules and keeps as far as it can from the edges of being one more or less: it hides the same modules from
/// wherever a camera looks. Throws std::logic_error where no place gives that many.
void layCard(World& world, std::size_t count);

/// Lays out the patches, adds mechanical play, wires cables, poses the body and places cameras so that consecutive
/// views overlap. The same scenario and seed give the same world.
[[nodiscard]] World buildWorld(const Scenario& scenario, std::uint64_t seed);

[[nodiscard]] std::string viewName(std::size_t view);

/// Accelerometer readings of all modules in all poses:
///   a = S M R_r_u^T g + b + noise,  S scale, M misalignment, b bias
[[nodiscard]] std::vector<GravityReading> simulateGravity(const World& world);

struct Visibility {
    double maxAngle = 70 * kDegree;  ///< between the LED's axis and the ray to the camera
    double margin_px = 8;            ///< from the picture's border
};

/// Pixel of a module's LED in a view, or nothing where the camera does not see it: turned away, out of the picture,
/// behind a tube, a card or the occluder.
[[nodiscard]] std::optional<Vector2d> visiblePixel(const World& world, std::size_t view, std::size_t module,
                                                   const Visibility& visibility);
/// The same with the scenario's own limits.
[[nodiscard]] std::optional<Vector2d> visiblePixel(const World& world, std::size_t view, std::size_t module);

/// The part of the picture that the occluder hides in a view, in pixels (x, y, width, height); empty without one.
[[nodiscard]] Eigen::Vector4d occluderOf(const World& world, std::size_t view);

/// LED positions with noise, and false ones within 250 px where the scenario has outliers.
[[nodiscard]] std::vector<ViewDetections> simulateDetections(const World& world);

[[nodiscard]] Truth truthOf(const World& world);

/// The frames of one view's scan, in order, with the lit sets: see ScanKind. Coded scans begin with all off and all on,
/// then show bit after bit and its complement of words that differ in at least two bits.
[[nodiscard]] std::vector<FrameInfo> planScan(const World& world, std::size_t view);

}  // namespace skincal
