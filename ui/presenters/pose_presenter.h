#pragma once

#include <QObject>
#include <memory>

#include "core/procedure/pose_capture.h"
#include "core/procedure/stillness.h"
#include "ui/presenters/pose_model.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Whether the poses that count suffice.
enum class PoseVerdict {
    None,      ///< there is none yet
    TooFew,    ///< or all alike: they leave an axis free
    NotExact,  ///< more of them, or more different ones, would tell a good deal more
    TooAlike,  ///< for some modules, as the newest body says
    Enough,
};

/// Leads the operator from pose to pose: where the body's up is, where it has been, where it should go, and captures
/// when it rests. Directions are in the frame of one module, the reference, which has to be somewhere on the body;
/// which one does not matter.
class PosePresenter : public QObject {
    Q_OBJECT
  public:
    explicit PosePresenter(Workbench& workbench, QObject* parent = nullptr);

    [[nodiscard]] PoseModel& poses() { return poses_; }

    /// Watches the accelerometers while the page is shown; they are silent otherwise.
    void setActive(bool active);
    void setAutomatic(bool automatic);
    [[nodiscard]] bool isAutomatic() const { return options_.isAutomatic; }
    void captureNow();
    /// Where a rig has hands: they turn the body to the target.
    void turnToTarget();
    [[nodiscard]] bool hasHands() const { return workbench_.handsOnSkin() != nullptr; }

    [[nodiscard]] const PoseCapture& state() const { return state_; }
    /// m/s^2; nothing before the first half second.
    [[nodiscard]] std::optional<double> movement() const;
    [[nodiscard]] double restsBelow() const { return stillness_.restsBelow; }
    /// Share of the rest that has passed, 0 to 1.
    [[nodiscard]] double restDone() const;
    /// The body rests as in a pose that was captured already.
    [[nodiscard]] bool isKnownPose() const { return isKnownPose_; }

    /// Unit vectors against gravity: now, in all poses that count, and where the next should point.
    [[nodiscard]] std::optional<Vector3d> up() const { return up_; }
    [[nodiscard]] const std::vector<Vector3d>& covered() const { return covered_; }
    [[nodiscard]] std::optional<Vector3d> target() const;
    /// How far the body is from the target, rad.
    [[nodiscard]] std::optional<double> angleToTarget() const;
    /// Expected standard deviation of an edge's rotation with the first n poses, rad, from n = 1 on.
    [[nodiscard]] const std::vector<std::optional<double>>& forecast() const { return forecast_; }
    /// An edge that is known as well as this is good: below it the play of the moulds matters more. Rad.
    static constexpr double kGoodEdge = 1 * kDegree;
    [[nodiscard]] PoseVerdict verdict() const;
    /// The same in a sentence; empty before the first pose.
    [[nodiscard]] QString verdictText() const;
    [[nodiscard]] std::optional<ModuleId> reference() const { return reference_; }

  signals:
    void sampled();       ///< at most 30 times a second: the live figures
    void stateChanged();  ///< phase, poses, target
    void captured(int pose);
    void refused();  ///< the body moves

  private:
    void attachDevice();
    void takeSample(const AccelerationSample& sample);
    void handle(const pose_capture::Event& event);
    void capture(std::chrono::microseconds from);
    void refresh();

    Workbench& workbench_;
    PoseModel poses_;
    PoseCapture state_;
    PoseCaptureOptions options_;
    StillnessOptions stillness_;
    std::unique_ptr<StillnessMeter> meter_;
    std::vector<ModuleId> modules_;
    std::unordered_map<ModuleId, std::size_t> index_;
    std::optional<ModuleId> reference_;
    std::optional<Vector3d> up_;
    std::vector<GravityReading> countingReadings_;
    std::vector<Vector3d> covered_;
    std::vector<std::optional<double>> forecast_;
    std::chrono::microseconds now_{};
    std::chrono::microseconds lastShown_{};
    bool isActive_ = false;
    /// Something was undone and the body has not moved since: a capture by itself would be what was just undone, and
    /// end what can be redone.
    bool isKnownPose_ = false;
    bool isHeld_ = false;
};

/// Of directions spread evenly over the sphere, the one farthest from all that are covered, where upside down counts as
/// near, too: two opposite poses leave the turn about gravity open. The first pose is as the body is held, so there is
/// nothing to aim at before it.
[[nodiscard]] std::optional<Vector3d> farthestDirection(const std::vector<Vector3d>& covered);

}  // namespace skincal
