// What a checkpoint leaves out does not matter to what comes after it.

#include "graph/carried.h"

#include <algorithm>
#include <set>

#include "app/arrays.h"
#include "tests/catch.h"
#include "tests/stages/ball_scene.h"
#include "tests/stages/simulation.h"

using namespace firn;
using namespace firn::test;

namespace {

const char* const field_text = R"(
firn: 1
name: field
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 5.0e-3, end: 2}
field: {size: [3, 3], cells: [48, 48], ground: 0.1, depth: 0.4, density: 100, material: snow}
bodies:
  - {sphere: {radius: 0.4}, path: [{t: 0, position: [1, 0.6, 1.5]}, {t: 1, position: [3, 0.6, 1.5]}]}
  - {box: {size: [0.4, 0.4, 0.4]}, mass: 20, position: [2, 0.8, 2.2]}
)";

using Contents = std::map<std::string, std::vector<std::byte>>;

// The carried state and the picture after steps and a frame, in the middle of which everything else is overwritten by `poison`.
Contents after(const app::Loaded& loaded, std::optional<std::byte> poison) {
  execution::Execution execution(device(), loaded.plan, loaded.registry, {shader_folders(), false, false});
  const auto go = [&] {
    for (int i = 0; i < 12; ++i) {
      execution.clock().dt = *loaded.problem->scene.time.dt;
      execution.step();
    }
    execution.frame();
    execution.check_faults();
  };
  execution.setup();
  go();
  const std::vector<int> kept = graph::carried(loaded.plan);
  if (poison)
    for (int b = 0; b < static_cast<int>(loaded.plan.buffers.size()); ++b)
      if (const graph::PlannedBuffer& buffer = loaded.plan.buffers[static_cast<std::size_t>(b)];
          std::ranges::find(kept, b) == kept.end() && buffer.count > 0)
        execution.write(buffer.name, std::vector<std::byte>(execution.read(buffer.name).size(), *poison));
  go();
  Contents contents;
  for (const int b : kept)
    if (const graph::PlannedBuffer& buffer = loaded.plan.buffers[static_cast<std::size_t>(b)]; repeats(loaded.plan, buffer))
      contents[buffer.name] = buffer.texture ? execution.read(buffer.name) : app::read_array(execution, buffer.name).packed;
  contents["image"] = execution.read("image");
  return contents;
}

}  // namespace

TEST_CASE("what is not carried from step to step can be overwritten between two of them") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_apic", "mpm_thesis", "heightfield_contour", "heightfield_distance");
  CAPTURE(pipeline);
  const SceneFile scene(pipeline.starts_with("mpm") ? ball_text : field_text);
  app::Inputs inputs;
  inputs.pipeline = pipeline_file(pipeline);
  inputs.scene = scene.path;
  inputs.image = "96x54";
  const app::Loaded loaded = app::load(inputs, "");
  const auto is_carried = [&](const std::string& name) {
    const std::vector<int> kept = graph::carried(loaded.plan);
    return std::ranges::find(kept, loaded.plan.buffer(name)) != kept.end();
  };
  CHECK(is_carried("body_position"));
  CHECK(is_carried(pipeline.starts_with("mpm") ? "elastic" : "depth"));
  for (const char* name : {"image", "image_depth", "shadow_map"}) CHECK_FALSE(is_carried(name));
  CHECK(graph::carried(loaded.plan).size() < loaded.plan.buffers.size());

  const Contents clean = after(loaded, {});
  for (const int poison : {0x00, 0x3f}) {
    CAPTURE(poison);
    for (const auto& [name, bytes] : after(loaded, static_cast<std::byte>(poison))) {
      CAPTURE(name);
      const bool same = bytes == clean.at(name);
      CHECK(same);
    }
  }
}

TEST_CASE("a checkpoint of mpm_snow holds the state and nothing that a step or a picture makes anew") {
  const SceneFile scene(ball_text);
  app::Inputs inputs;
  inputs.pipeline = pipeline_file("mpm_snow");
  inputs.scene = scene.path;
  const auto names = [&] {
    const app::Loaded loaded = app::load(inputs, "");
    std::set<std::string> list;
    for (const int b : graph::carried(loaded.plan)) list.insert(loaded.plan.buffers[static_cast<std::size_t>(b)].name);
    return list;
  };
  const std::set<std::string> of_particles{"elastic", "mass",   "material",          "plastic_det", "position",
                                           "stress",  "volume", "velocity_gradient", "velocity"};
  const std::set<std::string> of_scene{
      "material_elastic", "material_plastic", "facet_body",     "facet_points",      "path_orientation",    "path_position",
      "path_time",        "body_color",       "body_distances", "body_distance_box", "body_distance_nodes", "body_friction",
      "body_inertia",     "body_kind",        "body_mass",      "body_orientation",  "body_path",           "body_position",
      "body_size",        "body_spin",        "body_velocity"};
  // The table that finds blocks, which the next sort clears entry by entry.
  const std::set<std::string> of_table{"active_block_count", "block_counter", "block_entry",     "block_groups",
                                       "block_key",          "cell_count",    "particle_counter"};
  // Lists of bodies by tiles of the picture, written as long as they are.
  std::set<std::string> expected{"tile_bodies"};
  for (const auto& part : {of_particles, of_scene, of_table}) expected.insert(part.begin(), part.end());
  inputs.replace = {"snow_picture=render.surface"};
  CHECK(names() == expected);
  // Grains are lit by the grid's mass, which a picture may ask for before the next step makes it anew.
  inputs.replace = {};
  expected.insert({"grid_mass", "block_near", "block_slot", "particle_cell"});
  CHECK(names() == expected);
}
