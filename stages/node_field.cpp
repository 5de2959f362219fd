#include "stages/node_field.h"

#include <cmath>

namespace firn::stages {
namespace {

int block_of(int node) { return node >= 0 ? node / NodeField::edge : (node + 1) / NodeField::edge - 1; }

std::uint64_t key_of(const std::array<int, 3>& block) {
  constexpr std::uint64_t bias = 1 << 20, mask = (1 << 21) - 1;
  std::uint64_t key = 0;
  for (const int part : block) key = key << 21 | ((static_cast<std::uint64_t>(part) + bias) & mask);
  return key;
}

class Blocks {
 public:
  explicit Blocks(NodeField& field) : field_(field) {}
  NodeField::Block& at(const std::array<int, 3>& block) {
    if (block == last_block_ && !field_.blocks.empty()) return field_.blocks[last_];
    const auto [found, fresh] = index_.try_emplace(key_of(block), field_.blocks.size());
    if (fresh) {
      NodeField::Block& made = field_.blocks.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis) made.first[axis] = block[axis] * NodeField::edge;
      made.density.fill(0);
      made.velocity.fill({0, 0, 0});
    }
    last_block_ = block;
    last_ = found->second;
    return field_.blocks[last_];
  }

 private:
  NodeField& field_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::array<int, 3> last_block_{};
  std::size_t last_ = 0;
};

// Quadratic B-spline: the first of three nodes about x (in cells), and their weights.
struct Weights {
  int first;
  std::array<float, 3> w;
};
Weights weights(double x) {
  const double base = std::floor(x - 0.5), d = x - base;
  return {static_cast<int>(base),
          {static_cast<float>(0.5 * (1.5 - d) * (1.5 - d)), static_cast<float>(0.75 - (d - 1) * (d - 1)),
           static_cast<float>(0.5 * (d - 0.5) * (d - 0.5))}};
}

}  // namespace

NodeField node_field(std::span<const float> position, std::span<const float> velocity, std::span<const float> mass,
                     const Eigen::Vector3d& origin, double cell) {
  NodeField field;
  field.origin = origin;
  field.cell = cell;
  Blocks blocks(field);
  for (std::size_t p = 0; p < mass.size(); ++p) {
    std::array<Weights, 3> axis{};
    bool finite = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = (static_cast<double>(position[3 * p + a]) - origin[static_cast<Eigen::Index>(a)]) / cell;
      finite = finite && std::abs(x) < 4e6;
      axis[a] = finite ? weights(x) : Weights{};
    }
    if (!finite) continue;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const std::array<int, 3> node{axis[0].first + i, axis[1].first + j, axis[2].first + k};
          const std::array<int, 3> block{block_of(node[0]), block_of(node[1]), block_of(node[2])};
          NodeField::Block& target = blocks.at(block);
          const std::size_t at = NodeField::index(node[0] - target.first[0], node[1] - target.first[1], node[2] - target.first[2]);
          const float part = mass[p] * axis[0].w[static_cast<std::size_t>(i)] * axis[1].w[static_cast<std::size_t>(j)] *
                             axis[2].w[static_cast<std::size_t>(k)];
          target.density[at] += part;
          for (std::size_t a = 0; a < 3; ++a) target.velocity[at][a] += part * velocity[3 * p + a];
        }
  }
  const auto volume = static_cast<float>(cell * cell * cell);
  for (NodeField::Block& block : field.blocks)
    for (std::size_t n = 0; n < NodeField::size; ++n) {
      if (block.density[n] <= 0) continue;
      for (float& part : block.velocity[n]) part /= block.density[n];
      block.density[n] /= volume;
    }
  return field;
}

std::vector<std::array<float, 3>> velocity_at(const NodeField& field, std::span<const Eigen::Vector3d> places) {
  std::unordered_map<std::uint64_t, const NodeField::Block*> index;
  Eigen::Vector4d whole = Eigen::Vector4d::Zero();  // sum of density times velocity, and of density
  const auto weighed = [](const NodeField::Block& block, std::size_t n) {
    const std::array<float, 3>& v = block.velocity[n];
    return Eigen::Vector4d(Eigen::Vector4f(v[0], v[1], v[2], 1).cast<double>() * double(block.density[n]));
  };
  for (const NodeField::Block& block : field.blocks) {
    index[key_of({block_of(block.first[0]), block_of(block.first[1]), block_of(block.first[2])})] = &block;
    for (std::size_t n = 0; n < NodeField::size; ++n) whole += weighed(block, n);
  }
  std::vector<std::array<float, 3>> result;
  result.reserve(places.size());
  for (const Eigen::Vector3d& place : places) {
    const Eigen::Vector3d x = (place - field.origin) / field.cell;
    const Eigen::Vector3d low = x.array().floor(), share = x - low;
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int corner = 0; corner < 8; ++corner) {
      std::array<int, 3> node{};
      double weight = 1;
      for (int a = 0; a < 3; ++a) {
        const bool high = (corner >> a & 1) != 0;
        node[static_cast<std::size_t>(a)] = static_cast<int>(low[a]) + (high ? 1 : 0);
        weight *= high ? share[a] : 1 - share[a];
      }
      const auto found = index.find(key_of({block_of(node[0]), block_of(node[1]), block_of(node[2])}));
      if (found == index.end()) continue;
      const NodeField::Block& block = *found->second;
      sum +=
          weight * weighed(block, NodeField::index(node[0] - block.first[0], node[1] - block.first[1], node[2] - block.first[2]));
    }
    const Eigen::Vector4d& from = sum[3] > 0 ? sum : whole;
    const Eigen::Vector3f mean = (from.head<3>() / (from[3] > 0 ? from[3] : 1)).cast<float>();
    result.push_back({mean.x(), mean.y(), mean.z()});
  }
  return result;
}

DenseField dense(const NodeField& field, const std::array<int, 3>& last) {
  std::array<std::size_t, 3> count{};
  for (std::size_t a = 0; a < 3; ++a) count[a] = static_cast<std::size_t>(last[a]) + 1;
  DenseField result;
  result.density.resize(count[0] * count[1] * count[2]);
  result.velocity.resize(result.density.size() * 3);
  for (const NodeField::Block& block : field.blocks)
    for (int n = 0; n < NodeField::size; ++n) {
      const auto from = static_cast<std::size_t>(n);
      const std::array<int, 3> node{block.first[0] + n % 8, block.first[1] + n / 8 % 8, block.first[2] + n / 64};
      bool there = block.density[from] > 0;
      for (std::size_t a = 0; a < 3; ++a) there = there && node[a] >= 0 && node[a] <= last[a];
      if (!there) continue;
      const std::size_t to = (static_cast<std::size_t>(node[2]) * count[1] + static_cast<std::size_t>(node[1])) * count[0] +
                             static_cast<std::size_t>(node[0]);
      result.density[to] = block.density[from];
      for (std::size_t a = 0; a < 3; ++a) result.velocity[3 * to + a] = block.velocity[from][a];
    }
  return result;
}

}  // namespace firn::stages
