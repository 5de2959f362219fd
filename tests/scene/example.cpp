// The example of the scene file's format, with every value it gives.

#include <png.h>

#include <array>
#include <vector>

#include "scene/npy.h"
#include "scene/sampling.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

const char* const example = R"(firn: 1
name: two_snowballs
seed: 1
time: {dt: 1.0e-4, fps: 30, end: 1.8}      # dt: auto, with cfl: 0.4, picks it each step
gravity: [0, -9.81, 0]
domain: {min: [0, 0, 0], max: [7.5, 5, 5], cell: 0.05}
materials:
  ball: {preset: packed, density: 400, young: 5.0e6, poisson: 0.3, hardening: 30,
         critical_compression: 2.5e-2, critical_stretch: 2.0e-3}
snow:                                       # what is filled with particles
  - {sphere: {center: [1.4, 2.1, 2.5], radius: 0.4}, material: ball, velocity: [10, 0, 0], per_cell: 8}
  - {points: {file: more.npy, mass: 0.004}, material: ball}   # N x 3, or N x 6 with velocity; kg per particle
field:                                      # what the height-field model works on
  {size: [10, 10], cells: [256, 256], ground: 0, depth: {image: drift.png, metres: 0.6}, density: 100, material: new_snow}
bodies:                                     # rigid bodies: colliders of the one model, objects of the other
  - {plane: {point: [0, 0.2, 0], normal: [0, 1, 0]}, friction: 0.3}
  - {sphere: {radius: 0.5}, position: [2, 1, 2], velocity: [1, 0, 0], friction: 0.2}             # no mass: moves as told
  - {mesh: {file: sledge.obj}, mass: 60, position: [5, 0.6, 5], path: [{t: 0, position: [5, 0.6, 5]}, {t: 3, position: [8, 0.4, 5]}]}
camera: {from: [6, 4, 9], to: [4, 1, 3], fov: 40}
light: {sun: [-0.4, -1, -0.3]}
)";

void write_grey_png(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = 2;
  image.format = PNG_FORMAT_GRAY;
  const std::array<png_byte, 4> pixels{0, 85, 170, 255};
  REQUIRE(png_image_write_to_file(&image, file.c_str(), 0, pixels.data(), 0, nullptr) != 0);
}

struct Example {
  TemporaryFolder folder;
  scene::Scene scene;

  Example() {
    const std::vector<float> points{3, 2, 2.5F, -12, 0, 0, 3.1F, 2, 2.5F, -12, 0, 1};
    scene::write_npy(folder / "more.npy", {2, 6}, std::span<const float>(points));
    write_grey_png(folder / "drift.png");
    folder.write("sledge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    scene = good_scene(example, folder / "scene.yaml");
  }
};

using Vector3d = Eigen::Vector3d;

}  // namespace

TEST_CASE("the format's example: general sections are read as given") {
  const Example given;
  const scene::Scene& scene = given.scene;
  CHECK(scene.file == (given.folder / "scene.yaml").string());
  CHECK(scene.name == "two_snowballs");
  CHECK(scene.doc.empty());
  CHECK(scene.seed == 1);
  REQUIRE(scene.time.dt.has_value());
  CHECK(*scene.time.dt == 1e-4);
  CHECK(scene.time.cfl == 0.4);
  CHECK(scene.time.fps == 30);
  CHECK(scene.time.end == 1.8);
  CHECK(scene.gravity == Vector3d(0, -9.81, 0));
  REQUIRE(scene.domain.has_value());
  CHECK(scene.domain->min == Vector3d(0, 0, 0));
  CHECK(scene.domain->max == Vector3d(7.5, 5, 5));
  CHECK(scene.domain->cell == 0.05);
  CHECK(scene.domain->nodes() == Eigen::Vector3i(151, 101, 101));
  CHECK(scene.camera.from == Vector3d(6, 4, 9));
  CHECK(scene.camera.to == Vector3d(4, 1, 3));
  CHECK(scene.camera.fov == 40);
  CHECK(scene.light.sun == Vector3d(-0.4, -1, -0.3));
}

TEST_CASE("the format's example: materials, snow and field are read as given") {
  const Example given;
  const scene::Scene& scene = given.scene;
  REQUIRE(scene.materials.size() == 2);
  const scene::Material& ball = scene.materials[0];
  CHECK(ball.name == "ball");
  CHECK(ball.preset == "packed");
  CHECK(ball.density == 400);
  CHECK(ball.young == 5e6);
  CHECK(ball.poisson == 0.3);
  CHECK(ball.hardening == 30);
  CHECK(ball.critical_compression == 2.5e-2);
  CHECK(ball.critical_stretch == 2e-3);
  CHECK(ball.place.line == 8);
  CHECK(scene.materials[1].name == "new_snow");
  CHECK(scene.materials[1].density == 100);

  REQUIRE(scene.snow.size() == 2);
  const auto& sphere = std::get<scene::Sphere>(scene.snow[0].what);
  CHECK(sphere.center == Vector3d(1.4, 2.1, 2.5));
  CHECK(sphere.radius == 0.4);
  CHECK(scene.snow[0].material == 0);
  CHECK(scene.snow[0].velocity == Vector3d(10, 0, 0));
  CHECK(scene.snow[0].per_cell == 8);
  const auto& points = std::get<scene::PointFile>(scene.snow[1].what);
  CHECK(points.file == (given.folder / "more.npy").string());
  CHECK(points.mass == 0.004);

  REQUIRE(scene.field.has_value());
  const scene::Field& field = *scene.field;
  CHECK(field.size == Eigen::Vector2d(10, 10));
  CHECK(field.origin == Eigen::Vector2d(0, 0));
  CHECK(field.cells_x == 256);
  CHECK(field.cells_z == 256);
  CHECK(field.ground.value == 0);
  CHECK(field.ground.image.empty());
  CHECK(field.depth.image == (given.folder / "drift.png").string());
  CHECK(field.depth.unit_value == 0.6);
  CHECK(field.density.value == 100);
  CHECK(field.material == 1);
}

TEST_CASE("the format's example: bodies are read as given") {
  const Example given;
  const std::vector<scene::Body>& bodies = given.scene.bodies;
  REQUIRE(bodies.size() == 3);
  CHECK(std::get<scene::Plane>(bodies[0].shape).normal == Vector3d(0, 1, 0));
  CHECK(std::get<scene::Plane>(bodies[0].shape).point == Vector3d(0, 0, 0));
  CHECK(bodies[0].position == Vector3d(0, 0.2, 0));
  CHECK(bodies[0].friction == 0.3);
  CHECK(bodies[0].name == "body 1");
  CHECK_FALSE(bodies[0].mass.has_value());

  CHECK(std::get<scene::Sphere>(bodies[1].shape).radius == 0.5);
  CHECK(bodies[1].position == Vector3d(2, 1, 2));
  CHECK(bodies[1].velocity == Vector3d(1, 0, 0));
  CHECK(bodies[1].friction == 0.2);
  CHECK_FALSE(bodies[1].mass.has_value());

  CHECK(std::get<scene::Mesh>(bodies[2].shape).file == (given.folder / "sledge.obj").string());
  CHECK(bodies[2].mass == 60.0);
  CHECK(bodies[2].position == Vector3d(5, 0.6, 5));
  REQUIRE(bodies[2].path.size() == 2);
  CHECK(bodies[2].path[0].time == 0);
  CHECK(bodies[2].path[1].time == 3);
  CHECK(bodies[2].path[1].position == Vector3d(8, 0.4, 5));
}

TEST_CASE("the format's example: sampling gives the sphere's particles, then those of the file") {
  const Example given;
  const scene::Particles particles = scene::sample(given.scene);
  REQUIRE(particles.mass.size() > 2);
  const std::size_t last = particles.mass.size() - 1;
  CHECK(particles.mass[0] == Approx(400 * 0.05 * 0.05 * 0.05 / 8).epsilon(1e-12));
  CHECK(particles.velocity[0] == Vector3d(10, 0, 0));
  CHECK(particles.mass[last] == 0.004);
  CHECK(particles.volume[last] == Approx(0.004 / 400).epsilon(1e-12));
  CHECK(particles.position[last] == Vector3d(3.1F, 2, 2.5));
  CHECK(particles.velocity[last] == Vector3d(-12, 0, 1));
}

}  // namespace firn::test
