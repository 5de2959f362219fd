// The height-field pipelines as a whole: what must hold for any scene.

#include <cstdio>

#include "tests/stages/field_simulation.h"
#include "tests/stages/random_field.h"

using namespace firn::test;

namespace {

int long_or(int steps) { return std::getenv("FIRN_LONG") != nullptr ? 10000 : steps; }

// Bodies of every shape on random ways through the snow, some of which lead out of the field.
std::string random_scene(std::uint64_t seed, int cells, int bodies, double end) {
  firn::reference::Random random(seed);
  std::string text = fmt::format(
      "firn: 1\nname: random\nmaterials: {{snow: {{preset: settled, min_density: 80}}}}\ntime: {{dt: 5.0e-3, end: {}}}\n"
      "field: {{size: [10, 10], cells: [{}, {}], ground: 0.1, depth: 0.4, density: 100, material: snow}}\nbodies:\n",
      end, cells, cells);
  for (int b = 0; b < bodies; ++b) {
    const double size = random.uniform(0.15, 0.6);
    const char* shapes[] = {"sphere: {{radius: {0}}}", "box: {{size: [{0}, {1}, {2}]}}",
                            "capsule: {{from: [-{0}, {1}, 0], to: [{0}, -{1}, 0], radius: {2}}}"};
    text +=
        "  - {" + fmt::format(fmt::runtime(shapes[b % 3]), size, random.uniform(0.2, 0.8), random.uniform(0.1, 0.3)) + ", path: [";
    for (int k = 0; k <= static_cast<int>(end); ++k)
      text += fmt::format("{}{{t: {}, position: [{}, {}, {}], orientation: {{axis: [{}, 1, {}], degrees: {}}}}}",
                          k == 0 ? "" : ", ", k, random.uniform(-1, 11), random.uniform(0.1, 1.1), random.uniform(-1, 11),
                          random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-180, 180));
    text += "]}\n";
  }
  return text;
}

}  // namespace

TEST_CASE("snow keeps its mass to 1e-6 under random bodies by both methods, depth and density stay in their limits") {
  INFO("seed " << seed());
  const int steps = long_or(600), cells = std::getenv("FIRN_LONG") != nullptr ? 256 : 128;
  for (const char* pipeline : field_pipelines) {
    CAPTURE(pipeline);
    Simulation simulation(pipeline, random_scene(seed(), cells, 9, steps * 5.0e-3));
    const double before = field_state(simulation).mass();
    REQUIRE(before == Approx(0.4 * 100 * 100).epsilon(1e-6));
    simulation.steps(steps);
    const FieldState after = field_state(simulation);
    const firn::scene::Material& material = simulation.loaded.problem->scene.materials.front();
    const double drift = after.mass() / before - 1;
    if (std::getenv("FIRN_LONG") != nullptr) std::printf("%s: mass drift %.2e over %d steps\n", pipeline, drift, steps);
    CHECK(std::abs(drift) <= 1e-6);
    double moved = 0;
    for (std::size_t i = 0; i < after.depth.size(); ++i) {
      moved += std::abs(static_cast<double>(after.depth[i]) - 0.4);
      CHECK(after.depth[i] >= 0.0f);
      if (!(after.density[i] >= 99.999f && static_cast<double>(after.density[i]) <= material.max_density * (1 + 1e-6))) {
        CAPTURE(i, after.density[i], after.depth[i]);
        FAIL_CHECK("density out of its limits");
      }
    }
    CHECK(moved > 100);  // cells times m: the bodies have done something
  }
}

TEST_CASE("the thesis's compression does not keep the mass, and the drift is told") {
  const char* const scene = R"(
firn: 1
name: drift
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 5.0e-3, end: 2}
field: {size: [4, 4], cells: [64, 64], ground: 0, depth: 0.4, density: 200, material: snow}
bodies: [{sphere: {radius: 0.4}, path: [{t: 0, position: [1, 0.7, 2]}, {t: 0.5, position: [3, 0.5, 2]}]}]
)";
  double drift[2] = {};
  for (const bool thesis : {false, true}) {
    Simulation simulation("heightfield_contour", scene,
                          {std::string("heightfield.compress.model=") + (thesis ? "thesis" : "conserving")});
    const double before = field_state(simulation).mass();
    simulation.steps(100);
    drift[thesis ? 1 : 0] = field_state(simulation).mass() / before - 1;
  }
  std::printf("mass drift over 100 steps: conserving %.1e, thesis %.1e\n", drift[0], drift[1]);
  CHECK(std::abs(drift[0]) <= 1e-6);
  CHECK(std::abs(drift[1]) > 1e-4);
}

TEST_CASE("a body that goes straight down spreads its snow evenly: symmetric to 1e-5") {
  const char* const scene = R"(
firn: 1
name: press
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 5.0e-3, end: 2}
field: {size: [4, 4], cells: [64, 64], ground: 0, depth: 0.5, density: 150, material: snow}
bodies: [{sphere: {radius: 0.5}, position: [2, 1.05, 2], velocity: [0, -1, 0]}]
)";
  for (const char* pipeline : field_pipelines) {
    CAPTURE(pipeline);
    Simulation simulation(pipeline, scene);
    simulation.steps(60);
    const FieldState f = field_state(simulation);
    double worst = 0, highest = 0;
    for (int z = 0; z < 64; ++z)
      for (int x = 0; x < 64; ++x) {
        const double here = f.height(z, x);
        for (const double mirrored : {f.height(z, 63 - x), f.height(63 - z, x), f.height(x, z)})
          worst = std::max(worst, std::abs(here - mirrored));
        highest = std::max(highest, here);
      }
    CHECK(highest > 0.52);
    CHECK(worst <= 1e-5 * highest);
  }
}

TEST_CASE("a body that moves along +x puts more snow on the +x side") {
  const char* const scene = R"(
firn: 1
name: push
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 5.0e-3, end: 2}
field: {size: [6, 4], cells: [96, 64], ground: 0, depth: 0.4, density: 250, material: snow}
bodies: [{sphere: {radius: 0.5}, position: [2, 0.6, 2], velocity: [2, 0, 0]}]
)";
  for (const char* pipeline : field_pipelines) {
    CAPTURE(pipeline);
    Simulation simulation(pipeline, scene);
    simulation.steps(100);  // now at x = 3
    const FieldState f = field_state(simulation);
    double ahead = 0, behind = 0;
    for (int z = 0; z < f.rows; ++z)
      for (int x = 0; x < f.columns; ++x) {
        const double more = f.height(z, x) - 0.4, place = (x + 0.5) * f.h;
        if (more > 0) (place > 3 ? ahead : behind) += more;
      }
    CAPTURE(ahead, behind);
    CHECK(ahead > 1.5 * behind);
  }
}

TEST_CASE("what relaxation leaves is nowhere steeper than the limit by more than 1 percent, and a poured column is a round cone") {
  // Snow poured from above: a column that is far too steep.
  constexpr int n = 65;
  const double h = 0.1, slope = 0.6;
  Arrays in;
  in.floats["ground"] = std::vector<float>(n * n, 0.0f);
  in.floats["depth"] = std::vector<float>(n * n, 0.0f);
  in.floats["density"] = std::vector<float>(n * n, 200.0f);
  in.floats["underside"] = std::vector<float>(n * n, std::numeric_limits<float>::infinity());
  for (int z = 31; z <= 33; ++z)
    for (int x = 31; x <= 33; ++x) in.floats["depth"][static_cast<std::size_t>(z * n + x)] = 8.0f;
  for (const char* cells : {"all", "active"}) {
    CAPTURE(cells);
    if (std::string(cells) == "active") in.integers["changed_tiles"] = std::vector<std::int32_t>(25, 1);
    firn::graph::Environment environment = field_environment(n, n, h, 0);
    const firn::graph::Registry registry = firn::stages::all_stages(nullptr);
    for (const char* name : {"ground", "depth", "density", "underside", "moved", "changed_tiles"})
      environment.provided.insert(name);
    const Arrays out = run_pipeline(
        fmt::format("firn: 1\nstep:\n  - repeat: {{max: 20000, until: {{buffer: moved, below: 1.0e-7}}}}\n    stages:\n      - "
                    "heightfield.flatten: {{slope: 0.6, cells: {}, quiet: 1.0e-4}}\n",
                    cells),
        environment, registry, in, 0, 1);
    FieldState f{n, n, h, in.floats.at("ground"), out.floats.at("depth"), out.floats.at("density")};
    CHECK(f.mass() == Approx(9 * 8 * 200 * h * h).epsilon(1e-6));
    CHECK(worst_excess(f, slope, in.floats.at("underside")) <= 0.01 * slope * h);
    // Round: the height that the cone has half way down lies on a circle. Along each of 64 directions, where is it?
    const double top = f.height(32, 32), level = 0.5 * top;
    double least = 1e9, most = 0;
    for (int direction = 0; direction < 64; ++direction) {
      const double angle = direction * 2 * M_PI / 64;
      double radius = 0;
      for (double r = 0; r < 30; r += 0.01) {
        const double x = 32 + r * std::cos(angle), z = 32 + r * std::sin(angle);
        const int x0 = static_cast<int>(x), z0 = static_cast<int>(z);
        const double u = x - x0, v = z - z0;
        const double height = (1 - v) * ((1 - u) * f.height(z0, x0) + u * f.height(z0, x0 + 1)) +
                              v * ((1 - u) * f.height(z0 + 1, x0) + u * f.height(z0 + 1, x0 + 1));
        if (height > level) radius = r;
      }
      least = std::min(least, radius);
      most = std::max(most, radius);
    }
    CAPTURE(least, most, top);
    CHECK(most / least <= 1.1);  // to within 5 percent of a circle between them
    CHECK((top - level) / (0.5 * (most + least) * h) == Approx(slope).epsilon(0.1));
  }
}

TEST_CASE("a body that crosses the field in one step leaves its whole way") {
  const char* const scene = R"(
firn: 1
name: fast
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 0.1, end: 2}
gravity: [0, 0, 0]
field: {size: [8, 4], cells: [128, 64], ground: 0, depth: 0.4, density: 250, material: snow}
bodies:
  - {sphere: {radius: 0.3}, position: [1, 0.5, 1], velocity: [60, 0, 0]}
  - {box: {size: [0.4, 0.4, 0.4]}, position: [1, 0.4, 2], velocity: [60, 0, 0], orientation: {axis: [0, 1, 0], degrees: 30}}
  - {capsule: {from: [-0.1, 0, -0.1], to: [0.1, 0, 0.1], radius: 0.2}, position: [1, 0.4, 3], velocity: [60, 0, 0]}
)";
  Simulation simulation("heightfield_contour", scene, {"heightfield.flatten.enable=false"});
  simulation.steps(2);
  const FieldState f = field_state(simulation);
  for (const double z : {1.0, 2.0, 3.0})
    for (double x = 1.1; x < 6.9; x += 0.05) {
      CAPTURE(z, x);
      CHECK(f.height(static_cast<int>(z / f.h), static_cast<int>(x / f.h)) < 0.36);
    }
}

TEST_CASE("a heavy body sinks deeper than a light one, and snow under one end turns a body") {
  const char* const scene = R"(
firn: 1
name: sink
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 2.5e-3, end: 2}
field: {size: [8, 4], cells: [128, 64], ground: 0, depth: 0.6, density: 150, material: snow}
bodies:
  - {sphere: {radius: 0.3}, position: [2, 1, 2], mass: 6}
  - {sphere: {radius: 0.3}, position: [4, 1, 2], mass: 200}
)";
  Simulation simulation("heightfield_contour", scene);
  simulation.steps(800);
  const std::vector<Vector3d> position = simulation.vectors("body_position"), velocity = simulation.vectors("body_velocity");
  CHECK(position[1].y() < position[0].y() - 0.1);
  CHECK(position[1].y() > 0.29);            // on the ground
  CHECK(std::abs(velocity[0].y()) < 0.05);  // both have come to rest
  CHECK(std::abs(velocity[1].y()) < 0.05);

  const char* const bank = R"(
firn: 1
name: bank
materials: {snow: {preset: settled, min_density: 80}}
time: {dt: 2.5e-3, end: 2}
field: {size: [8, 4], cells: [128, 64], ground: 0, depth: 0.6, density: 150, material: snow}
bodies:
  - {box: {size: [2, 0.3, 0.5]}, position: [0, 0.8, 2], velocity: [0, -2, 0], mass: 60}
)";
  // Half of the box is outside the field, over nothing.
  Simulation tilting("heightfield_contour", bank);
  tilting.steps(60);
  CHECK(tilting.vectors("body_spin")[0].z() > 0.05);  // the end at +x is held up: counter-clockwise about +z
}

TEST_CASE("all cells or active tiles give the same snow to the bit") {
  INFO("seed " << seed());
  const std::string scene = random_scene(seed(), 96, 5, 2);
  for (const char* pipeline : field_pipelines) {
    CAPTURE(pipeline);
    std::vector<float> depth[2], position[2];
    for (const bool all : {false, true}) {
      std::vector<std::string> set;
      if (all) set.push_back("cells=all");
      Simulation simulation(pipeline, scene, set);
      simulation.steps(150);
      depth[all ? 1 : 0] = simulation.floats("depth");
      position[all ? 1 : 0] = simulation.floats("body_position");
    }
    CHECK(depth[0] == depth[1]);
    CHECK(position[0] == position[1]);
  }
}
