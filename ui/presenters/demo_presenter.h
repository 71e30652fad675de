#pragma once

#include <QObject>
#include <QTimer>
#include <array>

#include "ui/presenters/tactile_picture.h"
#include "ui/presenters/workbench.h"

namespace skincal {

[[nodiscard]] QString nameOf(Quantity quantity);
/// Empty for proximity, which has none.
[[nodiscard]] QString unitOf(Quantity quantity);
/// With its unit, as a reading or, with no needless digits, as the end of a scale.
[[nodiscard]] QString textOf(double value, Quantity quantity);
[[nodiscard]] QString endOf(double value, Quantity quantity);

/// What the skin feels: now, or as long as TactileHistory::kSpan ago. The stream runs while the page is shown; the
/// newest is looked at 30 times a second at most, however fast samples come.
class DemoPresenter : public QObject {
    Q_OBJECT
  public:
    using Time = TactileHistory::Time;

    static constexpr std::size_t kTraces = 4;
    static constexpr int kUpdate_ms = 34;

    explicit DemoPresenter(Workbench& workbench, QObject* parent = nullptr);

    void setActive(bool active);
    [[nodiscard]] bool isActive() const { return isActive_; }
    /// Whether samples are asked for: the page is shown and the skin is there.
    [[nodiscard]] bool isStreaming() const { return isActive_ && workbench_.isSkinReady(); }

    void setQuantity(Quantity quantity);
    [[nodiscard]] Quantity quantity() const { return quantity_; }

    /// Empty before the first sample and without modules.
    [[nodiscard]] const TactilePicture& picture() const { return picture_; }
    [[nodiscard]] bool hasSamples() const { return history_ && history_->size() > 0; }
    [[nodiscard]] bool hasBody() const;
    /// What to do, or what is missing.
    [[nodiscard]] QString instruction() const;

    /// While it is not live nothing is recorded, so that what is looked at stays.
    void setLive(bool live);
    [[nodiscard]] bool isLive() const { return !ago_.has_value(); }
    /// Shows the past, the newest at 0; as far as it goes back.
    void showAgo(Time ago);
    [[nodiscard]] Time ago() const { return ago_.value_or(Time::zero()); }
    /// How far the past goes back.
    [[nodiscard]] Time span() const;

    /// Modules whose values are shown over time; each keeps its place, nothing where a place is free.
    using Traced = std::array<std::optional<ModuleId>, kTraces>;
    [[nodiscard]] const Traced& traced() const { return traced_; }
    /// Whether modules are traced as they are touched.
    void setFollowing(bool following);
    [[nodiscard]] bool isFollowing() const { return isFollowing_; }
    /// This one is traced, or no longer; from now on the operator chooses.
    void toggleTraced(ModuleId module);
    /// In the order of places.
    [[nodiscard]] std::vector<std::pair<std::size_t, Trace>> traces(std::size_t whiles) const;

    [[nodiscard]] bool canTouch() const {
        const RigHands* hands = workbench_.handsOnSkin();
        return hands != nullptr && hands->touch;
    }
    /// N, of touch().
    void setForce(double force);
    [[nodiscard]] double force() const { return force_; }
    /// The rig's hand presses there until release(). Whoever touches wants to see it: live again.
    void touch(ModuleId module, const Vector3d& point_u);
    void release();

  signals:
    void updated();       ///< 30 times a second at most
    void stateChanged();  ///< all but what the skin feels

  private:
    void attachDevice();
    void takeBody();
    void takeSample(const TactileSample& sample);
    void refresh();
    void followTouches();

    Workbench& workbench_;
    std::shared_ptr<const BodyModel> body_;  ///< without poses while there is no solution
    std::optional<TactileHistory> history_;
    TactilePicture picture_;
    QTimer timer_;
    Quantity quantity_ = Quantity::Force;
    std::optional<Time> ago_;
    Traced traced_{};
    std::array<Time, kTraces> touchedAt_{};
    double force_ = 4;
    bool isFollowing_ = true;
    bool isActive_ = false;
    bool isStale_ = false;
};

}  // namespace skincal
