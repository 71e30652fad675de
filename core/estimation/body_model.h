#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/adjustment/accelerometer.h"
#include "core/geometry/sentence.h"
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
    Sentence status;  ///< "placed", or why not
    /// What its pose rests on: false where no picture that counts shows it, but links and gravity alone.
    bool seen = false;
};

struct BodyPatch {
    PatchId id;
    ModuleId origin;
    std::vector<ModuleId> modules;
    std::optional<Isometry3d> T_body_patch;
    std::vector<std::string> views;  ///< those that have a say in this patch's pose
    Sentence status;                 ///< "placed", or why not
};

/// A link with its verdict.
struct BodyLink {
    Link link;
    LinkKind kind = LinkKind::Adjacent;
    Sentence reason;
    std::optional<double> distance;  ///< between the two link points in the result, m
};

enum class ObservationVerdict { Used, Rejected, NotFound, Ambiguous };

struct BodyObservation {
    ModuleId module;
    std::optional<Vector2d> pixel;
    std::optional<Vector2d> residual;  ///< measured minus predicted, px
    ObservationVerdict verdict = ObservationVerdict::Used;
    Sentence reason;  ///< of any verdict but used, and where one of several spots was taken
};

struct BodyView {
    std::string name;
    std::optional<Isometry3d> T_body_camera;
    std::optional<double> residual_rms_px;
    std::vector<BodyObservation> observations;
    Sentence status;  ///< "placed", or why not
};

/// Something that disagrees with the rest of what was measured, and does not count in the result.
struct Finding {
    enum class Kind {
        WrongLink,           ///< reported between ports that do not meet, or a cable that looked like a neighbour
        MovedModule,         ///< since gravity was read
        MovedPatch,          ///< likewise, as a whole: a joint moved
        WrongTemplate,       ///< the module is of another type than the skin says
        ShakenPose,          ///< the body did not rest while gravity was read
        NoisyAccelerometer,  ///< far worse than the others
        BumpedView,          ///< the camera was moved half-way through the scan
        UnsteadyView,        ///< far less exact than the other views
    };
    Kind kind{};
    std::vector<ModuleId> modules{};
    std::optional<std::string> view{};
    std::optional<int> pose{};
    Sentence text;  ///< with the numbers that decided
};

/// "moved module" and so on, in files as in print.
[[nodiscard]] std::string_view name(Finding::Kind kind);

/// All of them; name() gives each a word of its own.
inline constexpr std::array kFindingKinds{Finding::Kind::WrongLink,  Finding::Kind::MovedModule,
                                          Finding::Kind::MovedPatch, Finding::Kind::WrongTemplate,
                                          Finding::Kind::ShakenPose, Finding::Kind::NoisyAccelerometer,
                                          Finding::Kind::BumpedView, Finding::Kind::UnsteadyView};

/// What a stage of the computation took. Not part of the file: it differs from run to run.
struct StageReport {
    std::string stage;
    double seconds = 0;
    int iterations = 0;  ///< of the solver, where it solves
};

enum class Trust { Good, Usable, NotToBeTrusted };

/// "good", "usable" or "not to be trusted", in files as in print.
[[nodiscard]] std::string_view name(Trust trust);
[[nodiscard]] Sentence sentenceOf(Trust trust);

/// The figures a person needs to trust or refuse the result.
struct BodyQuality {
    std::size_t modulesPlaced = 0;
    std::size_t modulesTotal = 0;
    std::optional<double> residual_rms_px;
    std::optional<double> link_mismatch_rms;     ///< m
    std::optional<double> link_mismatch_max;     ///< m
    std::optional<double> gravity_residual_rms;  ///< m/s^2
    std::map<std::string, double> condition;     ///< of each estimate, by name
    std::vector<Sentence> warnings;
    std::vector<Sentence> missing;  ///< what the data lack for the modules that are not placed
    std::vector<Finding> findings;
    std::vector<StageReport> stages;
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
