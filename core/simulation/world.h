#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/simulation/faults.h"
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
    Skin skin;                          ///< as the network reports it: no word on what is a cable, faults included
    std::vector<std::size_t> trueType;  ///< per module, index into Scenario::templates, whatever the network reports
    std::vector<Isometry3d> T_r_u;      ///< per module, at the scan
    std::vector<int> patchOf;           ///< per module
    std::vector<bool> isCable;          ///< per link
    std::vector<Vector3d> gravity_r;    ///< per pose: what an ideal accelerometer reads, body frame, m/s^2
    std::vector<Isometry3d> T_r_v;      ///< per view; of one that is knocked half-way, before the knock
    std::vector<Tube> tubes;
    std::vector<Card> cards;
    std::vector<std::size_t> covered;  ///< modules whose LED lies under a card, in increasing order
    WorldFaults faults;                ///< who is to blame for what

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
/// views overlap; then lets go wrong what the scenario asks for (see addFaults). The same scenario and seed give the
/// same world. Throws std::logic_error where the scenario has no patch or template, or asks for more than there is.
[[nodiscard]] World buildWorld(const Scenario& scenario, std::uint64_t seed);

[[nodiscard]] std::string viewName(std::size_t view);

/// Accelerometer readings of all modules in all poses:
///   a = S M R_r_u^T g + b + noise,  S scale, M misalignment, b bias
/// in the poses that modules had then (poseAtGravity), with the accelerations of shaken poses (see ShakenPose).
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
/// The same of a camera that stands anywhere.
/// @param view  any number: decides by chance what an occluder hides, see occluderOf
[[nodiscard]] std::optional<Vector2d> visiblePixel(const World& world, const Isometry3d& T_r_v, std::size_t view,
                                                   std::size_t module, const Visibility& visibility);

/// The part of the picture that the occluder hides in a view, in pixels (x, y, width, height); empty without one.
[[nodiscard]] Eigen::Vector4d occluderOf(const World& world, std::size_t view);
/// The same of a camera that stands anywhere; the view's number decides by chance what is hidden.
[[nodiscard]] Eigen::Vector4d occluderOf(const World& world, const Isometry3d& T_r_v, std::size_t view);

[[nodiscard]] bool isOccluded(const World& world, const Isometry3d& T_r_v, std::size_t view, const Vector2d& pixel);

/// Whether a tube or a card lies between two points.
[[nodiscard]] bool isBlocked(const World& world, const Vector3d& from_r, const Vector3d& to_r);
/// The same between a module's LED and a point.
[[nodiscard]] bool isBlocked(const World& world, std::size_t module, const Vector3d& to_r);

/// True of the modules that a scan shows in its later half, when a camera that is knocked half-way has moved.
[[nodiscard]] bool scannedAfterBump(const World& world, std::size_t module);

/// LED positions with noise, and false ones within 250 px where the scenario has outliers; from two poses of the camera
/// in bumped views. A fault changes the detections of its culprits alone, to the last bit.
[[nodiscard]] std::vector<ViewDetections> simulateDetections(const World& world);

/// Poses at the scan, and pixels from World::T_r_v: in bumped views, as if nobody had knocked.
[[nodiscard]] Truth truthOf(const World& world);

/// The frames of one view's scan, in order, with the lit sets: see ScanKind; coded scans as codedScan has them.
[[nodiscard]] std::vector<FrameInfo> planScan(const World& world, std::size_t view);

}  // namespace skincal
