#pragma once

// The grid and its weights [M 17-20]: what a particle at a point shares with each node around it.

#include <Eigen/Core>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace firn::reference {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3i;

// B-splines: 4 nodes per axis (64 in all), or 3 (27).
enum class Kernel { cubic, quadratic };

inline int support(Kernel kernel) { return kernel == Kernel::cubic ? 4 : 3; }

// N(u), u = (x_p - x_i) / h along one axis.
inline double weight(Kernel kernel, double u) {
  const double a = std::abs(u);
  if (kernel == Kernel::cubic) {
    if (a < 1) return a * a * a / 2 - a * a + 2.0 / 3;
    if (a < 2) return -a * a * a / 6 + a * a - 2 * a + 4.0 / 3;
    return 0;
  }
  if (a < 0.5) return 0.75 - a * a;
  if (a < 1.5) return (1.5 - a) * (1.5 - a) / 2;
  return 0;
}

// N'(u): per unit of u, so a gradient in 1/m is this divided by h.
inline double weight_derivative(Kernel kernel, double u) {
  const double a = std::abs(u);
  const double sign = u < 0 ? -1 : 1;
  if (kernel == Kernel::cubic) {
    if (a < 1) return 1.5 * u * a - 2 * u;
    if (a < 2) return -u * a / 2 + 2 * u - 2 * sign;
    return 0;
  }
  if (a < 0.5) return -2 * u;
  if (a < 1.5) return -sign * (1.5 - a);
  return 0;
}

// Nodes at min + h (i, j, k), counted with i fastest.
struct Grid {
  Vector3d min{0, 0, 0};  // m
  double h = 1;           // m
  Vector3i nodes{0, 0, 0};

  [[nodiscard]] int count() const { return nodes.prod(); }
  [[nodiscard]] int index(int i, int j, int k) const { return i + nodes.x() * (j + nodes.y() * k); }
  [[nodiscard]] Vector3d position(int i, int j, int k) const { return min + h * Vector3d(i, j, k); }
  [[nodiscard]] Vector3d position(int node) const {
    return position(node % nodes.x(), node / nodes.x() % nodes.y(), node / (nodes.x() * nodes.y()));
  }
};

// One node as a particle sees it.
struct Neighbor {
  int node;
  double weight;      // w_ip
  Vector3d gradient;  // grad w_ip with respect to the particle's position, 1/m
};

// All nodes of the kernel's support around `point`. Throws std::out_of_range where one of them is not on the grid.
inline std::vector<Neighbor> neighbors(const Grid& grid, Kernel kernel, const Vector3d& point) {
  const Vector3d u = (point - grid.min) / grid.h;
  const int width = support(kernel);
  const Vector3d first_node = kernel == Kernel::cubic ? Vector3d(u.array().floor() - 1) : Vector3d((u.array() - 0.5).floor());
  if (!((first_node.array() >= 0).all() && (first_node.array() + width <= grid.nodes.cast<double>().array()).all())) {
    std::ostringstream text;
    text << "point (" << point.transpose() << ") is too near the edge of the grid: all " << width
         << " nodes per axis around it must exist";
    throw std::out_of_range(text.str());
  }
  const Vector3i first = first_node.cast<int>();
  std::vector<Neighbor> result;
  result.reserve(width * width * width);
  for (int k = first.z(); k < first.z() + width; ++k) {
    for (int j = first.y(); j < first.y() + width; ++j) {
      for (int i = first.x(); i < first.x() + width; ++i) {
        const Vector3d offset = u - Vector3d(i, j, k);
        Vector3d n, slope;
        for (int axis = 0; axis < 3; ++axis) {
          n[axis] = weight(kernel, offset[axis]);
          slope[axis] = weight_derivative(kernel, offset[axis]);
        }
        const Vector3d gradient(slope.x() * n.y() * n.z(), n.x() * slope.y() * n.z(), n.x() * n.y() * slope.z());
        result.push_back({grid.index(i, j, k), n.prod(), gradient / grid.h});
      }
    }
  }
  return result;
}

}  // namespace firn::reference
