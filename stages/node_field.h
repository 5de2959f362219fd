#pragma once

// Density and velocity of particles on the nodes of a regular grid, kept only where snow is.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace firn::stages {

// Blocks of 8 x 8 x 8 nodes. Node (i, j, k), which may be negative, lies at origin + cell (i, j, k).
struct NodeField {
  static constexpr int edge = 8, size = edge * edge * edge;
  struct Block {
    std::array<int, 3> first;                         // its lowest node, a multiple of 8 along every axis
    std::array<float, size> density;                  // x runs fastest, then y; kg/m3
    std::array<std::array<float, 3>, size> velocity;  // m/s
  };
  Eigen::Vector3d origin{0, 0, 0};
  double cell = 1;  // m
  std::vector<Block> blocks;

  [[nodiscard]] static std::size_t index(int x, int y, int z) {  // NOLINTNEXTLINE(bugprone-misplaced-widening-cast): at most 512
    return static_cast<std::size_t>((z * edge + y) * edge + x);
  }
};

// Mass and momentum spread by the quadratic B-spline, as mpm.particles_to_grid does with `kernel: quadratic` [M 17-20].
// `position` and `velocity`: three floats a particle; `mass`: one.
NodeField node_field(std::span<const float> position, std::span<const float> velocity, std::span<const float> mass,
                     const Eigen::Vector3d& origin, double cell);

// The velocity at places, three floats each: the mean over the eight nodes about it by their density and nearness, and where there
// is no snow about, over the whole field.
std::vector<std::array<float, 3>> velocity_at(const NodeField& field, std::span<const Eigen::Vector3d> places);

// All nodes from (0, 0, 0) to `last`, x fastest; 0 where there is no snow.
struct DenseField {
  std::vector<float> density, velocity;
};
DenseField dense(const NodeField& field, const std::array<int, 3>& last);

}  // namespace firn::stages
