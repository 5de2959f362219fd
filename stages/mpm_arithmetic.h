#pragma once

// How many additions and multiplications kernels of particles take, as the formulas of M 3.4 stand, node by node; a division or a
// root counts as one. Kernels that separate the axes, or read a value once for several nodes, do with less.

#include <vector>

#include "graph/spec.h"

namespace firn::stages::mpm::arithmetic {

constexpr double splines = 3 * 9;                   // of one node, three axes: N and N'
constexpr double weight = 2;                        // product of three splines
constexpr double weight_gradient = 6;               // three such products
constexpr double sums = 1 + 2 + 6;                  // m w; and mass and momentum with it
constexpr double force = 15 + 3;                    // 3 x 3 matrix by vector, added up
constexpr double interpolation = 6;                 // of a vector: w v, added up
constexpr double gradient = 9 + 9;                  // of a vector: v (grad w)^T, added up
constexpr double node_solve = 3 + 3 + 9;            // momentum and force by mass; v + dt (f / m + g)
constexpr double affine_momentum = 3 + 15 + 3 + 6;  // x_i - x_p; A (x_i - x_p); m v + that; by weight, added up

constexpr double matrix_product = 27 + 18;
constexpr double sweep = matrix_product + 24 + 6 * 5 + 3 * (22 + 28);         // F V, V from its quaternion, F^T F, three rotations
constexpr double svd = 2 * sweep + 3 * (12 + 28) + 24 + matrix_product + 30;  // snow that is hardly deformed takes two sweeps
constexpr double trial = matrix_product + 9 + 9;                              // (I + dt grad v) F
constexpr double clamped = 9 + matrix_product + 8;                            // U S' V^T, J_P
constexpr double stress = 9 + matrix_product + 2 * 9 + 20;                    // 2 mu (F - R) F^T + lambda (J - 1) J; hardening

// For each particle: `once`, and `per_node` for each of the 64 or 27 nodes about it.
std::vector<graph::Arithmetic> per_particle(double per_node, double once = 0);

}  // namespace firn::stages::mpm::arithmetic
