#include "core/geometry/random.h"
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

std::vector<GravityReading> simulateGravity(const World& world) {
    const SensorOptions& options = world.scenario.sensors;
    Random chips(world.seed, "accelerometers");
    Random noise(world.seed, "accelerometer noise");
    std::vector<GravityReading> readings;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const Vector3d bias = options.bias * chips.normal3();
        const Vector3d scale = Vector3d::Ones() + options.scale * chips.normal3();
        const Matrix3d misalignment = so3Exp(options.misalignment * chips.normal3());
        const Isometry3d& T_r_u = poseAtGravity(world, u);
        for (std::size_t p = 0; p < world.gravity_r.size(); ++p) {
            Vector3d felt_r = world.gravity_r[p];
            Vector3d own_u = Vector3d::Zero();
            if (const ShakenPose* shaken = shakenPose(world, p)) {
                felt_r += shaken->acceleration_r;
                own_u = shaken->acceleration_u[u];
            }
            const Vector3d ideal = misalignment * (T_r_u.linear().transpose() * felt_r + own_u);
            GravityReading reading;
            reading.pose = static_cast<int>(p);
            reading.module = world.skin.modules[u].id;
            reading.acceleration = scale.cwiseProduct(ideal) + bias + options.noise * noise.normal3();
            readings.push_back(reading);
        }
    }
    return readings;
}

}  // namespace skincal
