// The scenes that come with Firn.

#include "scene/emission.h"
#include "scene/field.h"
#include "scene/materials.h"
#include "scene/mesh.h"
#include "scene/sampling.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

scene::Scene shipped(const std::string& name) {
  ReadResult result;
  const std::filesystem::path file = std::filesystem::path(FIRN_SOURCE_DIR) / "pipelines" / "scenes" / (name + ".yaml");
  const config::Node root = config::load(file, result.diagnostics);
  result.scene = scene::read_scene(root, result.diagnostics);
  INFO(result.text());
  REQUIRE(result.diagnostics.all().empty());
  return result.scene;
}

// Cells that a pressure wave crosses in one step, in undeformed snow.
double courant_number(const scene::Scene& scene) {
  double fastest = 0;
  for (const scene::Snow& snow : scene.snow) {
    const scene::Material& material = scene.materials[static_cast<std::size_t>(snow.material)];
    fastest = std::max(fastest, scene::sound_speed(material) + snow.velocity.norm());
  }
  for (const scene::Emitter& emitter : scene.emitters) {
    const scene::Material& material = scene.materials[static_cast<std::size_t>(emitter.material)];
    fastest = std::max(fastest, scene::sound_speed(material) + scene::largest_speed(emitter));
  }
  return fastest * scene.time.dt.value() / scene.domain->cell;
}

}  // namespace

TEST_CASE("every shipped scene reads without errors or warnings, says what it is, and can be sampled") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(FIRN_SOURCE_DIR) / "pipelines" / "scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    INFO(entry.path().string());
    const scene::Scene scene = shipped(entry.path().stem().string());
    CHECK(scene.name == entry.path().stem().string());
    CHECK_FALSE(scene.doc.empty());
    CHECK(scene::sample(scene).position.size() <= scene::estimate_particles(scene));
    if (scene.field) CHECK(scene::sample_field(scene).depth.size() == 256 * 256);
    for (const scene::TriangleMesh& mesh : scene::body_meshes(scene)) CHECK((mesh.triangles.empty() || scene::is_closed(mesh)));
    ++count;
  }
  CHECK(count >= 10);
}

TEST_CASE("the explicit steps of the shipped particle scenes leave room for hardening") {
  for (const char* name : {"snowball", "two_snowballs", "slope_block", "snow_cover", "spinning_snowball", "snow_gun", "snowfall"}) {
    INFO(name);
    CHECK(courant_number(shipped(name)) > 0);
    CHECK(courant_number(shipped(name)) < 0.35);
  }
}

TEST_CASE("the snowball is cheap enough for a software renderer") {
  const scene::Scene scene = shipped("snowball");
  const std::size_t particles = scene::sample(scene).position.size();
  CHECK(particles > 7000);
  CHECK(particles < 10000);
  CHECK(scene.domain->nodes().prod() <= 65 * 41 * 65);
  CHECK(scene.time.end <= 1.5);
  CHECK(scene.time.dt.value() >= 2e-4);
}

TEST_CASE("two snowballs: as many particles and nodes as in [M 5.2]") {
  const scene::Scene scene = shipped("two_snowballs");
  CHECK(scene.domain->nodes() == Eigen::Vector3i(151, 101, 101));
  const auto particles = static_cast<double>(scene::sample(scene).position.size());
  CHECK(particles == Approx(32768).epsilon(0.005));
}

TEST_CASE("the slope's block lies on the plane and is steeper than friction holds") {
  const scene::Scene scene = shipped("slope_block");
  const scene::Body& plane = scene.bodies.at(0);
  const Eigen::Vector3d normal = plane.orientation * std::get<scene::Plane>(plane.shape).normal;
  const double slope = std::tan(std::acos(normal.y()));
  CHECK(plane.friction < slope);
  double lowest = 1e9;
  for (const Eigen::Vector3d& position : scene::sample(scene).position)
    lowest = std::min(lowest, normal.dot(position - plane.position));
  CHECK(lowest >= -1e-6);
  CHECK(lowest < scene.domain->cell);
}

}  // namespace firn::test
