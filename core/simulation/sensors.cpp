#include "core/geometry/random.h"
#include "core/simulation/simulated_accelerometer.h"
#include "core/simulation/world.h"

namespace skincal {
namespace {

const ShakenPose* shakenPose(const World& world, std::size_t pose) {
    for (const ShakenPose& shaken : world.faults.shakenPoses) {
        if (shaken.pose == pose)
            return &shaken;
    }
    return nullptr;
}

}  // namespace

Vector3d SimulatedAccelerometer::read(const Vector3d& force_u, Random& chance) const {
    const Vector3d ideal = misalignment * force_u;
    return scale.cwiseProduct(ideal) + bias + noise * chance.normal3();
}

std::vector<SimulatedAccelerometer> accelerometersOf(const World& world) {
    const SensorOptions& options = world.scenario.sensors;
    Random chips(world.seed, "accelerometers");
    std::vector<SimulatedAccelerometer> sensors(world.T_r_u.size());
    for (SimulatedAccelerometer& sensor : sensors) {
        sensor.bias = options.bias * chips.normal3();
        sensor.scale = Vector3d::Ones() + options.scale * chips.normal3();
        sensor.misalignment = so3Exp(options.misalignment * chips.normal3());
        sensor.noise = options.noise;
    }
    return sensors;
}

std::vector<GravityReading> simulateGravity(const World& world) {
    const auto sensors = accelerometersOf(world);
    Random noise(world.seed, "accelerometer noise");
    std::vector<GravityReading> readings;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const Isometry3d& T_r_u = poseAtGravity(world, u);
        for (std::size_t p = 0; p < world.gravity_r.size(); ++p) {
            Vector3d felt_r = world.gravity_r[p];
            Vector3d own_u = Vector3d::Zero();
            if (const ShakenPose* shaken = shakenPose(world, p)) {
                felt_r += shaken->acceleration_r;
                own_u = shaken->acceleration_u[u];
            }
            GravityReading reading;
            reading.pose = static_cast<int>(p);
            reading.module = world.skin.modules[u].id;
            reading.acceleration = sensors[u].read(T_r_u.linear().transpose() * felt_r + own_u, noise);
            readings.push_back(reading);
        }
    }
    return readings;
}

}  // namespace skincal
