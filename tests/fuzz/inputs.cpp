#include "tests/fuzz/inputs.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>

#include "app/explain.h"
#include "app/load.h"
#include "config/node.h"
#include "graph/glsl.h"
#include "scene/npy.h"
#include "tests/graph/executions.h"

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

// Refuses what needs more than a moment to sample.
constexpr double memory = 32 << 20;

bool leads_out(const std::string& text) { return text.starts_with('/') || text.find("..") != std::string::npos; }

bool leads_out(const config::Node& node) {
  return leads_out(node.scalar) || std::ranges::any_of(node.items, [](const config::Node& item) { return leads_out(item); }) ||
         std::ranges::any_of(node.entries,
                             [](const config::Entry& entry) { return leads_out(entry.key) || leads_out(entry.value); });
}

bool stays_inside(std::string_view text) {
  config::Diagnostics told_later;
  return !leads_out(config::parse(text, "input", told_later));
}

std::optional<app::Loaded> check(const fs::path& pipeline, const fs::path& scene) {
  app::Inputs inputs;
  inputs.pipeline = pipeline.string();
  inputs.scene = scene.string();
  inputs.memory = memory;
  try {
    return app::load(inputs, "");
  } catch (const config::InputError& error) {
    for (const config::Diagnostic& diagnostic : error.diagnostics().all())
      if (diagnostic.text.empty()) throw std::logic_error("an error without a text");
    return std::nullopt;
  }
}

// Setup, two steps with a frame between them and one more frame, every repeat at one turn or two.
void check_barriers(const graph::Plan& plan) {
  std::vector<const graph::Repeat*> repeats;
  for (const std::vector<graph::Op>* phase : {&plan.setup, &plan.step, &plan.frame}) test::collect_repeats(*phase, repeats);
  for (const std::int64_t most : {1, 2}) {
    if (most == 2 && repeats.size() > 8) return;  // those in one another would double the turns again and again
    const test::Choices choices{[&](const graph::Repeat& repeat) { return std::min(repeat.max, most); }, [](int) { return true; }};
    if (const auto hazard = test::first_hazard(plan, {test::trace(plan, "sfsf", choices)}))
      throw std::logic_error(test::describe(plan, *hazard));
  }
}

void look_at(const app::Loaded& loaded) {
  check_barriers(loaded.plan);
  if (app::explain_as_text(loaded.plan, loaded.pipeline.doc).empty() || app::explain_as_dot(loaded.plan, "").empty() ||
      app::explain_as_json(loaded.plan).dump(-1, ' ', false, nlohmann::json::error_handler_t::strict).empty())
    throw std::logic_error("a plan without an explanation");
}

void generate_kernels(const graph::Plan& plan) {
  for (int s = 0; s < static_cast<int>(plan.stages.size()); ++s) {
    const std::vector<graph::Work>& work = plan.stages[static_cast<std::size_t>(s)].spec.work;
    for (int w = 0; w < static_cast<int>(work.size()); ++w)
      if (std::holds_alternative<graph::Dispatch>(work[static_cast<std::size_t>(w)]) &&
          graph::compute_prelude(plan, s, w, {}).empty())
        throw std::logic_error("a kernel without declarations");
    graph::parameter_block(plan, s);
  }
}

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

void check_pipeline(const Sandbox& sandbox, std::string_view text) {
  if (!stays_inside(text)) return;
  if (const auto loaded = check(sandbox.put("input.yaml", text), "")) look_at(*loaded);
}

void check_scene(const Sandbox& sandbox, std::string_view text) {
  if (!stays_inside(text)) return;
  const bool has_field = text.find("\nfield") != std::string_view::npos;
  check(sandbox.path() / (has_field ? "heightfield_contour.yaml" : "snow.yaml"), sandbox.put("scenes/input.yaml", text));
}

void check_stage(const Sandbox& sandbox, std::string_view text) {
  sandbox.put("input.comp", text);
  if (const auto loaded = check(sandbox.path() / "stage.yaml", "")) {
    look_at(*loaded);
    generate_kernels(loaded->plan);
  }
}

}  // namespace firn::fuzz
