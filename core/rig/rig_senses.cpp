#include "core/rig/rig_senses.h"

#include <algorithm>

namespace skincal {
namespace {

constexpr double kProximityNoise = 0.004;
constexpr double kForceNoise = 0.01;        // N
constexpr double kTemperatureNoise = 0.03;  // degrees

}  // namespace

RigSenses::RigSenses(std::shared_ptr<const World> world)
    : world_(std::move(world)), accelerometers_(accelerometersOf(*world_)), touch_(world_) {}

Vector3d RigSenses::acceleration(std::size_t module, const BodyForces& forces, Random& chance) const {
    const Isometry3d& T_r_u = poseAtGravity(*world_, module);
    const Vector3d chip_u = world_->trueTemplate(module).accelerometer.value_or(Vector3d::Zero());
    return accelerometers_[module].read(T_r_u.linear().transpose() * forces.at(T_r_u * chip_u), chance);
}

void RigSenses::feel(const std::optional<Contact>& contact, Time time) {
    const std::chrono::duration<double> passed = time - feltAt_.value_or(time);
    touch_.advance(contact, std::max(0.0, passed.count()));
    feltAt_ = time;
}

RigSenses::Touch RigSenses::touch(std::size_t module, Random& chance) const {
    const ModuleTouch& felt = touch_.modules()[module];
    Touch touch;
    touch.proximity = std::clamp(felt.proximity + kProximityNoise * chance.normal(), 0.0, 1.0);
    const auto& sensors = world_->trueTemplate(module).sensors;
    const auto cells = std::count_if(sensors.begin(), sensors.end(), [](const auto& s) { return s.kind == "force"; });
    for (std::size_t i = 0; i < std::min<std::size_t>(touch.force.size(), static_cast<std::size_t>(cells)); ++i)
        touch.force.at(i) = std::max(0.0, felt.force.at(i) + kForceNoise * chance.normal());
    touch.temperature = felt.temperature + kTemperatureNoise * chance.normal();
    return touch;
}

}  // namespace skincal
