// Every material-point stage against its double-precision reference, on random snow.

#include <bit>

#include "tests/stages/random_snow.h"

using namespace firn::test;
namespace ref = firn::reference;

namespace {

struct Case {
  const char* kernel;
  ref::Kernel reference;
};
const Case kernels[] = {{"cubic", ref::Kernel::cubic}, {"quadratic", ref::Kernel::quadratic}};

StageRun stage(const std::string& name, const std::string& options, const RandomSnow& snow, Arrays in, double dt = 0) {
  StageRun run;
  run.stage = name;
  run.options = options;
  run.environment = grid_environment(snow.setup());
  run.in = std::move(in);
  run.dt = dt;
  return run;
}

std::string options(const Case& kernel, const std::string& accumulate) {
  return std::string("{kernel: ") + kernel.kernel + ", accumulate: " + accumulate + "}";
}

double scale_of(const RandomSnow& snow, const char* constant) {
  const firn::graph::Environment environment = grid_environment(snow.setup());
  return std::get<double>(environment.constant(constant)->value);
}

std::vector<float> descaled(const std::vector<std::int32_t>& values, double scale) {
  std::vector<float> result;
  for (const std::int32_t value : values) result.push_back(static_cast<float>(value / scale));
  return result;
}

// The scale that grid_forces takes, by its documented rule.
double force_scale(const RandomSnow& snow, float largest) {
  const double bound = snow.setup().crowd * 3 * largest * (7.0 / 3) * (25.0 / 9) / snow.grid.h;
  return std::exp2(std::floor(30 - std::log2(bound)));
}

float largest_entry(const std::vector<Matrix3d>& matrices) {
  double top = 0;
  for (const Matrix3d& m : matrices) top = std::max(top, m.cwiseAbs().maxCoeff());
  return static_cast<float>(top);
}

// A grid with the particles' mass and random velocities.
ref::GridState random_grid(RandomSnow& snow, ref::Kernel kernel) {
  ref::GridState state = ref::particles_to_grid(snow.particles, snow.grid, kernel);
  for (double& m : state.mass) m = single(m);
  const auto vectors = [&](double size) {
    std::vector<Vector3d> list(state.mass.size());
    for (Vector3d& v : list)
      v = single(Vector3d(snow.random.uniform(-size, size), snow.random.uniform(-size, size), snow.random.uniform(-size, size)));
    return list;
  };
  state.velocity = vectors(3);
  state.velocity_before = vectors(3);
  for (Vector3d& m : state.momentum) m = single(m);
  state.force = vectors(40);
  return state;
}

}  // namespace

TEST_CASE("particles_to_grid gives the reference's mass and momentum") {
  INFO("seed " << seed());
  const RandomSnow snow(seed());
  for (const Case& kernel : kernels) {
    CAPTURE(kernel.kernel);
    const ref::GridState expected = ref::particles_to_grid(snow.particles, snow.grid, kernel.reference);
    const Arrays in = snow.arrays({"position", "velocity", "mass"});
    const Arrays real = run_stage(stage("mpm.particles_to_grid", options(kernel, "float"), snow, in));
    CHECK(relative_error(real.floats.at("grid_mass_sum"), flat(expected.mass)) <= 1e-5);
    CHECK(relative_error(real.floats.at("grid_momentum_sum"), flat(expected.momentum)) <= 1e-5);
    const Arrays fixed = run_stage(stage("mpm.particles_to_grid", options(kernel, "fixed"), snow, in));
    CHECK(relative_error(descaled(fixed.integers.at("grid_mass_sum"), scale_of(snow, "mass_scale")), flat(expected.mass)) <= 1e-4);
    CHECK(relative_error(descaled(fixed.integers.at("grid_momentum_sum"), scale_of(snow, "momentum_scale")),
                         flat(expected.momentum)) <= 1e-4);
  }
}

TEST_CASE("initial_density gives the reference's density and volume") {
  INFO("seed " << seed());
  RandomSnow snow(seed());
  for (const Case& kernel : kernels) {
    CAPTURE(kernel.kernel);
    ref::GridState grid = random_grid(snow, kernel.reference);
    ref::Particles expected = snow.particles;
    const std::vector<double> density = ref::initial_density(expected, grid, snow.grid, kernel.reference);
    Arrays in = snow.arrays({"position", "mass", "volume"});
    in.floats["grid_mass"] = flat(grid.mass);
    const Arrays out =
        run_stage(stage("mpm.initial_density", std::string("{bind: {density: density}, kernel: ") + kernel.kernel + "}", snow, in));
    CHECK(relative_error(out.floats.at("density"), flat(density)) <= 1e-5);
    CHECK(relative_error(out.floats.at("volume"), flat(expected.volume)) <= 1e-5);
  }
}

TEST_CASE("stress is the reference's, and its largest entry is found") {
  INFO("seed " << seed());
  const RandomSnow snow(seed());
  const std::vector<Matrix3d> expected = ref::stress(snow.particles, snow.materials);
  const Arrays in = snow.arrays({"elastic", "plastic_det", "volume", "material", "material_elastic"});
  for (const char* accumulate : {"fixed", "float"}) {
    const Arrays out = run_stage(stage("mpm.stress", std::string("{accumulate: ") + accumulate + "}", snow, in));
    CHECK(relative_error(out.floats.at("stress"), flat(expected)) <= 1e-5);
    if (std::string(accumulate) == "fixed")
      CHECK(std::bit_cast<float>(out.integers.at("stress_max").at(0)) == Approx(largest_entry(expected)).epsilon(1e-5));
  }
}

TEST_CASE("grid_forces are the reference's") {
  INFO("seed " << seed());
  const RandomSnow snow(seed());
  std::vector<Matrix3d> stress = ref::stress(snow.particles, snow.materials);
  for (Matrix3d& s : stress) s = single(s);
  const float largest = largest_entry(stress);
  for (const Case& kernel : kernels) {
    CAPTURE(kernel.kernel);
    const std::vector<float> expected = flat(ref::grid_forces(snow.particles, stress, snow.grid, kernel.reference));
    Arrays in = snow.arrays({"position"});
    in.floats["stress"] = flat(stress);
    const Arrays real = run_stage(stage("mpm.grid_forces", options(kernel, "float"), snow, in));
    CHECK(relative_error(real.floats.at("grid_force_sum"), expected) <= 1e-5);
    in.integers["stress_max"] = {std::bit_cast<std::int32_t>(largest)};
    const Arrays fixed = run_stage(stage("mpm.grid_forces", options(kernel, "fixed"), snow, in));
    CHECK(relative_error(descaled(fixed.integers.at("grid_force_sum"), force_scale(snow, largest)), expected) <= 1e-4);
  }
}

TEST_CASE("sort and gather_to_grid give the reference's mass, momentum and force") {
  INFO("seed " << seed());
  const RandomSnow snow(seed(), 2000);
  std::vector<Matrix3d> stress = ref::stress(snow.particles, snow.materials);
  for (Matrix3d& s : stress) s = single(Matrix3d(0.5 * (s + s.transpose())));
  for (const Case& kernel : kernels) {
    CAPTURE(kernel.kernel);
    Arrays in = snow.arrays({"position", "velocity", "mass"});
    in.floats["stress"] = flat(stress);
    firn::graph::Environment environment = grid_environment(snow.setup());
    environment.provided = {"position", "velocity", "mass", "stress"};
    const std::string pipeline =
        std::string("firn: 1\nstep:\n  - mpm.sort\n  - mpm.gather_to_grid: {kernel: ") + kernel.kernel + "}\n";
    // Twice: the second sort must not see anything of the first.
    const Arrays out = run_pipeline(pipeline, environment, firn::stages::all_stages(nullptr), in, 0, 2);
    const ref::GridState expected = ref::particles_to_grid(snow.particles, snow.grid, kernel.reference);
    CHECK(relative_error(out.floats.at("grid_mass_sum"), flat(expected.mass)) <= 1e-5);
    CHECK(relative_error(out.floats.at("grid_momentum_sum"), flat(expected.momentum)) <= 1e-5);
    CHECK(relative_error(out.floats.at("grid_force_sum"),
                         flat(ref::grid_forces(snow.particles, stress, snow.grid, kernel.reference))) <= 1e-5);
    const std::vector<std::int32_t>& order = out.integers.at("order");
    const std::vector<std::int32_t>& cells = out.integers.at("particle_cell");
    for (std::size_t i = 1; i < order.size(); ++i) {
      const auto before = static_cast<std::size_t>(order[i - 1]), here = static_cast<std::size_t>(order[i]);
      REQUIRE((cells[before] < cells[here] || (cells[before] == cells[here] && before < here)));
    }
  }
}

TEST_CASE("grid_update gives the reference's velocities, and nodes without mass rest") {
  INFO("seed " << seed());
  RandomSnow snow(seed(), 60);
  ref::GridState expected = random_grid(snow, ref::Kernel::cubic);
  REQUIRE(std::ranges::count(expected.mass, 0.0) > 0);
  Arrays in;
  in.floats["grid_mass_sum"] = flat(expected.mass);
  in.floats["grid_momentum_sum"] = flat(expected.momentum);
  in.floats["grid_force_sum"] = flat(expected.force);
  ref::grid_update(expected, Vector3d(0, -9.81, 0), single(1e-4));
  const Arrays out = run_stage(stage("mpm.grid_update", "{accumulate: float}", snow, in, 1e-4));
  CHECK(out.floats.at("grid_mass") == flat(expected.mass));
  // Relative to each node: light nodes have the largest velocities, heavy ones must be right as well.
  const std::vector<float> velocity = flat(expected.velocity), before = flat(expected.velocity_before);
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const double allowed = 1e-5 * (std::abs(velocity[i]) + std::abs(before[i]));
    REQUIRE(std::abs(out.floats.at("grid_velocity")[i] - velocity[i]) <= allowed);
    REQUIRE(std::abs(out.floats.at("grid_velocity_before")[i] - before[i]) <= allowed);
  }
}

TEST_CASE("grid_update takes fixed-point sums as what they stand for") {
  INFO("seed " << seed());
  RandomSnow snow(seed());
  ref::GridState expected = ref::particles_to_grid(snow.particles, snow.grid, ref::Kernel::cubic);
  const double largest = 64;
  const double scales[] = {scale_of(snow, "mass_scale"), scale_of(snow, "momentum_scale"),
                           force_scale(snow, static_cast<float>(largest))};
  Arrays in;
  expected.force.assign(expected.mass.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < expected.mass.size(); ++i) {
    in.integers["grid_mass_sum"].push_back(static_cast<std::int32_t>(expected.mass[i] * scales[0]));
    expected.mass[i] = in.integers["grid_mass_sum"].back() / scales[0];
    for (int c = 0; c < 3; ++c) {
      in.integers["grid_momentum_sum"].push_back(static_cast<std::int32_t>(expected.momentum[i][c] * scales[1]));
      in.integers["grid_force_sum"].push_back(static_cast<std::int32_t>(snow.random.uniform(-1e6, 1e6)));
      expected.momentum[i][c] = in.integers["grid_momentum_sum"].back() / scales[1];
      expected.force[i][c] = in.integers["grid_force_sum"].back() / scales[2];
    }
  }
  in.integers["stress_max"] = {std::bit_cast<std::int32_t>(static_cast<float>(largest))};
  ref::grid_update(expected, Vector3d(0, -9.81, 0), single(1e-4));
  const Arrays out = run_stage(stage("mpm.grid_update", "{accumulate: fixed}", snow, in, 1e-4));
  CHECK(relative_error(out.floats.at("grid_velocity"), flat(expected.velocity)) <= 1e-5);
  CHECK(relative_error(out.floats.at("grid_velocity_before"), flat(expected.velocity_before)) <= 1e-5);
}

TEST_CASE("grid_collide acts as the reference does, for every kind of body") {
  INFO("seed " << seed());
  RandomSnow snow(seed());
  ref::GridState expected = random_grid(snow, ref::Kernel::cubic);
  Arrays in =
      snow.arrays({"body_kind", "body_size", "body_position", "body_orientation", "body_velocity", "body_spin", "body_friction"});
  in.floats["grid_mass"] = flat(expected.mass);
  in.floats["grid_velocity"] = flat(expected.velocity);
  ref::grid_collide(expected, snow.grid, snow.colliders);
  const Arrays out = run_stage(stage("mpm.grid_collide", "{}", snow, in));
  CHECK(relative_error(out.floats.at("grid_velocity"), flat(expected.velocity)) <= 1e-5);
  CHECK(relative_error(in.floats.at("grid_velocity"), flat(expected.velocity)) > 0.1);  // bodies do act
}

TEST_CASE("particle_collide acts as the reference does, for every kind of body") {
  INFO("seed " << seed());
  RandomSnow snow(seed(), 3000);
  const Arrays in = snow.arrays({"position", "velocity", "body_kind", "body_size", "body_position", "body_orientation",
                                 "body_velocity", "body_spin", "body_friction"});
  ref::Particles expected = snow.particles;
  ref::particle_collide(expected, snow.colliders);
  const Arrays out = run_stage(stage("mpm.particle_collide", "{}", snow, in));
  CHECK(relative_error(out.floats.at("velocity"), flat(expected.velocity)) <= 1e-5);
  CHECK(relative_error(in.floats.at("velocity"), flat(expected.velocity)) > 0.1);
}

TEST_CASE("grid_to_particles gives the reference's velocities and gradients") {
  INFO("seed " << seed());
  RandomSnow snow(seed());
  for (const Case& kernel : kernels) {
    CAPTURE(kernel.kernel);
    const ref::GridState grid = random_grid(snow, kernel.reference);
    Arrays in = snow.arrays({"position", "velocity"});
    in.floats["grid_velocity"] = flat(grid.velocity);
    in.floats["grid_velocity_before"] = flat(grid.velocity_before);
    ref::Particles expected = snow.particles;
    const std::vector<Matrix3d> gradient = ref::grid_to_particles(expected, grid, snow.grid, kernel.reference, single(0.9));
    const Arrays out =
        run_stage(stage("mpm.grid_to_particles", std::string("{flip: 0.9, kernel: ") + kernel.kernel + "}", snow, in));
    CHECK(relative_error(out.floats.at("velocity"), flat(expected.velocity)) <= 1e-5);
    CHECK(relative_error(out.floats.at("velocity_gradient"), flat(gradient)) <= 1e-5);
  }
}

TEST_CASE("deform gives the reference's elastic and plastic deformation") {
  INFO("seed " << seed());
  RandomSnow snow(seed());
  const double dt = single(5e-4);
  const Arrays in = snow.arrays({"velocity_gradient", "material", "material_plastic", "elastic", "plastic_det"});
  ref::Particles expected = snow.particles;
  ref::deform(expected, snow.gradient, snow.materials, dt);
  const Arrays out = run_stage(stage("mpm.deform", "{}", snow, in, dt));
  CHECK(relative_error(out.floats.at("elastic"), flat(expected.elastic)) <= 1e-5);
  CHECK(relative_error(out.floats.at("plastic_det"), flat(expected.plastic_det)) <= 1e-5);
  CHECK(in.floats.at("plastic_det") != flat(expected.plastic_det));  // some of it is plastic
}

TEST_CASE("advect moves particles with their velocity") {
  INFO("seed " << seed());
  RandomSnow snow(seed());
  ref::Particles expected = snow.particles;
  std::vector<ref::Collider> none;
  ref::advect(expected, none, single(1e-3));
  const Arrays out = run_stage(stage("mpm.advect", "{}", snow, snow.arrays({"position", "velocity"}), 1e-3));
  CHECK(relative_error(out.floats.at("position"), flat(expected.position)) <= 1e-6);
}

TEST_CASE("bodies.integrate moves bodies as the reference does") {
  INFO("seed " << seed());
  RandomSnow snow(seed());
  Arrays in = snow.arrays({"body_position", "body_orientation", "body_velocity", "body_spin"});
  in.floats["body_mass"] = std::vector<float>(snow.colliders.size(), 0.0f);
  in.integers["body_path"] = std::vector<std::int32_t>(2 * snow.colliders.size(), 0);
  std::vector<ref::Collider> expected = snow.colliders;
  ref::advance(expected, 0.01);
  const Arrays out = run_stage(stage("bodies.integrate", "{}", snow, in, 0.01));
  for (std::size_t b = 0; b < expected.size(); ++b) {
    const float* q = &out.floats.at("body_orientation")[4 * b];
    const Eigen::Quaterniond turned(q[3], q[0], q[1], q[2]);
    CHECK(turned.angularDistance(expected[b].orientation) <= 1e-3);
    CHECK(std::abs(turned.dot(expected[b].orientation)) == Approx(1).margin(1e-6));
    for (int axis = 0; axis < 3; ++axis)
      CHECK(out.floats.at("body_position")[3 * b + static_cast<std::size_t>(axis)] ==
            Approx(expected[b].position[axis]).epsilon(1e-6));
  }
}
