#include "core/geometry/random.h"

#include <cmath>
#include <stdexcept>

namespace skincal {
namespace {

// FNV-1a: spreads a purpose's name over 64 bits.
std::uint64_t hashName(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    return hash;
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view purpose)
    : engine_(seed * 0x9e3779b97f4a7c15ULL ^ hashName(purpose)) {}

double Random::uniform() {
    return static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double Random::uniform(double low, double high) {
    return low + (high - low) * uniform();
}

double Random::normal() {
    // Marsaglia's polar method; it yields two at a time.
    if (hasSpare_) {
        hasSpare_ = false;
        return spare_;
    }
    for (;;) {
        const double x = uniform(-1, 1);
        const double y = uniform(-1, 1);
        const double s = x * x + y * y;
        if (s >= 1 || s == 0)
            continue;
        const double scale = std::sqrt(-2 * std::log(s) / s);
        spare_ = y * scale;
        hasSpare_ = true;
        return x * scale;
    }
}

std::size_t Random::index(std::size_t size) {
    if (size == 0)
        throw std::logic_error("Random::index of an empty range");
    return static_cast<std::size_t>(uniform() * static_cast<double>(size));
}

Eigen::Vector3d Random::normal3() {
    const double x = normal();
    const double y = normal();
    const double z = normal();
    return {x, y, z};
}

Eigen::Vector3d Random::direction() {
    for (;;) {
        const Eigen::Vector3d v = normal3();
        if (v.norm() > 1e-9)
            return v.normalized();
    }
}

Eigen::Matrix3d Random::rotation() {
    const double w = normal();
    const Eigen::Vector3d v = normal3();
    return Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized().toRotationMatrix();
}

}  // namespace skincal
