#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/se3.h"
#include "core/skin/module_template.h"
#include "core/vision/camera_model.h"

namespace skincal {

enum class SurfaceKind {
    Plane,     ///< z = 0
    Cylinder,  ///< axis y, the layout's x runs round it
    FreeForm,  ///< a smooth random relief
    Sole,      ///< a shoe's: bent up at toe and heel
};

/// Where one patch lies and what it is made of.
struct PatchPlan {
    SurfaceKind surface = SurfaceKind::Plane;
    double radius = 0.05;                       ///< m, of a cylinder; scale of the relief of a free form
    Isometry3d T_r_s = Isometry3d::Identity();  ///< surface frame in the body
    Vector2d offset = Vector2d::Zero();         ///< of the patch's middle on the surface, m along it
    std::size_t modules = 7;
    std::size_t type = 0;     ///< index into Scenario::templates
    double raggedness = 0.3;  ///< 0 grows round patches, 1 sprawling ones
    bool strip = false;       ///< one row of modules, port 0 to the port opposite
    bool ring = false;        ///< a strip whose ends are linked
};

struct SensorOptions {
    int poses = 12;
    double bias = 0.3;           ///< m/s^2 per axis, standard deviation
    double scale = 0.01;         ///< per axis, standard deviation about 1
    double misalignment = 0;     ///< rad, of the chip on its board
    double noise = 0.03;         ///< m/s^2 per axis and reading
    bool parallelPoses = false;  ///< all poses differ by turns about gravity only: a degenerate set
};

struct PlayOptions {
    double position = 0.3e-3;  ///< m per axis, standard deviation
    double tilt = 0.01;        ///< rad per axis
};

enum class ScanKind {
    Detections,  ///< no pictures: LED positions with noise
    OneAtATime,  ///< each LED alone between backgrounds, as in the paper
    Coded,       ///< every module blinks a word of its own
    Coloured,    ///< up to seven LEDs at once, each in a native colour
};

struct ViewOptions {
    int count = 8;
    double distance = 0.8;           ///< m from the camera to the body
    double tilt = 25 * kDegree;      ///< how far cameras are turned away at random
    double maxAngle = 70 * kDegree;  ///< between an LED's axis and the ray to a camera that still finds it
    double pixelNoise = 0.05;        ///< px per axis, for ScanKind::Detections
    double outliers = 0;             ///< share of detections that are somewhere else
    ScanKind scan = ScanKind::Detections;
    int repeats = 1;  ///< foreground frames per module in one-at-a-time scans
};

struct RenderOptions {
    double ledPeak = 450;         ///< grey levels of a frontal LED at 0.6 m
    double lobe = 120 * kDegree;  ///< full angle at half intensity
    double blur_px = 0.9;         ///< Gaussian sigma of the lens
    double halo = 0.04;           ///< share of the peak that the wide halo has
    double readNoise = 1.3;       ///< grey levels
    double shotNoise = 0.02;      ///< variance per grey level
    double background = 70;       ///< mean grey level
    double texture = 45;          ///< contrast of the background
};

struct DisturbanceOptions {
    double reflection = 0;    ///< share of an LED's light that a mirror below the body returns (see Mirror)
    double flicker = 0;       ///< grey levels, lamp at twice the mains frequency
    double flickerHz = 100;   ///< twice the mains frequency, seen at 30 frames per second
    bool person = false;      ///< someone walks through the picture
    bool occluder = false;    ///< something opaque hides part of the picture
    double bump_px = 0;       ///< the camera is knocked half-way through each second view
    double sun = 0;           ///< the room grows brighter by this share through the scan, with a cloud in between
    double screen = 0;        ///< grey levels between the cells of a picture that changes with every frame, in the room
    double exposureStep = 0;  ///< share by which the camera's own exposure steps down in the scan, and up again
};

/// What goes wrong in a way that a calibration has to find and name: how many of each, and by how much. All off by
/// default. World::faults says who the culprits are.
struct FaultOptions {
    std::size_t movedModules = 0;     ///< modules that moved between the gravity poses and the scan
    double moveShift = 4e-3;          ///< m, along the skin or off it
    double moveTilt = 6 * kDegree;    ///< rad, about a random axis
    std::size_t shakenPoses = 0;      ///< gravity poses during which the body shook
    double shake = 0.6;               ///< m/s^2, rms length of the acceleration that all modules of the pose share
    double tremble = 0.4;             ///< m/s^2 rms per axis, of each module's own part
    std::size_t misportedLinks = 0;   ///< neighbour links with a wrong port at one end, one that is free otherwise
    std::size_t bumpedViews = 0;      ///< views whose camera is knocked half-way; ScanKind::Detections only
    double bumpShift = 8e-3;          ///< m, in a random direction
    double bumpTurn = 1 * kDegree;    ///< rad, about a random axis
    std::size_t wrongTemplates = 0;   ///< modules reported as another of the templates, one that has the linked ports
    std::size_t movedPatches = 0;     ///< patches, never the first, that turned between the gravity poses and the scan
    double patchTurn = 20 * kDegree;  ///< rad, about a random axis through the patch's middle
};

/// Everything that a simulated world is made from, given a seed.
struct Scenario {
    std::string name;
    std::string description;
    std::vector<ModuleTemplate> templates{paperHexagon()};
    std::vector<PatchPlan> patches;
    std::size_t covered = 0;        ///< modules in the middle of the first patch that lie under a business card
    bool cables = false;            ///< consecutive patches are wired to each other
    std::vector<Vector3d> outward;  ///< where cameras stand, per patch; empty: along the patch's normal
    SensorOptions sensors;
    PlayOptions play;
    ViewOptions views;
    RenderOptions pictures;
    DisturbanceOptions disturbances;
    FaultOptions faults;
    CameraModel camera;
};

/// A webcam at 1280x720 with a little distortion.
[[nodiscard]] CameraModel simulatedWebcam();

/// The worlds that come with the program.
[[nodiscard]] const std::vector<Scenario>& builtInScenarios();
[[nodiscard]] const Scenario* findScenario(std::string_view name);

}  // namespace skincal
