#include "core/procedure/steps.h"

#include <algorithm>

namespace skincal {
namespace {

/// Two poses give rotations, three tell where one of them is off.
constexpr std::size_t kFewestPoses = 3;

StepState connectState(const Progress& p) {
    if (p.isSkinLost)
        return {StepStatus::NeedsAttention, StepReason::SkinLost};
    if (!p.hasSkin)
        return {StepStatus::ToDo, StepReason::None};
    if (p.neighbourLinks == 0 && p.modules != 1)
        return {StepStatus::NeedsAttention, StepReason::NoNeighbours};
    return {StepStatus::Done, StepReason::None};
}

StepState poseState(const Progress& p) {
    if (!p.hasSkin)
        return {StepStatus::Blocked, StepReason::NoSkin};
    const bool isEnough = p.poses >= kFewestPoses;
    if (isEnough && !p.arePosesAlike)
        return {StepStatus::Done, StepReason::None};
    // What is still missing needs the skin itself.
    if (p.isSkinLost)
        return {StepStatus::Blocked, StepReason::SkinLost};
    if (p.poses == 0)
        return {StepStatus::ToDo, StepReason::NoPoses};
    return isEnough ? StepState{StepStatus::NeedsAttention, StepReason::PosesAlike}
                    : StepState{StepStatus::InProgress, StepReason::TooFewPoses};
}

StepReason whyNoPictures(const Progress& p) {
    return p.hasCamera ? StepReason::NoPictures : StepReason::NoCamera;
}

StepState cameraState(const Progress& p) {
    if (p.isCameraLost)
        return {StepStatus::NeedsAttention, StepReason::CameraLost};
    if (!p.hasIntrinsics)
        return p.hasPictures ? StepState{StepStatus::InProgress, StepReason::NoIntrinsics}
                             : StepState{StepStatus::ToDo, whyNoPictures(p)};
    // Intrinsics from a file don't make a picture; a scan that is there needs no camera any more.
    if (!p.hasPictures && p.views == 0)
        return {StepStatus::ToDo, whyNoPictures(p)};
    return {StepStatus::Done, StepReason::None};
}

StepState scanState(const Progress& p) {
    if (!p.hasSkin)
        return {StepStatus::Blocked, StepReason::NoSkin};
    if (!p.hasIntrinsics)
        return {StepStatus::Blocked, StepReason::NoIntrinsics};
    if (p.views > 0)
        return {StepStatus::Done, StepReason::None};
    if (p.isSkinLost)
        return {StepStatus::Blocked, StepReason::SkinLost};
    if (p.isCameraLost)
        return {StepStatus::Blocked, StepReason::CameraLost};
    if (!p.hasPictures)
        return {StepStatus::Blocked, whyNoPictures(p)};
    return {StepStatus::ToDo, StepReason::FirstView};
}

StepState viewsState(const Progress& p) {
    if (p.views == 0)
        return {StepStatus::Blocked, StepReason::NoViews};
    if (!p.hasBody && p.isSolving)
        return {StepStatus::InProgress, StepReason::Solving};
    if (!p.hasBody)
        return {StepStatus::NeedsAttention, p.isUnsolved ? StepReason::NotSolved : StepReason::PatchesNotPlaced};
    if (p.modulesPlaced == 0 || p.patchesPlaced < p.patches)
        return {StepStatus::InProgress, StepReason::PatchesNotPlaced};
    if (p.areViewsFew)
        return {StepStatus::InProgress, StepReason::FewViews};
    return {StepStatus::Done, StepReason::None};
}

StepState resultState(const Progress& p) {
    if (!p.hasBody) {
        const auto reason = p.views == 0 ? StepReason::NoViews : StepReason::PatchesNotPlaced;
        return {StepStatus::Blocked, p.isSolving ? StepReason::Solving : reason};
    }
    if (p.isSolving)
        return {StepStatus::InProgress, StepReason::Solving};
    if (p.isUnsolved)
        return {StepStatus::NeedsAttention, StepReason::NotSolved};
    if (p.modulesPlaced == 0)
        return {StepStatus::Blocked, StepReason::PatchesNotPlaced};
    if (!p.isTrusted)
        return {StepStatus::NeedsAttention, StepReason::NotTrusted};
    if (p.modulesPlaced < p.modules)
        return {StepStatus::InProgress, StepReason::ModulesNotPlaced};
    return {StepStatus::Done, StepReason::None};
}

StepState exportState(const Progress& p) {
    if (!p.hasBody || p.modulesPlaced == 0)
        return {StepStatus::Blocked, StepReason::PatchesNotPlaced};
    if (!p.isExported)
        return {StepStatus::ToDo, StepReason::None};
    if (!p.isExportNewest || p.isUnsolved)
        return {StepStatus::NeedsAttention, StepReason::Changed};
    return {StepStatus::Done, StepReason::None};
}

StepState demoState(const Progress& p) {
    if (!p.hasBody || p.modulesPlaced == 0)
        return {StepStatus::Blocked, StepReason::PatchesNotPlaced};
    if (p.isSkinLost)
        return {StepStatus::Blocked, StepReason::SkinLost};
    if (!p.hasSkin)
        return {StepStatus::Blocked, StepReason::NoSkin};
    return {StepStatus::ToDo, StepReason::None};
}

}  // namespace

StepStates stepStates(const Progress& p) {
    return {connectState(p), poseState(p),   cameraState(p), scanState(p),
            viewsState(p),   resultState(p), exportState(p), demoState(p)};
}

Step nextStep(const StepStates& states) {
    const auto open = std::find_if(states.begin(), states.end(), [](const StepState& state) {
        return state.status != StepStatus::Done && state.status != StepStatus::Blocked;
    });
    return open == states.end() ? Step::Export : kSteps.at(static_cast<std::size_t>(open - states.begin()));
}

}  // namespace skincal
