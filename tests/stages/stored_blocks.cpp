#include "tests/stages/stored_blocks.h"

namespace firn::test {

namespace ref = firn::reference;

RandomSnow lumps(std::uint64_t seed, int count) {
  RandomSnow snow(seed, count);
  snow.grid.nodes = {70, 45, 51};
  for (int p = 0; p < count; ++p) {
    const Vector3d lump(snow.grid.h * Vector3d(27 * (p % 3), 16 * (p % 2), 38.0 * (p % 5 == 0)));
    snow.particles.position[static_cast<std::size_t>(p)] =
        single(Vector3d(snow.particles.position[static_cast<std::size_t>(p)] + lump));
  }
  return snow;
}

Arrays run(const RandomSnow& snow, const std::string& stages, Arrays in, int steps) {
  firn::graph::Environment environment = grid_environment(snow.setup());
  for (const auto& [name, values] : in.floats) environment.provided.insert(name);
  for (const auto& [name, values] : in.integers) environment.provided.insert(name);
  return run_pipeline("firn: 1\nstep:\n" + stages, environment, firn::stages::all_stages(nullptr), in, block_dt, steps);
}

std::vector<Matrix3d> symmetric_stress(const RandomSnow& snow) {
  std::vector<Matrix3d> stress = ref::stress(snow.particles, snow.materials);
  for (Matrix3d& s : stress) s = single(Matrix3d(0.5 * (s + s.transpose())));
  return stress;
}

std::vector<float> whole(const Arrays& out, const std::string& buffer, const Eigen::Vector3i& nodes) {
  const std::vector<float>& stored = out.floats.at(buffer);
  const std::size_t parts = stored.size() / (64 * out.integers.at("active_blocks").size());
  std::vector<float> grid(parts * static_cast<std::size_t>(nodes.prod()));
  const Eigen::Vector3i blocks = nodes / 4 + Eigen::Vector3i::Ones();
  for (int slot = 0; slot < out.integers.at("active_block_count").at(0); ++slot) {
    const int block = out.integers.at("active_blocks").at(static_cast<std::size_t>(slot));
    const Eigen::Vector3i corner =
        4 * Eigen::Vector3i(block % blocks.x(), block / blocks.x() % blocks.y(), block / (blocks.x() * blocks.y()));
    for (int local = 0; local < 64; ++local) {
      const Eigen::Vector3i node = corner + Eigen::Vector3i(local & 3, local >> 2 & 3, local >> 4);
      if ((node.array() >= nodes.array()).any()) continue;
      const auto to = static_cast<std::size_t>(node.x() + nodes.x() * (node.y() + nodes.y() * node.z()));
      for (std::size_t c = 0; c < parts; ++c)
        grid[parts * to + c] = stored[parts * static_cast<std::size_t>(64 * slot + local) + c];
    }
  }
  return grid;
}

}  // namespace firn::test
