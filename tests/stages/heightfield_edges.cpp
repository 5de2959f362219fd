// Scenes at the edge of what makes sense: a clear result, and the snow keeps its mass.

#include "tests/stages/field_simulation.h"

using namespace firn::test;

namespace {

struct Edge {
  const char* what;
  const char* field;  // beside size, cells and material
  const char* bodies;
};

const Edge edges[] = {
    {"a body partly outside", "ground: 0, depth: 0.4",
     "[{sphere: {radius: 0.5}, position: [0.1, 0.5, 3.9], velocity: [1, -1, 0]}]"},
    {"a body wholly outside", "ground: 0, depth: 0.4", "[{box: {size: [1, 1, 1]}, position: [-3, 0.3, 2], velocity: [-1, 0, 0]}]"},
    {"a body far away and fast", "ground: 0, depth: 0.4",
     "[{sphere: {radius: 1}, position: [1.0e9, 0, -1.0e9], velocity: [1.0e6, 0, 0]}]"},
    {"a body below the ground", "ground: 1, depth: 0.4", "[{sphere: {radius: 0.5}, position: [2, 0.2, 2], velocity: [1, 0, 0]}]"},
    {"no snow at all", "ground: 0.2, depth: 0", "[{sphere: {radius: 0.5}, position: [2, 0.5, 2], velocity: [1, 0, 0]}]"},
    {"snow everywhere at its density limit", "ground: 0, depth: 0.4, density: 500",
     "[{sphere: {radius: 0.5}, position: [2, 0.6, 2], velocity: [1, -0.5, 0]}]"},
    {"a body over the whole field, so that the contour is empty", "ground: 0, depth: 0.4",
     "[{box: {size: [9, 1, 9]}, position: [2, 0.8, 2], velocity: [0, -0.2, 0]}]"},
    {"two bodies that touch", "ground: 0, depth: 0.4",
     "[{box: {size: [1, 1, 1]}, position: [1.5, 0.7, 2], velocity: [1, 0, 0]}, {box: {size: [1, 1, 1]}, position: [2.5, 0.7, 2], "
     "velocity: [-1, 0, 0]}]"},
    {"a body that does not move", "ground: 0, depth: 0.4", "[{sphere: {radius: 0.5}, position: [2, 0.6, 2]}]"},
    {"two bodies in one place", "ground: 0, depth: 0.4",
     "[{sphere: {radius: 0.5}, position: [2, 0.6, 2]}, {sphere: {radius: 0.5}, position: [2, 0.6, 2], velocity: [0, -1, 0]}]"},
    {"no bodies", "ground: 0, depth: 0.4", "[]"},
    {"a half-space, which has no underside", "ground: 0, depth: 0.4", "[{plane: {point: [0, 0.2, 0], normal: [0, 1, 0]}}]"},
};

std::string scene(const Edge& edge, int cells) {
  return fmt::format(
      "firn: 1\nname: edge\ngravity: [0, 0, 0]\ntime: {{dt: 1.0e-2, end: 1}}\nmaterials: {{snow: {{preset: settled, min_density: "
      "80, "
      "max_density: 500}}}}\nfield: {{size: [4, 4], cells: [{}, {}], material: snow, {}}}\nbodies: {}\n",
      cells, cells, edge.field, edge.bodies);
}

}  // namespace

TEST_CASE("snow keeps its mass and stays finite at every edge, by both methods, down to a field of one cell") {
  for (const Edge& edge : edges)
    for (const int cells : {1, 3, 40})
      for (const char* pipeline : field_pipelines) {
        CAPTURE(edge.what, cells, pipeline);
        Simulation simulation(pipeline, scene(edge, cells));
        const double before = field_state(simulation).mass();
        simulation.steps(20);
        const FieldState after = field_state(simulation);
        CHECK(after.mass() == Approx(before).epsilon(1e-6));
        for (std::size_t i = 0; i < after.depth.size(); ++i) {
          if (after.depth[i] >= 0.0f && after.depth[i] < 100.0f && after.density[i] >= 79.9f && after.density[i] <= 500.01f)
            continue;
          CAPTURE(i, after.depth[i], after.density[i]);
          FAIL_CHECK("a cell without sense");
        }
        for (const float value : simulation.floats("body_position")) CHECK(std::isfinite(value));
      }
}

TEST_CASE("a body that neither moves nor meets snow leaves the field alone to the bit") {
  for (const char* pipeline : field_pipelines) {
    CAPTURE(pipeline);
    Simulation simulation(pipeline, scene({"", "ground: 0, depth: 0.4", "[{sphere: {radius: 0.5}, position: [2, 3, 2]}]"}, 40));
    const std::vector<float> before = simulation.floats("depth");
    simulation.steps(20);
    CHECK(simulation.floats("depth") == before);
  }
}
