#include "core/rig/touch_field.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/random.h"

namespace skincal {
namespace {

constexpr double kFingertip = 0.008;      // m
constexpr double kProximityReach = 0.05;  // m
constexpr double kForceReach = 0.015;     // m
constexpr double kBehind = 0.01;          // m
constexpr double kHand = 33;              // degrees Celsius
constexpr double kRoom = 24;              // degrees Celsius, of a skin that is switched on
constexpr double kWarmUp = 4;             // s, time constant

double nearness(double distance) {
    const double s = std::clamp((kProximityReach - distance) / (kProximityReach - kFingertip), 0.0, 1.0);
    return s * s * (3 - 2 * s);
}

double pressure(double distance) {
    const double s = 1 - distance * distance / (kForceReach * kForceReach);
    return s > 0 ? s * s : 0;
}

}  // namespace

TouchField::TouchField(std::shared_ptr<const World> world) : world_(std::move(world)) {
    Random random(world_->seed, "warmth");
    modules_.resize(world_->T_r_u.size());
    for (ModuleTouch& module : modules_) {
        module.temperature = kRoom + 0.5 * random.normal();
        ambient_.push_back(module.temperature);
    }
}

void TouchField::advance(const std::optional<Contact>& contact, double seconds) {
    for (ModuleTouch& module : modules_) {
        module.proximity = 0;
        module.force = {};
    }
    if (contact)
        feel(*contact);
    const double stays = std::exp(-seconds / kWarmUp);
    for (std::size_t u = 0; u < modules_.size(); ++u) {
        // Only what touches warms, not what is near.
        const double touching = std::pow(modules_[u].proximity, 4);
        const double goal = ambient_[u] + touching * (kHand - ambient_[u]);
        modules_[u].temperature = goal + stays * (modules_[u].temperature - goal);
    }
}

void TouchField::feel(const Contact& contact) {
    double shares = 0;
    for (std::size_t u = 0; u < modules_.size(); ++u) {
        const Vector3d p_u = world_->T_r_u[u].inverse() * contact.point_r;
        if (p_u.z() < -kBehind || p_u.norm() > 2 * kProximityReach)
            continue;
        const auto& sensors = world_->trueTemplate(u).sensors;
        const auto proximity =
            std::find_if(sensors.begin(), sensors.end(), [](const SensorSite& s) { return s.kind == "proximity"; });
        const Vector3d eye_u = proximity == sensors.end() ? Vector3d::Zero() : proximity->position;
        modules_[u].proximity = nearness((p_u - eye_u).norm());
        std::size_t cell = 0;
        for (const SensorSite& sensor : sensors) {
            if (sensor.kind != "force" || cell >= modules_[u].force.size())
                continue;
            modules_[u].force.at(cell) = pressure((p_u - sensor.position).norm());
            shares += modules_[u].force.at(cell);
            ++cell;
        }
    }
    const double scale = contact.force / std::max(1.0, shares);
    for (ModuleTouch& module : modules_) {
        for (double& force : module.force)
            force *= scale;
    }
}

}  // namespace skincal
