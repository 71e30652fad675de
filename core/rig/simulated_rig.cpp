#include "core/rig/simulated_rig.h"

#include <algorithm>
#include <stdexcept>

namespace skincal {
namespace {

std::shared_ptr<const World> worldOf(const Scenario& scenario, std::uint64_t seed) {
    auto world = std::make_shared<World>(buildWorld(scenario, seed));
    if (world->T_r_v.empty())
        throw std::logic_error("SimulatedRig: a scenario needs a view");
    return world;
}

Vector3d middleOf(const World& world) {
    Vector3d sum = Vector3d::Zero();
    for (const Isometry3d& T_r_u : world.T_r_u)
        sum += T_r_u.translation();
    return sum / static_cast<double>(world.T_r_u.size());
}

}  // namespace

SimulatedRig::SimulatedRig(const Scenario& scenario, std::uint64_t seed, QObject* parent)
    : QObject(parent),
      world_(worldOf(scenario, seed)),
      body_(Vector3d::UnitZ(), middleOf(*world_), clock_.now(), seed),
      camera_(world_->T_r_v.front()),
      commands_{{clock_.now(), {}}} {}

void SimulatedRig::turnBody(const Vector3d& up_r) {
    if (!up_r.allFinite() || up_r.norm() < 1e-9)
        throw std::logic_error("SimulatedRig: no direction to turn the body to");
    body_.turn(up_r.normalized(), now());
    clock_.at(body_.restsAt(), this, [this, turn = ++turns_] {
        if (turn == turns_)
            emit bodyRested();
    });
}

void SimulatedRig::moveCamera(const Isometry3d& T_r_v) {
    if (!isRigid(T_r_v))
        throw std::logic_error("SimulatedRig: no pose to move the camera to");
    camera_.move(T_r_v, now());
    restCameraAt(camera_.restsAt());
}

void SimulatedRig::knockCamera(double pixels) {
    const bool wasMoving = !isCameraAtRest();
    const Matrix3d R_v_k = so3Exp(pixels / world_->scenario.camera.fx * Vector3d(0.6, -0.8, 0));
    const Isometry3d T_r_v = cameraPose();
    camera_.jump(makeIsometry(T_r_v.linear() * R_v_k, T_r_v.translation()), now());
    if (wasMoving)
        restCameraAt(now());
}

void SimulatedRig::restCameraAt(Time when) {
    clock_.at(when, this, [this, move = ++moves_] {
        if (move == moves_)
            emit cameraRested();
    });
}

void SimulatedRig::holdBoard(const BoardPlan& plan) {
    board_.emplace(plan, world_->scenario.camera, now());
}

void SimulatedRig::touch(const Vector3d& point_r, double force) {
    if (!point_r.allFinite() || !(force >= 0))
        throw std::logic_error("SimulatedRig: no touch that can be felt");
    contact_ = Contact{point_r, force};
}

void SimulatedRig::release() {
    contact_.reset();
}

void SimulatedRig::pullSkin() {
    if (!skinPlugged_)
        return;
    skinPlugged_ = false;
    light({});
    emit skinPulled();
}

void SimulatedRig::plugSkin() {
    skinPlugged_ = true;
}

void SimulatedRig::pullCamera() {
    if (!cameraPlugged_)
        return;
    cameraPlugged_ = false;
    emit cameraPulled();
}

void SimulatedRig::plugCamera() {
    cameraPlugged_ = true;
}

void SimulatedRig::setCameraLatency(std::chrono::milliseconds latency) {
    if (latency < shutter_.length())
        throw std::logic_error("SimulatedRig: the camera can't see into the future");
    latency_ = latency;
}

void SimulatedRig::setShutter(const Shutter& shutter) {
    if (shutter.open.count() < 0 || shutter.readout.count() < 0 || shutter.length() > latency_)
        throw std::logic_error("SimulatedRig: no such shutter");
    shutter_ = shutter;
}

std::deque<SimulatedRig::Command>::const_iterator SimulatedRig::commandAt(Time time) const {
    const auto later = std::upper_bound(commands_.begin(), commands_.end(), time - latency_,
                                        [](Time shown, const Command& command) { return shown < command.time; });
    return later == commands_.begin() ? later : std::prev(later);
}

std::vector<LitUntil> SimulatedRig::litDuring(Time time) const {
    std::vector<LitUntil> during;
    const Time begin = time - latency_;
    for (auto command = commandAt(time); command != commands_.end(); ++command) {
        if (!during.empty() && command->time >= begin + shutter_.length())
            break;
        if (!during.empty())
            during.back().until = command->time - begin;
        during.push_back({command->lit, shutter_.length()});
    }
    return during;
}

void SimulatedRig::light(std::vector<LitModule> lit) {
    const Time time = now();
    // Nobody asks for exposures of long ago.
    constexpr std::chrono::seconds kLate{10};
    while (commands_.size() > 1 && commands_[1].time + latency_ + kLate < time)
        commands_.pop_front();
    commands_.push_back({time, std::move(lit)});
}

}  // namespace skincal
