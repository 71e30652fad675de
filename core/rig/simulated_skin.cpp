#include "core/rig/simulated_skin.h"

#include <algorithm>
#include <deque>

namespace skincal {
namespace {

using namespace std::chrono_literals;

constexpr RigClock::Time kOpen = 20ms;
constexpr RigClock::Time kFind = 5ms;
constexpr RigClock::Time kFindAll = 1200ms;
constexpr RigClock::Time kReport = 30ms;
constexpr RigClock::Time kPeriod = 10ms;
constexpr RigClock::Time kLatch = 4ms;
constexpr RigClock::Time kLate = 1s;

/// Positions in Skin::modules, each after one that it is linked to as far as that is possible.
std::vector<std::size_t> floodOrder(const Skin& skin) {
    const auto index = skin.indexById();
    std::vector<std::vector<std::size_t>> linked(skin.modules.size());
    for (const Link& link : skin.links) {
        linked[index.at(link.a)].push_back(index.at(link.b));
        linked[index.at(link.b)].push_back(index.at(link.a));
    }
    std::vector<std::size_t> order;
    std::vector<bool> seen(skin.modules.size(), false);
    for (std::size_t first = 0; first < skin.modules.size(); ++first) {
        std::deque<std::size_t> front{first};
        while (!front.empty()) {
            const std::size_t u = front.front();
            front.pop_front();
            if (seen[u])
                continue;
            seen[u] = true;
            order.push_back(u);
            front.insert(front.end(), linked[u].begin(), linked[u].end());
        }
    }
    return order;
}

}  // namespace

SimulatedSkin::SimulatedSkin(SimulatedRig& rig, QObject* parent)
    : SkinDevice(parent),
      rig_(&rig),
      world_(rig.sharedWorld()),
      senses_(world_),
      order_(floodOrder(world_->skin)),
      noise_(world_->seed, "streamed noise"),
      touchNoise_(world_->seed, "touch noise") {
    connect(&rig, &SimulatedRig::skinPulled, this, &SimulatedSkin::unplugged);
    connect(&rig, &QObject::destroyed, this, &SimulatedSkin::shut);
}

SimulatedSkin::~SimulatedSkin() {
    shut();
}

QString SimulatedSkin::name() const {
    return QStringLiteral("Simulated %1").arg(QString::fromStdString(world_->scenario.name));
}

void SimulatedSkin::at(Time when, std::function<void()> what) {
    rig_->clock().at(when, this, [this, session = session_, what = std::move(what)] {
        if (session == session_)
            what();
    });
}

void SimulatedSkin::soon(std::function<void()> what) {
    if (rig_)
        rig_->clock().at(rig_->now(), this, std::move(what));
    else
        QMetaObject::invokeMethod(this, std::move(what), Qt::QueuedConnection);
}

void SimulatedSkin::open() {
    if (state_ != State::Closed)
        return;
    if (!rig_) {
        soon([this] { emit failed(tr("no skin is plugged in")); });
        return;
    }
    state_ = State::Opening;
    ++session_;
    at(rig_->now() + kOpen, [this] {
        if (rig_->isSkinPlugged()) {
            state_ = State::Open;
            emit opened();
        } else {
            state_ = State::Closed;
            emit failed(tr("no skin is plugged in"));
        }
    });
}

void SimulatedSkin::close() {
    const bool wasOpen = isOpen();
    shut();
    if (wasOpen)
        soon([this] { emit closed(); });
}

/// Ends everything that was under way.
void SimulatedSkin::shut() {
    if (rig_ && isOpen())
        rig_->light({});
    state_ = State::Closed;
    ++session_;
    accelerationRun_ += accelerationRun_ % 2;
    tactileRun_ += tactileRun_ % 2;
}

void SimulatedSkin::unplugged() {
    if (!isOpen())
        return;
    shut();
    soon([this] {
        // The first may destroy this.
        const QPointer<SimulatedSkin> self(this);
        emit failed(tr("the skin was unplugged"));
        if (self)
            emit closed();
    });
}

void SimulatedSkin::explore() {
    if (!isOpen()) {
        soon([this] { emit failed(tr("the skin is not open")); });
        return;
    }
    ++exploration_;
    findNext(exploration_, rig_->now(), 0);
}

void SimulatedSkin::findNext(std::uint64_t exploration, Time started, std::size_t position) {
    const Time each = std::min(kFind, kFindAll / static_cast<Time::rep>(order_.size()));
    if (position == order_.size()) {
        at(started + static_cast<Time::rep>(position) * each + kReport, [this, exploration] {
            if (exploration == exploration_)
                emit explored(world_->skin);
        });
        return;
    }
    // Of very many, several in one go: fewer turns of the event loop.
    const std::size_t some = each >= 1ms ? 1 : static_cast<std::size_t>(1ms / std::max<Time>(each, 1us));
    const std::size_t end = std::min(order_.size(), position + some);
    // By the time of the first, so that being late doesn't add up.
    at(started + static_cast<Time::rep>(end) * each, [this, exploration, started, position, end] {
        if (exploration != exploration_)
            return;
        const QPointer<SimulatedSkin> self(this);
        const std::uint64_t session = session_;
        for (std::size_t i = position; i < end; ++i) {
            emit moduleFound(world_->skin.modules[order_[i]].id);
            if (!self || session != session_ || exploration != exploration_)
                return;
        }
        findNext(exploration, started, end);
    });
}

void SimulatedSkin::streamAcceleration(bool on) {
    const bool streams = accelerationRun_ % 2 == 1;
    if (!isOpen() || on == streams)
        return;
    ++accelerationRun_;
    if (on)
        tick(rig_->now() + kPeriod, &SimulatedSkin::accelerationRun_, accelerationRun_,
             &SimulatedSkin::sampleAcceleration);
}

void SimulatedSkin::streamTactile(bool on) {
    const bool streams = tactileRun_ % 2 == 1;
    if (!isOpen() || on == streams)
        return;
    ++tactileRun_;
    if (on)
        tick(rig_->now() + kPeriod, &SimulatedSkin::tactileRun_, tactileRun_, &SimulatedSkin::sampleTactile);
}

/// One sample after the other, as long as the run is the one that was started.
void SimulatedSkin::tick(Time when, std::uint64_t SimulatedSkin::*run, std::uint64_t started, Stream sample) {
    at(when, [this, when, run, started, sample] {
        if (this->*run != started)
            return;
        // First, as whoever gets the sample may destroy this.
        tick(std::max(when + kPeriod, rig_->now() - kLate), run, started, sample);
        (this->*sample)(when);
    });
}

void SimulatedSkin::sampleAcceleration(Time time) {
    const BodyForces forces = rig_->forces(time);
    AccelerationSample sample;
    sample.time = time;
    sample.readings.reserve(world_->T_r_u.size());
    for (std::size_t u = 0; u < world_->T_r_u.size(); ++u)
        sample.readings.push_back({world_->skin.modules[u].id, senses_.acceleration(u, forces, noise_)});
    emit accelerationArrived(sample);
}

void SimulatedSkin::sampleTactile(Time time) {
    senses_.feel(rig_->contact(), time);
    const BodyForces forces = rig_->forces(time);
    TactileSample sample;
    sample.time = time;
    sample.readings.reserve(world_->T_r_u.size());
    for (std::size_t u = 0; u < world_->T_r_u.size(); ++u) {
        const Vector3d read_u = senses_.acceleration(u, forces, touchNoise_);
        const RigSenses::Touch touch = senses_.touch(u, touchNoise_);
        TactileSample::Reading reading;
        reading.module = world_->skin.modules[u].id;
        reading.proximity = static_cast<float>(touch.proximity);
        for (std::size_t i = 0; i < 3; ++i) {
            reading.force.at(i) = static_cast<float>(touch.force.at(i));
            reading.acceleration.at(i) = static_cast<float>(read_u[static_cast<Eigen::Index>(i)]);
        }
        reading.temperature = static_cast<float>(touch.temperature);
        sample.readings.push_back(reading);
    }
    emit tactileArrived(sample);
}

std::uint64_t SimulatedSkin::light(const std::vector<LitModule>& lit) {
    ++token_;
    if (isOpen()) {
        rig_->light(lit);
        acknowledge(token_);
    }
    return token_;
}

std::optional<std::chrono::microseconds> SimulatedSkin::now() const {
    return rig_ ? std::optional(rig_->now()) : std::nullopt;
}

std::uint64_t SimulatedSkin::lightAt(const std::vector<LitModule>& lit, std::chrono::microseconds when) {
    ++token_;
    if (isOpen()) {
        at(when, [this, lit, token = token_] {
            if (token != token_)
                return;
            rig_->light(lit);
            acknowledge(token);
        });
    }
    return token_;
}

void SimulatedSkin::acknowledge(std::uint64_t token) {
    at(rig_->now() + kLatch, [this, token] {
        if (token == token_)
            emit lightShown(token);
    });
}

}  // namespace skincal
