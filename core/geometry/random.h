#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <string_view>

namespace skincal {

/// Seeded random numbers that come out the same with every standard library: the distributions of <random> do not
/// promise that, its engines do.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    /// A stream of its own for each purpose, so that drawing more of one does not shift the others.
    Random(std::uint64_t seed, std::string_view purpose);

    [[nodiscard]] std::uint64_t bits() { return engine_(); }
    [[nodiscard]] double uniform();                         ///< [0, 1)
    [[nodiscard]] double uniform(double low, double high);  ///< [low, high)
    [[nodiscard]] double normal();                          ///< mean 0, standard deviation 1
    [[nodiscard]] std::size_t index(std::size_t size);      ///< 0 … size-1
    [[nodiscard]] Eigen::Vector3d normal3();                ///< three independent normal()
    [[nodiscard]] Eigen::Vector3d direction();              ///< uniform on the unit sphere
    [[nodiscard]] Eigen::Matrix3d rotation();               ///< uniform on SO(3)

  private:
    std::mt19937_64 engine_;
    double spare_ = 0;
    bool hasSpare_ = false;
};

}  // namespace skincal
