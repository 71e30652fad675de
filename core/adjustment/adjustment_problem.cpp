#include "core/adjustment/adjustment_problem.h"

#include <stdexcept>

#include "core/adjustment/late_cauchy_loss.h"

namespace skincal {
namespace {

PoseBlocks toBlocks(const Isometry3d& T) {
    const Quaterniond q = Quaterniond(T.linear()).normalized();
    return {{q.x(), q.y(), q.z(), q.w()}, {T.translation().x(), T.translation().y(), T.translation().z()}};
}

Isometry3d toPose(const PoseBlocks& blocks) {
    const Quaterniond q(blocks.q[3], blocks.q[0], blocks.q[1], blocks.q[2]);
    return makeIsometry(q.normalized().toRotationMatrix(), Vector3d(blocks.t.data()));
}

ceres::Problem::Options problemOptions() {
    ceres::Problem::Options options;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
}

std::unique_ptr<ceres::LossFunction> lossOf(double scale, const AdjustmentOptions& options) {
    return scale > 0 ? std::make_unique<LateCauchyLoss>(scale, options.lossBegins) : nullptr;
}

}  // namespace

AdjustmentProblem::AdjustmentProblem(const AdjustmentInput& input, const BodyState& start,
                                     const AdjustmentOptions& options)
    : input_(input),
      options_(options),
      pixelLoss_(lossOf(options.pixelLoss, options)),
      gravityLoss_(lossOf(options.gravityLoss, options)),
      linkLoss_(lossOf(options.linkLoss, options)),
      problem_(problemOptions()) {
    copyIn(start);
    addPixels(start);
    addGravity(start);
    addLinks(start);
}

void AdjustmentProblem::requireConsistent(const AdjustmentInput& input, const BodyState& state,
                                          const AdjustmentOptions& options) {
    if (!options.validate())
        throw std::logic_error("AdjustmentOptions out of range");
    if (input.skin == nullptr || input.gravity == nullptr || (input.camera == nullptr && !input.pixels.empty()) ||
        state.T_r_u.size() != input.skin->modules.size() || state.accelerometers.size() != state.T_r_u.size() ||
        input.gravityGroup.size() != state.T_r_u.size())
        throw std::logic_error("adjustBody: state and input do not belong together");
}

BodyState AdjustmentProblem::withUpDirections(const AdjustmentInput& input, BodyState state) {
    BodyState filled = state;
    estimateUpDirections(input, filled);
    if (state.up_r.size() != filled.up_r.size())
        return filled;
    for (std::size_t g = 0; g < filled.up_r.size(); ++g) {
        for (std::size_t p = 0; p < filled.up_r[g].size(); ++p) {
            if (state.up_r[g][p])
                filled.up_r[g][p] = state.up_r[g][p];
        }
    }
    return filled;
}

bool AdjustmentProblem::fix(const Gauge& gauge) {
    bool any = false;
    const auto hold = [&](PoseBlocks& pose) {
        for (double* block : {pose.q.data(), pose.t.data()}) {
            if (problem_.HasParameterBlock(block)) {
                problem_.SetParameterBlockConstant(block);
                any = true;
            }
        }
    };
    for (const std::size_t v : gauge.views)
        hold(views_[v]);
    for (const std::size_t u : gauge.modules)
        hold(modules_[u]);
    return any;
}

void AdjustmentProblem::copyOut(BodyState& state) const {
    for (std::size_t u = 0; u < modules_.size(); ++u) {
        if (state.T_r_u[u])
            state.T_r_u[u] = toPose(modules_[u]);
        state.accelerometers[u] = {Vector3d(bias_[u].data()), Vector3d(scale_[u].data()),
                                   Vector3d(misalignment_[u].data())};
    }
    for (std::size_t v = 0; v < views_.size(); ++v) {
        if (state.T_r_v[v])
            state.T_r_v[v] = toPose(views_[v]);
    }
    for (std::size_t g = 0; g < up_.size(); ++g) {
        for (std::size_t p = 0; p < up_[g].size(); ++p) {
            if (state.up_r[g][p])
                state.up_r[g][p] = Vector3d(up_[g][p].data()).normalized();
        }
    }
}

void AdjustmentProblem::copyIn(const BodyState& start) {
    modules_.resize(start.T_r_u.size());
    bias_.resize(start.T_r_u.size());
    scale_.resize(start.T_r_u.size());
    misalignment_.resize(start.T_r_u.size());
    for (std::size_t u = 0; u < modules_.size(); ++u) {
        if (start.T_r_u[u])
            modules_[u] = toBlocks(*start.T_r_u[u]);
        Eigen::Map<Vector3d>(bias_[u].data()) = start.accelerometers[u].bias;
        Eigen::Map<Vector3d>(scale_[u].data()) = start.accelerometers[u].scale;
        Eigen::Map<Vector3d>(misalignment_[u].data()) = start.accelerometers[u].misalignment;
    }
    views_.resize(start.T_r_v.size());
    for (std::size_t v = 0; v < views_.size(); ++v) {
        if (start.T_r_v[v])
            views_[v] = toBlocks(*start.T_r_v[v]);
    }
    up_.resize(start.up_r.size());
    for (std::size_t g = 0; g < up_.size(); ++g) {
        up_[g].resize(start.up_r[g].size());
        for (std::size_t p = 0; p < up_[g].size(); ++p) {
            if (start.up_r[g][p])
                Eigen::Map<Vector3d>(up_[g][p].data()) = *start.up_r[g][p];
        }
    }
}

void AdjustmentProblem::addPixels(const BodyState& start) {
    for (std::size_t i = 0; i < input_.pixels.size(); ++i) {
        const PixelObservation& o = input_.pixels[i];
        if (!start.T_r_u[o.module] || !start.T_r_v[o.view] || !pixelResidual(input_, start, o))
            continue;
        auto* cost = new ceres::AutoDiffCostFunction<LedPixelResidual, 2, 4, 3, 4, 3>(new LedPixelResidual{
            input_.camera, o.pixel, input_.skin->templateOf(o.module).led, 1.0 / input_.sigmaOf(o, options_)});
        PoseBlocks& module = modules_[o.module];
        PoseBlocks& view = views_[o.view];
        keep(MeasurementKind::Pixel,
             problem_.AddResidualBlock(cost, pixelLoss_.get(), module.q.data(), module.t.data(), view.q.data(),
                                       view.t.data()),
             i);
        problem_.SetManifold(module.q.data(), &quaternion_);
        problem_.SetManifold(view.q.data(), &quaternion_);
    }
}

void AdjustmentProblem::addReading(std::size_t u, std::size_t entry) {
    const GravityTable::Entry& reading = input_.gravity->of(u)[entry];
    auto* residual =
        new GravityResidual{reading.acceleration, options_.gravity, 1.0 / input_.sigmaOf(u, reading, options_)};
    double* up = up_[input_.gravityGroup[u]][reading.pose].data();
    double* q = modules_[u].q.data();
    keep(MeasurementKind::Gravity,
         options_.misalignmentSigma > 0
             ? problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<GravityResidual, 3, 4, 3, 3, 3, 3>(residual),
                                         gravityLoss_.get(), q, up, bias_[u].data(), scale_[u].data(),
                                         misalignment_[u].data())
             : problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<GravityResidual, 3, 4, 3, 3, 3>(residual),
                                         gravityLoss_.get(), q, up, bias_[u].data(), scale_[u].data()),
         u, entry);
    problem_.SetManifold(up, &sphere_);
}

void AdjustmentProblem::addGravity(const BodyState& start) {
    for (std::size_t u = 0; u < modules_.size(); ++u) {
        if (!start.T_r_u[u] || input_.gravity->of(u).empty())
            continue;
        for (std::size_t entry = 0; entry < input_.gravity->of(u).size(); ++entry)
            addReading(u, entry);
        problem_.SetManifold(modules_[u].q.data(), &quaternion_);
        addPrior(MeasurementKind::Bias, u, bias_[u], Vector3d::Zero(), options_.biasSigma);
        addPrior(MeasurementKind::Scale, u, scale_[u], Vector3d::Ones(), options_.scaleSigma);
        if (options_.misalignmentSigma > 0)
            addPrior(MeasurementKind::Misalignment, u, misalignment_[u], Vector3d::Zero(), options_.misalignmentSigma);
    }
}

void AdjustmentProblem::addPrior(MeasurementKind kind, std::size_t u, Block3& block, const Vector3d& expected,
                                 double sigma) {
    keep(kind,
         problem_.AddResidualBlock(
             new ceres::AutoDiffCostFunction<PriorResidual, 3, 3>(new PriorResidual{expected, 1.0 / sigma}), nullptr,
             block.data()),
         u);
    if (!options_.calibrateAccelerometers)
        problem_.SetParameterBlockConstant(block.data());
}

void AdjustmentProblem::addLinks(const BodyState& start) {
    for (std::size_t l = 0; l < input_.links.size(); ++l) {
        const PortPair& link = input_.links[l];
        if (!start.T_r_u[link.a] || !start.T_r_u[link.b])
            continue;
        auto* cost = new ceres::AutoDiffCostFunction<LinkResidual, 3, 4, 3, 4, 3>(
            new LinkResidual{link.port_a, link.port_b, 1.0 / options_.linkSigma});
        PoseBlocks& a = modules_[link.a];
        PoseBlocks& b = modules_[link.b];
        keep(MeasurementKind::Link,
             problem_.AddResidualBlock(cost, linkLoss_.get(), a.q.data(), a.t.data(), b.q.data(), b.t.data()), l);
        problem_.SetManifold(a.q.data(), &quaternion_);
        problem_.SetManifold(b.q.data(), &quaternion_);
    }
}

}  // namespace skincal
