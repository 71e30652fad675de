#pragma once

/// The body's state as parameter blocks of Ceres and the residuals on top of them: shared by what solves
/// (body_adjustment) and what judges the solution (linearisation). Not for other rooms.

#include <ceres/ceres.h>

#include <array>
#include <memory>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/adjustment/residuals.h"

namespace skincal {

using Block3 = std::array<double, 3>;
using Block4 = std::array<double, 4>;

struct PoseBlocks {
    Block4 q{};
    Block3 t{};
};

/// What a residual block was made of.
enum class MeasurementKind { Pixel, Gravity, Link, Bias, Scale, Misalignment };
inline constexpr std::array kMeasurementKinds{MeasurementKind::Pixel, MeasurementKind::Gravity,
                                              MeasurementKind::Link,  MeasurementKind::Bias,
                                              MeasurementKind::Scale, MeasurementKind::Misalignment};

/// A residual block and what it was made of: pixels and links by their position in the input, the others by module and,
/// for readings, the position among the module's own.
struct ResidualOf {
    ceres::ResidualBlockId id = nullptr;
    std::size_t index = 0;
    std::size_t entry = 0;
};

/// Lives as long as one solve.
class AdjustmentProblem {
  public:
    AdjustmentProblem(const AdjustmentInput& input, const BodyState& start, const AdjustmentOptions& options);

    /// Throws std::logic_error where these do not belong together.
    static void requireConsistent(const AdjustmentInput& input, const BodyState& state,
                                  const AdjustmentOptions& options);
    /// Up directions that no accelerometer of the state's own gives are estimated from the rest.
    static BodyState withUpDirections(const AdjustmentInput& input, BodyState state);

    /// Holds the gauge; false where nothing of it takes part.
    bool fix(const Gauge& gauge);

    ceres::Problem& ceres() { return problem_; }
    PoseBlocks& module(std::size_t i) { return modules_[i]; }
    PoseBlocks& view(std::size_t i) { return views_[i]; }
    [[nodiscard]] const std::vector<ResidualOf>& residuals(MeasurementKind kind) const {
        return residuals_.at(static_cast<std::size_t>(kind));
    }

    void copyOut(BodyState& state) const;

  private:
    void copyIn(const BodyState& start);
    void keep(MeasurementKind kind, ceres::ResidualBlockId id, std::size_t index, std::size_t entry = 0) {
        residuals_.at(static_cast<std::size_t>(kind)).push_back({id, index, entry});
    }
    void addPixels(const BodyState& start);
    void addGravity(const BodyState& start);
    void addLinks(const BodyState& start);
    void addReading(std::size_t module, std::size_t entry);
    void addPrior(MeasurementKind kind, std::size_t module, Block3& block, const Vector3d& expected, double sigma);

    const AdjustmentInput& input_;
    const AdjustmentOptions& options_;
    std::vector<PoseBlocks> modules_;
    std::vector<PoseBlocks> views_;
    std::vector<Block3> bias_;
    std::vector<Block3> scale_;
    std::vector<Block3> misalignment_;
    std::vector<std::vector<Block3>> up_;
    std::array<std::vector<ResidualOf>, kMeasurementKinds.size()> residuals_;
    ceres::EigenQuaternionManifold quaternion_;
    ceres::SphereManifold<3> sphere_;
    std::unique_ptr<ceres::LossFunction> pixelLoss_;
    std::unique_ptr<ceres::LossFunction> gravityLoss_;
    std::unique_ptr<ceres::LossFunction> linkLoss_;
    ceres::Problem problem_;
};

}  // namespace skincal
