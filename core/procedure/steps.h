#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace skincal {

/// What the operator is led through, in this order; any may be revisited at any time.
enum class Step { Connect, Pose, Camera, Scan, Views, Result, Export, Demo };

inline constexpr std::array kSteps{Step::Connect, Step::Pose,   Step::Camera, Step::Scan,
                                   Step::Views,   Step::Result, Step::Export, Step::Demo};

enum class StepStatus {
    Blocked,         ///< something before it is missing
    ToDo,            ///< can be begun
    InProgress,      ///< begun, and more is asked for
    NeedsAttention,  ///< something is wrong or missing: StepState::reason
    Done,
};

/// Why a step is blocked, asks for more or needs attention; the window has a sentence for each.
enum class StepReason {
    None,
    NoSkin,
    SkinLost,
    NoNeighbours,  ///< every link is a cable, or there is none
    NoPoses,
    TooFewPoses,
    PosesAlike,  ///< gravity does not tell how modules are turned, add poses from other directions
    NoCamera,    ///< none is chosen
    NoPictures,  ///< the one that is chosen has not begun
    CameraLost,
    NoIntrinsics,
    FirstView,  ///< all is ready to scan one
    NoViews,
    PatchesNotPlaced,  ///< further views are asked for
    FewViews,          ///< patches are seen from one side only, or modules not at all
    ModulesNotPlaced,
    NotSolved,   ///< the newest data give no body
    NotTrusted,  ///< the body's verdict
    Changed,     ///< what was exported is not the newest body
    Solving,     ///< the answer is being computed
};

struct StepState {
    StepStatus status = StepStatus::Blocked;
    StepReason reason = StepReason::None;

    friend bool operator==(const StepState&, const StepState&) = default;
};

/// All that the states of the steps depend on.
struct Progress {
    bool hasSkin = false;  ///< its network is known
    bool isSkinLost = false;
    std::size_t neighbourLinks = 0;
    std::size_t modules = 0;
    std::size_t poses = 0;
    bool arePosesAlike = false;  ///< as the newest solution sees it
    bool hasIntrinsics = false;
    bool hasCamera = false;    ///< one is chosen
    bool hasPictures = false;  ///< it runs
    bool isCameraLost = false;
    std::size_t views = 0;
    bool isSolving = false;   ///< figures below are of an older body, or there is none yet
    bool isUnsolved = false;  ///< the newest data give no body: figures below are of an older one, or there is none
    bool hasBody = false;
    std::size_t patches = 0;
    std::size_t patchesPlaced = 0;
    std::size_t modulesPlaced = 0;
    bool areViewsFew = false;  ///< as the newest solution sees it
    bool isTrusted = false;    ///< the verdict is good or usable
    bool isExported = false;
    bool isExportNewest = false;
};

using StepStates = std::array<StepState, kSteps.size()>;

[[nodiscard]] StepStates stepStates(const Progress& progress);

/// The first step that is not done and can be worked on; Export where there is none.
[[nodiscard]] Step nextStep(const StepStates& states);

}  // namespace skincal
