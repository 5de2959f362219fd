#pragma once

// Arithmetic that gives the same bits on every machine: random numbers as a pure function of integers (no state, no order), and
// sums of products that leave a compiler no choice of contracting them (GCC does so by default where the processor has fused
// operations).

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace firn::scene {

inline constexpr std::uint64_t golden_gamma = 0x9e3779b97f4a7c15;  // 2^64 / golden ratio, odd

// Output function of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators"): a bijection.
constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

// One draw per tuple of integers; the order of the integers matters.
constexpr std::uint64_t hash(std::initializer_list<std::uint64_t> values) {
  std::uint64_t state = 0;
  for (const std::uint64_t value : values) state = mix(state + golden_gamma * (value + 1));
  return state;
}

// Uniform in [0, 1): the upper 53 bits, exact in a double.
constexpr double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

inline double repeatable_dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::fma(a.x(), b.x(), std::fma(a.y(), b.y(), a.z() * b.z()));
}

inline Eigen::Vector3d repeatable_cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {std::fma(a.y(), b.z(), -(a.z() * b.y())), std::fma(a.z(), b.x(), -(a.x() * b.z())),
          std::fma(a.x(), b.y(), -(a.y() * b.x()))};
}

}  // namespace firn::scene
