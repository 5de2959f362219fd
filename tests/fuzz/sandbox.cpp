#include "tests/fuzz/sandbox.h"

#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <vector>

#include "scene/npy.h"

namespace firn::fuzz {
namespace {

namespace fs = std::filesystem;

// Both kinds of snow, so that every stage has what it works on: 17 x 19 x 21 nodes, 96 particles, 16 x 16 cells.
constexpr const char* small_scene = R"(firn: 1
name: small
time: {dt: 2.0e-4, fps: 1000, end: 0.01}
domain: {min: [0, 0, 0], max: [0.8, 0.9, 1.0], cell: 0.05}
snow:
  - {sphere: {center: [0.4, 0.45, 0.5], radius: 0.1}, material: packed, per_cell: 4}
field: {size: [0.8, 0.8], cells: [16, 16], depth: 0.2, material: new_snow}
bodies:
  - {plane: {point: [0, 0.3, 0], normal: [0, 1, 0]}, friction: 0.5}
  - {sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5], mass: 2}
)";

constexpr const char* snow_pipeline = R"(firn: 1
scene: scenes/small.yaml
setup: [mpm.seed, bodies.place, mpm.clear_grid, mpm.particles_to_grid, mpm.grid_update, mpm.initial_density]
step:
  - mpm.time_step
  - mpm.clear_grid
  - mpm.particles_to_grid
  - mpm.stress
  - mpm.grid_forces
  - mpm.grid_update
  - mpm.grid_collide
  - mpm.grid_to_particles
  - mpm.deform
  - mpm.particle_collide
  - mpm.advect
  - bodies.integrate
)";

// What a stage that is a file may read: the state of particles and of the field.
constexpr const char* stage_pipeline = R"(firn: 1
scene: scenes/small.yaml
setup: [mpm.seed, bodies.place, heightfield.init]
step:
  - ./input.comp
  - repeat: 2
    stages:
      - stage: ./input.comp
)";

}  // namespace

Sandbox::Sandbox() {
  std::string name = (fs::temp_directory_path() / "firn-fuzz-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder " + name);
  path_ = name;
  const fs::path shipped = fs::path(FIRN_SOURCE_DIR) / "pipelines";
  for (const char* folder : {"scenes", "scenes/meshes"}) fs::create_directory(path_ / folder);
  // Shipped pipelines and stages as they are, shipped scenes by their names only: sampling them takes long.
  for (const fs::path& folder : {shipped, shipped / "examples"})
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.is_regular_file()) fs::copy_file(entry.path(), path_ / entry.path().filename());
  for (const auto& entry : fs::directory_iterator(shipped / "scenes"))
    if (entry.is_regular_file()) put("scenes/" + entry.path().filename().string(), small_scene);
  put("scenes/small.yaml", small_scene);
  put("scenes/scene.yaml", small_scene);
  put("scene.yaml", small_scene);
  put("snow.yaml", snow_pipeline);
  put("stage.yaml", stage_pipeline);
  put("scenes/meshes/ramp.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  for (const char* mesh : {"boot_left.obj", "boot_right.obj", "plough.obj"})
    fs::copy_file(path_ / "scenes/meshes/ramp.obj", path_ / "scenes/meshes" / mesh);
  scene::write_npy(path_ / "scenes/points.npy", {2, 3}, std::vector<float>{0.4f, 0.45f, 0.5f, 0.41f, 0.45f, 0.5f});
}

Sandbox::~Sandbox() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path Sandbox::put(const std::string& name, std::string_view text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return path_ / name;
}

}  // namespace firn::fuzz
