// Whole steps of the shipped pipelines: against the double-precision run, and against mechanics.

#include <bit>
#include <filesystem>
#include <fstream>

#include "app/load.h"
#include "tests/stages/random_snow.h"

using namespace firn::test;
namespace ref = firn::reference;

namespace {

std::string pipeline_file(const std::string& name) { return std::string(FIRN_SOURCE_DIR) + "/pipelines/" + name + ".yaml"; }

// A scene text as a file that lives as long as this.
struct SceneFile {
  explicit SceneFile(const std::string& text)
      : path((std::filesystem::temp_directory_path() / ("firn-scene-" + std::to_string(getpid()) + ".yaml")).string()) {
    std::ofstream(path) << text;
  }
  ~SceneFile() { std::filesystem::remove(path); }
  std::string path;
};

// A pipeline on a scene, ready to step. Frames are left out: nothing is drawn.
struct Simulation {
  Simulation(const std::string& pipeline, const std::string& scene_text, std::vector<std::string> set = {},
             bool barriers_all = false)
      : scene(scene_text) {
    firn::app::Inputs inputs;
    inputs.pipeline = pipeline_file(pipeline);
    inputs.scene = scene.path;
    inputs.set = std::move(set);
    loaded = firn::app::load(inputs, "");
    execution = std::make_unique<firn::execution::Execution>(device(), loaded.plan, loaded.registry,
                                                             firn::execution::Options{shader_folders(), barriers_all, false});
    execution->setup();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      execution->clock().dt = *loaded.problem->scene.time.dt;
      execution->step();
    }
    execution->check_faults();
  }
  [[nodiscard]] std::vector<float> floats(const std::string& buffer) const {
    const firn::graph::PlannedBuffer& planned = loaded.plan.buffers.at(static_cast<std::size_t>(loaded.plan.buffer(buffer)));
    const std::vector<std::byte> bytes = firn::graph::unpadded(planned.type, execution->read(buffer));
    std::vector<float> values(bytes.size() / 4);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  [[nodiscard]] std::vector<Vector3d> vectors(const std::string& buffer) const {
    const std::vector<float> values = floats(buffer);
    std::vector<Vector3d> result;
    for (std::size_t i = 0; i < values.size(); i += 3) result.emplace_back(values[i], values[i + 1], values[i + 2]);
    return result;
  }
  [[nodiscard]] Vector3d momentum() const {
    const std::vector<float> mass = floats("mass");
    const std::vector<Vector3d> velocity = vectors("velocity");
    Vector3d sum = Vector3d::Zero();
    for (std::size_t p = 0; p < mass.size(); ++p) sum += static_cast<double>(mass[p]) * velocity[p];
    return sum;
  }

  SceneFile scene;
  firn::app::Loaded loaded;
  std::unique_ptr<firn::execution::Execution> execution;
};

double total(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += value;
  return sum;
}

Vector3d mean(const std::vector<Vector3d>& values) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// About 1,000 particles: a snowball that is thrown into a corner of a plane, a sphere and a box, so that everything happens within
// 50 steps. No surface passes exactly through nodes: there rounding would decide whether a node is inside.
const char* const collision_scene = R"(
firn: 1
name: collision
time: {dt: 1.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [2, 2, 2], cell: 0.0625}
materials:
  ball: {density: 400, young: 1.4e5, poisson: 0.2, hardening: 10, critical_compression: 2.5e-2, critical_stretch: 7.5e-3}
snow:
  - {sphere: {center: [1, 0.7, 1], radius: 0.195}, material: ball, velocity: [6, -12, 3], spin: [0, 5, 9], per_cell: 8}
bodies:
  - {plane: {point: [0, 0.5037, 0], normal: [0.1, 1, 0.017]}, friction: 0.3}
  - {sphere: {radius: 0.2}, position: [1.35, 0.7, 1], velocity: [-2, 0, 0], spin: [0, 0, 4], friction: 0.2}
  - {box: {size: [0.2, 0.3, 0.4]}, position: [0.75, 0.75, 1], velocity: [1, 0, 0], friction: 0.5}
)";

// The reference's state for the same scene, from the particles that the pipeline starts with.
struct Reference {
  explicit Reference(const Simulation& simulation) {
    const firn::scene::Scene& scene = simulation.loaded.problem->scene;
    grid = {scene.domain->min, scene.domain->cell, scene.domain->nodes()};
    for (const firn::scene::Material& m : scene.materials)
      materials.push_back({m.young, m.poisson, m.hardening, m.critical_compression, m.critical_stretch, m.density});
    const std::vector<Vector3d> x = simulation.vectors("position"), v = simulation.vectors("velocity");
    const std::vector<float> mass = simulation.floats("mass"), volume = simulation.floats("volume");
    for (std::size_t p = 0; p < x.size(); ++p) particles.add(x[p], v[p], mass[p], volume[p]);
    for (const firn::scene::Body& body : scene.bodies) {
      ref::Collider c;
      c.position = body.position;
      c.velocity = body.velocity;
      c.spin = body.spin;
      c.friction = body.friction;
      if (const auto* plane = std::get_if<firn::scene::Plane>(&body.shape)) {
        c.normal = plane->normal;
      } else if (const auto* sphere = std::get_if<firn::scene::Sphere>(&body.shape)) {
        c.shape = ref::Shape::sphere;
        c.radius = sphere->radius;
      } else if (const auto* box = std::get_if<firn::scene::Box>(&body.shape)) {
        c.shape = ref::Shape::box;
        c.half_size = box->half_size;
      }
      colliders.push_back(c);
    }
    settings.dt = *scene.time.dt;
    settings.gravity = scene.gravity;
  }
  ref::Particles particles;
  ref::Grid grid;
  std::vector<ref::Material> materials;
  std::vector<ref::Collider> colliders;
  ref::StepSettings settings;
};

struct Variant {
  const char* pipeline;
  const char* kernel;
  const char* accumulate;  // empty: the pipeline has no such choice
};
const Variant variants[] = {
    {"mpm_thesis", "cubic", "fixed"},     {"mpm_thesis", "cubic", "float"}, {"mpm_thesis", "quadratic", "fixed"},
    {"mpm_thesis", "quadratic", "float"}, {"mpm_snow", "cubic", ""},        {"mpm_snow", "quadratic", ""}};

std::vector<std::string> settings(const Variant& variant) {
  std::vector<std::string> set{std::string("kernel=") + variant.kernel};
  if (*variant.accumulate != 0) set.push_back(std::string("accumulate=") + variant.accumulate);
  return set;
}

}  // namespace

TEST_CASE("50 steps stay within 1e-3 of a cell of the double-precision run") {
  for (const Variant& variant : variants) {
    CAPTURE(variant.pipeline, variant.kernel, variant.accumulate);
    Simulation simulation(variant.pipeline, collision_scene, settings(variant));
    Reference expected(simulation);
    CHECK(expected.particles.count() > 900);
    CHECK(expected.particles.count() < 1100);
    expected.settings.kernel = std::string(variant.kernel) == "cubic" ? ref::Kernel::cubic : ref::Kernel::quadratic;
    for (int i = 0; i < 50; ++i)
      ref::step(expected.particles, expected.grid, expected.materials, expected.colliders, expected.settings);
    simulation.steps(50);
    const std::vector<Vector3d> x = simulation.vectors("position");
    double worst = 0, moved = 0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      worst = std::max(worst, (x[p] - expected.particles.position[p]).norm());
      moved = std::max(moved, std::abs(expected.particles.plastic_det[p] - 1));
    }
    CAPTURE(worst / expected.grid.h);
    CHECK(worst <= 1e-3 * expected.grid.h);
    CHECK(moved > 1e-3);  // the snow has been crushed
  }
}

TEST_CASE("the grid holds the particles' mass") {
  for (const Variant& variant : variants) {
    CAPTURE(variant.pipeline, variant.kernel, variant.accumulate);
    Simulation simulation(variant.pipeline, collision_scene, settings(variant));
    simulation.steps(3);
    CHECK(total(simulation.floats("grid_mass")) == Approx(total(simulation.floats("mass"))).epsilon(1e-6));
  }
}

TEST_CASE("derived barriers give the same bytes as a full barrier after everything") {
  for (const Variant& variant : variants) {
    if (std::string(variant.accumulate) == "float") continue;  // not repeatable from run to run
    CAPTURE(variant.pipeline, variant.kernel);
    Simulation derived(variant.pipeline, collision_scene, settings(variant));
    Simulation all(variant.pipeline, collision_scene, settings(variant), true);
    derived.steps(20);
    all.steps(20);
    for (const char* buffer : {"position", "velocity", "elastic", "plastic_det", "volume"})
      CHECK(derived.execution->read(buffer) == all.execution->read(buffer));
  }
}

TEST_CASE("momentum without gravity and bodies is kept to 1e-5 over 1,000 steps") {
  const char* const scene = R"(
firn: 1
name: drift
gravity: [0, 0, 0]
time: {dt: 2.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [2, 2, 2], cell: 0.125}
materials: {ball: {density: 400, young: 1.4e5}}
snow:
  - {sphere: {center: [0.6, 0.9, 1], radius: 0.24}, material: ball, velocity: [3, 0.5, -0.25], spin: [0, 0, 6]}
  - {sphere: {center: [1.2, 0.95, 1], radius: 0.24}, material: ball, velocity: [-1, 0.25, 0]}
)";
  for (const Variant& variant : variants) {
    if (std::string(variant.kernel) == "quadratic") continue;
    CAPTURE(variant.pipeline, variant.accumulate);
    Simulation simulation(variant.pipeline, scene, settings(variant));
    const Vector3d before = simulation.momentum();
    simulation.steps(1000);
    const double drift = (simulation.momentum() - before).norm() / before.norm();
    CAPTURE(drift);
    CHECK(drift <= 1e-5);
  }
}

TEST_CASE("free fall matches g t^2 / 2 to 1e-4") {
  const char* const scene = R"(
firn: 1
name: fall
time: {dt: 1.0e-4, end: 1}
domain: {min: [0, 0, 0], max: [1, 2, 1], cell: 0.0625}
materials: {ball: {density: 400, young: 1.4e5}}
snow: [{sphere: {center: [0.5, 1.6, 0.5], radius: 0.15}, material: ball}]
)";
  for (const char* pipeline : {"mpm_thesis", "mpm_snow"}) {
    CAPTURE(pipeline);
    Simulation simulation(pipeline, scene);
    const double before = mean(simulation.vectors("position")).y();
    constexpr int steps = 4000;
    simulation.steps(steps);
    const double t = steps * 1e-4, fallen = before - mean(simulation.vectors("position")).y();
    // The scheme's own sum is g dt^2 n (n + 1) / 2: 1/n more than g t^2 / 2, which is 2.5e-4 here and belongs to the method.
    const double scheme = 9.81 * 1e-8 * steps * (steps + 1) / 2;
    CAPTURE(fallen, scheme);
    CHECK(std::abs(fallen / scheme - 1) <= 1e-4);
    CHECK(std::abs(fallen / (0.5 * 9.81 * t * t) - 1) <= 1e-4 + 1.0 / steps);
  }
}
