#include "core/estimation/noise_findings.h"

namespace skincal {

void noteNoiseFindings(BodySolution& solution) {
    constexpr double kWorthNaming = 2;
    const AdjustmentInput& input = solution.input;
    // Anew after each solution.
    std::erase_if(solution.estimate.findings, [](const Finding& f) {
        return f.kind == Finding::Kind::ShakenPose || f.kind == Finding::Kind::NoisyAccelerometer ||
               f.kind == Finding::Kind::UnsteadyView;
    });
    for (std::size_t p = 0; p < input.poseNoise.size(); ++p) {
        if (input.poseNoise[p] < kWorthNaming)
            continue;
        Finding finding;
        finding.kind = Finding::Kind::ShakenPose;
        finding.pose = input.gravity->poseNumber(p);
        finding.text = Sentence::saying(
            "pose {}: the body did not rest: its readings are {:.0f} times as noisy as those of the other poses and "
            "count "
            "as much less",
            *finding.pose, input.poseNoise[p]);
        solution.estimate.findings.push_back(std::move(finding));
    }
    for (std::size_t u = 0; u < input.moduleNoise.size(); ++u) {
        if (input.moduleNoise[u] < kWorthNaming)
            continue;
        Finding finding;
        finding.kind = Finding::Kind::NoisyAccelerometer;
        finding.modules = {input.skin->modules[u].id};
        finding.text = Sentence::saying(
            "module {}: its accelerometer is {:.0f} times as noisy as the others and counts as much less",
            finding.modules.front().value, input.moduleNoise[u]);
        solution.estimate.findings.push_back(std::move(finding));
    }
    for (std::size_t v = 0; v < input.viewNoise.size(); ++v) {
        if (input.viewNoise[v] < kWorthNaming)
            continue;
        Finding finding;
        finding.kind = Finding::Kind::UnsteadyView;
        finding.view = solution.measurements->views[v].name;
        finding.text = Sentence::saying(
            "view {}: its detections are {:.1f} times less exact than those of the other views and count as much less: "
            "the "
            "camera moved, or was out of focus",
            *finding.view, input.viewNoise[v]);
        solution.estimate.findings.push_back(std::move(finding));
    }
}

}  // namespace skincal
