#pragma once

// One stage alone on given arrays: fills its ports, runs it once, reads them back.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "graph/compile.h"
#include "graph/execution/execution.h"
#include "stages/register.h"

namespace firn::test {

gpu::Device& device();  // one per process
std::vector<std::filesystem::path> shader_folders();

// Unpadded scalars by buffer name. Floats for float, vec and mat3 (row by row), integers for the others.
struct Arrays {
  std::map<std::string, std::vector<float>> floats;
  std::map<std::string, std::vector<std::int32_t>> integers;
};

struct StageRun {
  std::string stage;
  std::string options = "{}";      // YAML map, as behind the stage's name in a pipeline: "{kernel: quadratic}"
  graph::Environment environment;  // domains and constants
  double dt = 0, time = 0;
  Arrays in;
};

// Every buffer of the stage after one run. Throws execution::NumbersError where it reported a fault, config::InputError where it
// does not compile.
Arrays run_stage(const StageRun& run);

// The same through any pipeline text with several stages; `steps` times.
Arrays run_pipeline(const std::string& yaml, const graph::Environment& environment, const graph::Registry& registry,
                    const Arrays& in, double dt, int steps, bool barriers_all = false);

// An environment for particles on a grid, without a scene: domains particles, nodes, grid_rows, grid_blocks, block_table,
// materials, bodies, key_frames and the constants grid_min, grid_cell, grid_nodes, gravity, mass_scale, momentum_scale, crowd.
struct GridSetup {
  std::uint64_t particles = 0, materials = 1, bodies = 0, key_frames = 0;
  std::array<double, 3> grid_min{0, 0, 0};
  double cell = 0.1;
  std::array<int, 3> nodes{16, 16, 16};
  std::array<double, 3> gravity{0, -9.81, 0};
  double mass_bound = 1, momentum_bound = 1;  // of one node: give what the test's particles can reach
  double crowd = 64;                          // most particles in one cell
};
graph::Environment grid_environment(const GridSetup& setup);

}  // namespace firn::test
