#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/adjustment/accelerometer.h"
#include "core/skin/skin.h"
#include "core/vision/camera_model.h"

namespace skincal {

struct BodyModule {
    ModuleId id;
    std::string type;
    std::optional<PatchId> patch;
    std::optional<Isometry3d> T_patch_module;
    std::optional<Isometry3d> T_body_module;  ///< nothing where its patch could not be placed
    std::optional<Matrix6d> covariance;       ///< rotation vector then translation, body frame, rad and m
    std::optional<AccelerometerCalibration> accelerometer;
    std::string status;  ///< "placed", or why not
};

struct BodyPatch {
    PatchId id;
    ModuleId origin;
    std::vector<ModuleId> modules;
    std::optional<Isometry3d> T_body_patch;
    std::vector<std::string> views;  ///< those that have a say in this patch's pose
    std::string status;              ///< "placed", or why not
};

/// A link with its verdict.
struct BodyLink {
    Link link;
    LinkKind kind = LinkKind::Adjacent;
    std::string reason;
    std::optional<double> distance;  ///< between the two link points in the result, m
};

enum class ObservationVerdict { Used, Rejected, NotFound, Ambiguous };

struct BodyObservation {
    ModuleId module;
    std::optional<Vector2d> pixel;
    std::optional<Vector2d> residual;  ///< measured minus predicted, px
    ObservationVerdict verdict = ObservationVerdict::Used;
    std::string reason;
};

struct BodyView {
    std::string name;
    std::optional<Isometry3d> T_body_camera;
    std::optional<double> residual_rms_px;
    std::vector<BodyObservation> observations;
    std::string status;  ///< "placed", or why not
};

enum class Trust { Good, Usable, NotToBeTrusted };

/// "good", "usable" or "not to be trusted", in files as in print.
[[nodiscard]] std::string_view name(Trust trust);

/// The figures a person needs to trust or refuse the result.
struct BodyQuality {
    std::size_t modulesPlaced = 0;
    std::size_t modulesTotal = 0;
    std::optional<double> residual_rms_px;
    std::optional<double> link_mismatch_rms;     ///< m
    std::optional<double> link_mismatch_max;     ///< m
    std::optional<double> gravity_residual_rms;  ///< m/s^2
    std::map<std::string, double> condition;     ///< of each estimate, by name
    std::vector<std::string> warnings;
    std::vector<std::string> missing;  ///< what the data lack for the modules that are not placed
    Trust trust = Trust::Good;
};

struct BodyGenerator {
    std::string program = "skincal";
    std::string version;
    std::string method;
    std::map<std::string, std::string> options;
    std::map<std::string, std::string> recording_sha256;  ///< file name in the recording to digest
};

/// What a calibration produces (body-model.md). Poses are null, never made up, where data do not suffice.
struct BodyModel {
    BodyGenerator generator;
    std::string body_frame = "first-view";
    std::vector<ModuleTemplate> templates;
    std::vector<BodyModule> modules;
    std::vector<BodyPatch> patches;
    std::vector<BodyLink> links;
    std::vector<BodyView> views;
    BodyQuality quality;
};

}  // namespace skincal
