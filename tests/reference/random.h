#pragma once

// Random numbers, vectors and matrices for tests. Repeatable: same seed, same values.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <random>

namespace firn::reference {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }  // both included

  // Components in [-size, size].
  Eigen::Vector3d vector(double size = 1) {
    const double x = uniform(-size, size), y = uniform(-size, size), z = uniform(-size, size);
    return {x, y, z};
  }
  Eigen::Matrix3d matrix(double size = 1) {
    Eigen::Matrix3d result;
    for (int column = 0; column < 3; ++column) result.col(column) = vector(size);
    return result;
  }
  // Uniform over all directions.
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d candidate = vector();
      if (candidate.norm() > 0.1 && candidate.norm() <= 1) return candidate.normalized();
    }
  }
  Eigen::Quaterniond orientation() { return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(-3, 3), direction())); }
  Eigen::Matrix3d rotation() { return orientation().toRotationMatrix(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace firn::reference
