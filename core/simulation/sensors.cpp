#include "core/geometry/random.h"
#include "core/simulation/world.h"

namespace skincal {

std::vector<GravityReading> simulateGravity(const World& world) {
    const SensorOptions& options = world.scenario.sensors;
    Random chips(world.seed, "accelerometers");
    Random noise(world.seed, "accelerometer noise");
    std::vector<GravityReading> readings;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const Vector3d bias = options.bias * chips.normal3();
        const Vector3d scale = Vector3d::Ones() + options.scale * chips.normal3();
        const Matrix3d misalignment = so3Exp(options.misalignment * chips.normal3());
        for (std::size_t p = 0; p < world.gravity_r.size(); ++p) {
            const Vector3d ideal = misalignment * (world.T_r_u[u].linear().transpose() * world.gravity_r[p]);
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
