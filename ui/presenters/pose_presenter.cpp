#include "ui/presenters/pose_presenter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/estimation/edge_forecast.h"

namespace skincal {
namespace {

/// Upside down is not the same pose, but tells hardly more of a rotation: it counts as if it were so far away.
constexpr double kUpsideDown = 30 * kDegree;
/// Two poses nearer than this are one.
constexpr double kSamePose = 12 * kDegree;
constexpr std::chrono::microseconds kFrame{33'000};

}  // namespace

std::optional<Vector3d> farthestDirection(const std::vector<Vector3d>& covered) {
    if (covered.empty())
        return std::nullopt;
    // A spiral of equal steps in z and golden turns. Coarse on purpose: the target should not jump from pose to pose.
    constexpr int kDirections = 96;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    std::optional<Vector3d> best;
    double farthest = -1;
    for (int i = 0; i < kDirections; ++i) {
        const double z = 1 - (2 * i + 1.0) / kDirections;
        const double radius = std::sqrt(1 - z * z);
        const Vector3d direction(radius * std::cos(golden * i), radius * std::sin(golden * i), z);
        double nearest = std::numbers::pi;
        for (const Vector3d& other : covered) {
            const double angle = std::acos(std::clamp(direction.dot(other), -1.0, 1.0));
            nearest = std::min({nearest, angle, std::numbers::pi - angle + kUpsideDown});
        }
        if (nearest > farthest + 1e-9) {
            farthest = nearest;
            best = direction;
        }
    }
    return best;
}

PosePresenter::PosePresenter(Workbench& workbench, QObject* parent)
    : QObject(parent), workbench_(workbench), poses_(workbench) {
    const Session& session = workbench.session();
    connect(&session, &Session::skinChanged, this, &PosePresenter::refresh);
    connect(&session, &Session::posesChanged, this, &PosePresenter::refresh);
    connect(&session, &Session::decisionsChanged, this, &PosePresenter::refresh);
    connect(&session, &Session::solutionChanged, this, &PosePresenter::stateChanged);
    QUndoStack& undo = workbench.session().undoStack();
    connect(&undo, &QUndoStack::indexChanged, this, [this, &undo] { isHeld_ = undo.canRedo(); });
    connect(&workbench, &Workbench::skinChosen, this, &PosePresenter::attachDevice);
    connect(&workbench, &Workbench::skinReadyChanged, this, [this] { setActive(isActive_); });
    if (workbench.skin() != nullptr)
        attachDevice();
    refresh();
}

void PosePresenter::setActive(bool active) {
    isActive_ = active;
    const bool isWatching = active && workbench_.isSkinReady();
    if (workbench_.skin() != nullptr)
        workbench_.skin()->streamAcceleration(isWatching);
    if (!isWatching) {
        up_.reset();
        if (meter_)
            meter_->clear();
    }
    isWatching ? handle(pose_capture::Start{}) : handle(pose_capture::Stop{});
}

void PosePresenter::setAutomatic(bool automatic) {
    options_.isAutomatic = automatic;
    emit stateChanged();
}

void PosePresenter::captureNow() {
    handle(pose_capture::CaptureNow{now_});
}

void PosePresenter::turnToTarget() {
    if (const RigHands* hands = workbench_.handsOnSkin(); hands != nullptr && reference_ && target())
        hands->turnBody(*reference_, *target());
}

std::optional<double> PosePresenter::movement() const {
    return meter_ ? meter_->movement() : std::nullopt;
}

double PosePresenter::restDone() const {
    if (state_.phase == PoseCapture::Phase::Captured)
        return 1;
    if (state_.phase != PoseCapture::Phase::Resting)
        return 0;
    const std::chrono::duration<double> rested = now_ - state_.since;
    return std::clamp(rested / std::chrono::duration<double>(options_.rest), 0.0, 1.0);
}

std::optional<Vector3d> PosePresenter::target() const {
    return farthestDirection(covered_);
}

std::optional<double> PosePresenter::angleToTarget() const {
    const auto to = target();
    if (!to || !up_)
        return std::nullopt;
    return std::acos(std::clamp(to->dot(*up_), -1.0, 1.0));
}

PoseVerdict PosePresenter::verdict() const {
    // Two give rotations, three tell where one of them is off.
    constexpr std::size_t kFewest = 3;
    if (forecast_.empty())
        return PoseVerdict::None;
    const auto& sigma = forecast_.back();
    if (!sigma || forecast_.size() < kFewest)
        return PoseVerdict::TooFew;
    if (*sigma > kGoodEdge)
        return PoseVerdict::NotExact;
    // The forecast is of one module; the body knows them all.
    const auto& solution = workbench_.session().solution();
    const bool isAlike = solution && solution->revision == workbench_.session().revision() &&
                         std::any_of(solution->shortfalls.begin(), solution->shortfalls.end(),
                                     [](const Shortfall& s) { return s.kind == Shortfall::Kind::PosesAlike; });
    return isAlike ? PoseVerdict::TooAlike : PoseVerdict::Enough;
}

QString PosePresenter::verdictText() const {
    const auto figure = [&] { return QString::number(*forecast_.back() / kDegree, 'f', 1); };
    const QString good = QString::number(kGoodEdge / kDegree, 'f', 0);
    switch (verdict()) {
        case PoseVerdict::None:
            return {};
        case PoseVerdict::TooFew:
            return tr("Not enough yet: three poses are the least, each with another side up.");
        case PoseVerdict::NotExact:
            return tr("Not enough yet: an edge will be known to %1°, %2° is good.").arg(figure(), good);
        case PoseVerdict::TooAlike:
            return tr("Not enough yet: for some modules the poses are too alike.");
        default:
            return tr("Enough: an edge will be known to %1°. Further poses still help a little.").arg(figure());
    }
}

void PosePresenter::attachDevice() {
    connect(workbench_.skin(), &SkinDevice::accelerationArrived, this, &PosePresenter::takeSample);
}

void PosePresenter::takeSample(const AccelerationSample& sample) {
    if (!isActive_ || !meter_)
        return;
    std::vector<std::optional<Vector3d>> accelerations(modules_.size());
    for (const AccelerationSample::Reading& reading : sample.readings) {
        const auto found = index_.find(reading.module);
        if (found != index_.end())
            accelerations[found->second] = reading.acceleration;
    }
    meter_->add(sample.time, accelerations);
    now_ = sample.time;
    const auto& own = accelerations[index_.at(*reference_)];
    if (own && own->norm() > 0)
        up_ = own->normalized();
    pose_capture::Sample event{sample.time, meter_->isAtRest(), true};
    if (event.isAtRest) {
        const auto means = meter_->meansSince(sample.time - meter_->window(), 0);
        isKnownPose_ = angleToNearestPose(countingReadings_, means) <= kSamePose;
        event.isNew = !isHeld_ && !isKnownPose_;
    } else if (meter_->movement()) {
        isKnownPose_ = false;
        isHeld_ = false;
    }
    handle(event);
    if (now_ < lastShown_ || now_ - lastShown_ >= kFrame) {
        lastShown_ = now_;
        emit sampled();
    }
}

void PosePresenter::handle(const pose_capture::Event& event) {
    const auto [state, effects] = step(state_, event, options_);
    const bool isOther = state.phase != state_.phase;
    state_ = state;
    for (const pose_capture::Effect& effect : effects)
        std::visit(Overloaded{[&](const pose_capture::Capture& what) { capture(what.from); },
                              [&](pose_capture::Refuse) { emit refused(); }},
                   effect);
    if (isOther)
        emit stateChanged();
}

void PosePresenter::capture(std::chrono::microseconds from) {
    auto readings = meter_->meansSince(from, 0);
    if (!readings.empty())
        emit captured(workbench_.session().addPose(std::move(readings)));
}

void PosePresenter::refresh() {
    Session& session = workbench_.session();
    const Skin& skin = session.measured().skin;
    std::vector<ModuleId> modules;
    for (const SkinModule& module : skin.modules)
        modules.push_back(module.id);
    if (modules != modules_) {
        modules_ = std::move(modules);
        index_ = skin.indexById();
        meter_ = modules_.empty() ? nullptr : std::make_unique<StillnessMeter>(modules_, stillness_);
        reference_.reset();
        if (!modules_.empty())
            reference_ = *std::min_element(modules_.begin(), modules_.end());
        up_.reset();
    }
    countingReadings_.clear();
    covered_.clear();
    forecast_.clear();
    std::vector<Vector3d> gravity;
    for (const GravityReading& reading : session.measured().gravity) {
        if (session.decisions().droppedPoses.contains(reading.pose))
            continue;
        countingReadings_.push_back(reading);
        if (reference_ && reading.module == *reference_ && reading.acceleration.norm() > 0) {
            covered_.push_back(reading.acceleration.normalized());
            gravity.push_back(reading.acceleration);
            forecast_.push_back(expectedEdgeSigma(gravity));
        }
    }
    emit stateChanged();
}

}  // namespace skincal
