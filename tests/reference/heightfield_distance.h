#pragma once

// H5b [H 3.8]: what a body displaces travels down a weighted distance transform until it is out of the footprint.

#include <cmath>
#include <queue>
#include <tuple>

#include "tests/reference/heightfield_direction.h"

namespace firn::reference {

// One step to each of the 8 neighbours; the first 4 share an edge.
struct Offset {
  int z, x;
};
inline constexpr Offset kNeighbors[8] = {{0, -1}, {0, 1}, {-1, 0}, {1, 0}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}};

// Cost of a step; a diagonal one is the Euclidean combination of its two sides.
inline double step_cost(const StepCosts& costs, const Offset& step) {
  const double along_x = step.x < 0 ? costs.left : costs.right;
  const double along_z = step.z < 0 ? costs.down : costs.up;
  if (step.z == 0) return along_x;
  if (step.x == 0) return along_z;
  return std::hypot(along_x, along_z);
}

// Cost of the cheapest way out of the overlap, per cell: 0 where D = 0, infinite where there is no way. A step costs what the body
// that owns the cell it leaves makes it cost. `costs`: per body. Exact (Dijkstra, from outside inwards).
inline Cells distance_transform(const Cells& overlap, const Owners& owner, const std::vector<StepCosts>& costs) {
  using Entry = std::tuple<double, int, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  Cells distance = Cells::Constant(overlap.rows(), overlap.cols(), std::numeric_limits<double>::infinity());
  for (int z = 0; z < overlap.rows(); ++z) {
    for (int x = 0; x < overlap.cols(); ++x) {
      if (overlap(z, x) > 0) continue;
      distance(z, x) = 0;
      open.emplace(0, z, x);
    }
  }
  while (!open.empty()) {
    const auto [reached, z, x] = open.top();
    open.pop();
    if (reached > distance(z, x)) continue;
    for (const Offset& step : kNeighbors) {
      const int from_z = z - step.z, from_x = x - step.x;
      if (!inside(overlap, from_z, from_x) || overlap(from_z, from_x) <= 0) continue;
      const double candidate = reached + step_cost(costs.at(owner(from_z, from_x)), step);
      if (candidate >= distance(from_z, from_x)) continue;
      distance(from_z, from_x) = candidate;
      open.emplace(candidate, from_z, from_x);
    }
  }
  return distance;
}

// Equal within a relative 1e-6 counts as equal.
inline bool strictly_lower(double a, double b) { return a < b * (1 - 1e-6); }

// What arrives where. From the highest level down, every cell with a distance hands what it has, its own and what came, in equal
// parts to its strictly lower neighbours (4 or 8). A cell without such a neighbour keeps it.
inline Amounts distribute_distance(const Amounts& displaced, const Cells& distance, int neighbors) {
  struct Cell {
    double distance;
    int z, x;
  };
  std::vector<Cell> order;
  for (int z = 0; z < distance.rows(); ++z) {
    for (int x = 0; x < distance.cols(); ++x) {
      if (distance(z, x) > 0) order.push_back({distance(z, x), z, x});
    }
  }
  std::stable_sort(order.begin(), order.end(), [](const Cell& a, const Cell& b) { return a.distance > b.distance; });
  Amounts amounts = displaced;
  for (const Cell& cell : order) {
    if (std::isinf(cell.distance)) continue;
    std::vector<Offset> lower;
    for (int i = 0; i < neighbors; ++i) {
      const int z = cell.z + kNeighbors[i].z, x = cell.x + kNeighbors[i].x;
      if (inside(distance, z, x) && strictly_lower(distance(z, x), cell.distance)) lower.push_back({z, x});
    }
    if (lower.empty()) continue;
    const double mass = amounts.mass(cell.z, cell.x), volume = amounts.volume(cell.z, cell.x);
    for (const Offset& to : lower) amounts.add(to.z, to.x, 1.0 / static_cast<double>(lower.size()), mass, volume);
    amounts.mass(cell.z, cell.x) = amounts.volume(cell.z, cell.x) = 0;
  }
  return amounts;
}

}  // namespace firn::reference
