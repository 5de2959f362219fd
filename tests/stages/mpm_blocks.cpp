// The stages that store only blocks of the grid which particles reach, against the double-precision references of the whole grid.

#include <set>

#include "tests/stages/stored_blocks.h"

using namespace firn::test;
namespace ref = firn::reference;

namespace {

struct Case {
  const char* kernel;
  ref::Kernel reference;
};
const Case kernels[] = {{"cubic", ref::Kernel::cubic}, {"quadratic", ref::Kernel::quadratic}};

constexpr double dt = block_dt;

// What gather_velocities needs.
Arrays gathered(const RandomSnow& snow) {
  Arrays in = snow.arrays({"position", "velocity", "mass"});
  in.floats["stress"] = flat(symmetric_stress(snow));
  return in;
}

ref::GridState solved(const RandomSnow& snow, const std::vector<Matrix3d>& stress, ref::Kernel kernel) {
  ref::GridState state = ref::particles_to_grid(snow.particles, snow.grid, kernel);
  state.force = ref::grid_forces(snow.particles, stress, snow.grid, kernel);
  ref::grid_update(state, Vector3d(0, -9.81, 0), dt);
  return state;
}

}  // namespace

TEST_CASE("sort with stored nodes lists every block once, and particles of a cell by number") {
  INFO("seed " << seed());
  const RandomSnow snow = lumps(seed(), 1500);
  // Three times: nothing of an earlier sort may be left.
  const Arrays out = run(snow, "  - mpm.sort: {nodes: active}\n", snow.arrays({"position"}), 3);
  const auto count = static_cast<std::size_t>(out.integers.at("active_block_count").at(0));
  const auto first = out.integers.at("active_blocks").begin();
  CHECK(std::set<std::int32_t>(first, first + static_cast<std::ptrdiff_t>(count)).size() == count);
  const std::vector<std::int32_t>& order = out.integers.at("order");
  const std::vector<std::int32_t>& cells = out.integers.at("particle_cell");
  CHECK(std::set<std::int32_t>(order.begin(), order.end()).size() == order.size());
  std::set<std::int32_t> finished;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const auto before = static_cast<std::size_t>(order[i - 1]), here = static_cast<std::size_t>(order[i]);
    if (cells[before] == cells[here]) REQUIRE(before < here);
    if (cells[before] != cells[here]) REQUIRE(finished.insert(cells[before]).second);
  }
}

TEST_CASE("gather_velocities gives the reference's mass and velocities, and stores every node that has mass") {
  INFO("seed " << seed());
  const RandomSnow snow = lumps(seed(), 1500);
  const std::vector<Matrix3d> stress = symmetric_stress(snow);
  for (const auto& [kernel, form] :
       {std::pair{kernels[0], "texture"}, {kernels[1], "texture"}, {kernels[0], "shared"}, {kernels[1], "shared"}}) {
    CAPTURE(kernel.kernel, form);
    const std::string with = std::string("{kernel: ") + kernel.kernel + ", form: " + form + "}\n";
    const Arrays out = run(snow, "  - mpm.sort: {nodes: active}\n  - mpm.gather_velocities: " + with, gathered(snow), 2);
    const ref::GridState expected = solved(snow, stress, kernel.reference);
    CHECK(relative_error(whole(out, "grid_mass", snow.grid.nodes), flat(expected.mass)) <= 1e-5);
    const auto momentum = [&](const std::vector<float>& mass, std::vector<float> velocity) {
      for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] *= mass[i / 3];
      return velocity;
    };
    const std::vector<float> mass = flat(expected.mass);
    CHECK(relative_error(momentum(mass, whole(out, "grid_velocity_before", snow.grid.nodes)),
                         momentum(mass, flat(expected.velocity_before))) <= 1e-5);
    CHECK(relative_error(momentum(mass, whole(out, "grid_velocity", snow.grid.nodes)), momentum(mass, flat(expected.velocity))) <=
          1e-5);
  }
}

// Weights are as small as 1e-9 there, and velocities are quotients of two of them.
TEST_CASE("the mass of nodes that a particle hardly reaches is exact for its size, at both ends of a cell") {
  INFO("seed " << seed());
  for (const double place : {1.0 / 512, 511.0 / 512})
    for (int axis = 0; axis < 3; ++axis) {
      CAPTURE(place, axis);
      RandomSnow snow(seed(), 1);
      Vector3d& position = snow.particles.position.front();
      Vector3d cells = (position - snow.grid.min) / snow.grid.h;
      for (int i = 0; i < 3; ++i) cells[i] = std::floor(cells[i]) + (i == axis ? place : 0.5);
      position = snow.grid.min + snow.grid.h * cells;
      const Arrays out = run(snow, "  - mpm.sort: {nodes: active}\n  - mpm.gather_velocities: {kernel: cubic, form: texture}\n",
                             gathered(snow), 1);
      const std::vector<float> mass = whole(out, "grid_mass", snow.grid.nodes);
      const std::vector<float> expected = flat(ref::particles_to_grid(snow.particles, snow.grid, ref::Kernel::cubic).mass);
      for (std::size_t i = 0; i < expected.size(); ++i)
        if (expected[i] > 0) REQUIRE(mass[i] == Approx(expected[i]).epsilon(0.02));
    }
}

TEST_CASE("stored blocks and the whole grid give particles the same velocities and gradients") {
  INFO("seed " << seed());
  RandomSnow snow = lumps(seed(), 1500);
  for (std::size_t b = 0; b < snow.colliders.size(); ++b) snow.colliders[b].position += snow.grid.h * Vector3d(33, 18, 0);
  for (ref::Collider& c : snow.colliders) c.position = single(c.position);
  const Arrays bodies =
      snow.arrays({"body_kind", "body_size", "body_position", "body_orientation", "body_velocity", "body_spin", "body_friction"});
  const std::vector<Matrix3d> stress = symmetric_stress(snow);
  for (const Case& kernel : kernels)
    for (const char* by : {"mpm.grid_to_particles: {nodes: active, ", "mpm.grid_to_particles: {nodes: by_cell, ",
                           "mpm.grid_to_particles: {nodes: by_block, "}) {
      CAPTURE(kernel.kernel, by);
      const std::string with = std::string("kernel: ") + kernel.kernel + "}\n";
      Arrays in = gathered(snow);
      in.floats.insert(bodies.floats.begin(), bodies.floats.end());
      in.integers.insert(bodies.integers.begin(), bodies.integers.end());
      const Arrays out = run(snow,
                             "  - mpm.sort: {nodes: active}\n  - mpm.gather_velocities: {" + with +
                                 "  - mpm.grid_collide: {nodes: active}\n  - " + by + "flip: 0.9, " + with,
                             in);
      ref::GridState grid = solved(snow, stress, kernel.reference);
      ref::grid_collide(grid, snow.grid, snow.colliders);
      ref::Particles expected = snow.particles;
      const std::vector<Matrix3d> gradient = ref::grid_to_particles(expected, grid, snow.grid, kernel.reference, single(0.9));
      CHECK(relative_error(out.floats.at("velocity"), flat(expected.velocity)) <= 1e-4);
      CHECK(relative_error(out.floats.at("velocity_gradient"), flat(gradient)) <= 1e-4);  // light nodes: a force by little mass
    }
}

TEST_CASE("initial_density finds stored nodes") {
  INFO("seed " << seed());
  const RandomSnow snow = lumps(seed(), 1500);
  for (const Case& kernel : kernels) {
    CAPTURE(kernel.kernel);
    const std::string with = std::string("{kernel: ") + kernel.kernel;
    Arrays in = gathered(snow);
    in.floats["volume"] = flat(snow.particles.volume);
    const Arrays out = run(snow,
                           "  - mpm.sort: {nodes: active}\n  - mpm.gather_velocities: " + with +
                               "}\n  - mpm.initial_density: " + with + ", nodes: active, bind: {density: density}}\n",
                           in);
    ref::Particles expected = snow.particles;
    const ref::GridState grid = ref::particles_to_grid(snow.particles, snow.grid, kernel.reference);
    CHECK(relative_error(out.floats.at("density"), flat(ref::initial_density(expected, grid, snow.grid, kernel.reference))) <=
          1e-5);
    CHECK(relative_error(out.floats.at("volume"), flat(expected.volume)) <= 1e-5);
  }
}

TEST_CASE("deform_stress is deform and stress in one") {
  INFO("seed " << seed());
  const RandomSnow snow(seed());
  StageRun stage;
  stage.stage = "mpm.deform_stress";
  stage.environment = grid_environment(snow.setup());
  stage.in =
      snow.arrays({"velocity_gradient", "material", "material_plastic", "material_elastic", "volume", "elastic", "plastic_det"});
  stage.dt = single(5e-4);
  const Arrays out = run_stage(stage);
  ref::Particles expected = snow.particles;
  ref::deform(expected, snow.gradient, snow.materials, stage.dt);
  CHECK(relative_error(out.floats.at("elastic"), flat(expected.elastic)) <= 1e-5);
  CHECK(relative_error(out.floats.at("plastic_det"), flat(expected.plastic_det)) <= 1e-5);
  CHECK(relative_error(out.floats.at("stress"), flat(ref::stress(expected, snow.materials))) <= 1e-4);
}

TEST_CASE("nodes that were stored for an earlier list of blocks cannot be read with a later one") {
  const RandomSnow snow = lumps(1, 10);
  const std::string sort = "  - mpm.sort: {nodes: active}\n", gather = "  - mpm.gather_velocities\n",
                    back = "  - mpm.grid_to_particles: {nodes: active}\n";
  CHECK_NOTHROW(run(snow, sort + gather + back, gathered(snow)));
  // Within a step, and across its end.
  for (const std::string& order : {sort + gather + sort + back, sort + back + gather}) {
    CAPTURE(order);
    try {
      run(snow, order, gathered(snow));
      FAIL("was taken");
    } catch (const firn::config::InputError& error) {
      CHECK(std::string(error.what()).find("'grid_velocity', which was written for an earlier 'active_blocks'") !=
            std::string::npos);
    }
  }
}

TEST_CASE("more blocks than there is room for end the run") {
  const RandomSnow snow = lumps(1, 1500);
  const Arrays in = snow.arrays({"position"});
  firn::graph::Environment environment = grid_environment(snow.setup());
  environment.provided = {"position"};
  environment.domains["grid_blocks"].count = 40;
  environment.domains["block_table"].count = 128;
  CHECK_THROWS_AS(
      run_pipeline("firn: 1\nstep:\n  - mpm.sort: {nodes: active}\n", environment, firn::stages::all_stages(nullptr), in, dt, 1),
      firn::execution::NumbersError);
}
