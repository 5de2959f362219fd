// What must be seen in pictures of the height field.

#include <random>

#include "stages/render/heightfield.h"
#include "tests/catch.h"
#include "tests/stages/render_shot.h"

using namespace firn::test;
using firn::scene::Vector3d;

namespace {

// 64 x 64 cells of 0.1 m and whatever else the test wants.
struct FieldText {
  std::string field = "{size: [6.4, 6.4], cells: [64, 64], depth: 0.3, material: new_snow}";
  std::string bodies = "[]";
  std::string camera = "{from: [3.2, 9, 3.2], to: [3.2, 0, 3.2], fov: 40}";
  std::string sun = "[-0.3, -1, -0.3]";

  [[nodiscard]] std::string text() const {
    return "firn: 1\nname: field\nfield: " + field + "\nbodies: " + bodies + "\ncamera: " + camera + "\nlight: {sun: " + sun +
           "}\n";
  }
};

Shot field_shot(const FieldText& scene, const std::string& options = "{}", const std::string& image = "160x90") {
  return {scene.text(), "[heightfield.init, bodies.place]",
          "[render.shadow_map, render.background, {render.heightfield: " + options + "}]", image};
}

// Seen where the field has a hole: nothing else is of this colour.
const std::string magenta_below = "{plane: {point: [0, -4, 0], normal: [0, 1, 0]}, color: [1, 0, 1]}";
bool is_magenta(const Pixel& pixel) { return pixel[0] > pixel[1] + 40 && pixel[2] > pixel[1] + 40; }

int count(const Picture& picture, bool (*wanted)(const Pixel&)) {
  int found = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) found += wanted(picture.at(x, y)) ? 1 : 0;
  return found;
}

std::vector<float> random_depths(std::mt19937_64& engine, std::size_t cells, float highest) {
  std::vector<float> depths(cells);
  for (float& depth : depths) depth = std::uniform_real_distribution<float>(0, highest)(engine);
  return depths;
}

// Depths of a field whose every cell is given by its column and row.
template <typename Of>
std::vector<float> depths_by_cell(const Of& of) {
  std::vector<float> depths;
  for (int z = 0; z < 64; ++z)
    for (int x = 0; x < 64; ++x) depths.push_back(static_cast<float>(of(x, z)));
  return depths;
}

double blueness(const Pixel& pixel) { return static_cast<double>(pixel[2]) / pixel[0]; }

}  // namespace

TEST_CASE("no gap opens between patches, however the edges are cut and however rough the snow is") {
  const std::string tessellation = GENERATE("constant", "distance");
  const std::string camera =
      GENERATE("{from: [3.2, 9, 3.2], to: [3.2, 0, 3.2], fov: 40}", "{from: [1, 3.5, 8], to: [3.2, 0, 3.2], fov: 30}");
  CAPTURE(tessellation, camera);
  INFO("seed " << seed());
  std::mt19937_64 engine(seed());
  FieldText scene;
  scene.bodies = "[" + magenta_below + "]";
  scene.camera = camera;
  Shot shot = field_shot(scene, "{patches: 7, factor: 9.3, near: 3, range: 5, tessellation: " + tessellation + "}", "640x360");
  shot.write("depth", random_depths(engine, 64 * 64, 0.9F));
  CHECK(count(shot.frame(), is_magenta) == 0);
}

TEST_CASE("a wireframe shows the triangles' edges, the more the finer the patches are cut") {
  const auto lines = [](const std::string& options) {
    return count(field_shot(FieldText(), options, "320x180").frame(), [](const Pixel& p) { return brightness(p) < 130; });
  };
  CHECK(lines("{factor: 6}") == 0);
  const int coarse = lines("{wireframe: true, factor: 2}"), fine = lines("{wireframe: true, factor: 6}");
  CHECK(coarse > 1000);
  CHECK(fine > 2 * coarse);
  CHECK(fine < 320 * 180);
}

TEST_CASE("both patches that share an edge cut it alike, by the distance of its middle from the camera") {
  using namespace firn::graph;
  const std::string mode = GENERATE("constant", "distance");
  CAPTURE(mode);
  INFO("seed " << seed());
  std::mt19937_64 engine(seed());
  constexpr int patches = 9, side = patches + 2;
  Registry registry;
  StageSpec spec = firn::stages::render::heightfield();
  spec.name = "test.edge_factors";
  std::erase_if(spec.parameters, [](const ParameterSpec& p) { return p.name == "wireframe" || p.name == "exposure"; });
  spec.constants = {"field_min", "field_cell", "camera_from", "scene_min"};
  const auto port = [](const char* name, ElementType type, const char* domain, Access access) {
    return Port{.name = name, .type = type, .domain = domain, .access = access, .unit = "1", .doc = "of the test"};
  };
  Port heights = port("field_height", ElementType::float1, "cells", Access::read);
  heights.usage = Usage::sampled;
  spec.ports = {heights, port("edge_factors", ElementType::vec4, "patch_numbers", Access::write),
                port("corner", ElementType::vec3, "patch_numbers", Access::write)};
  spec.work = {
      Dispatch{.kernel = std::string(FIRN_SOURCE_DIR) + "/tests/stages/shaders/edge_factors.comp", .over = "patch_numbers"}};
  registry.add(spec);
  Environment environment;
  environment.domains = {{"cells", {64 * 64, 64, 64}}, {"patch_numbers", {side * side}}};
  environment.constants = {{"field_min", ElementType::vec3, firn::graph::Vector3{1, 0, -2}, "m", ""},
                           {"field_cell", ElementType::float1, 0.1, "m", ""},
                           {"camera_from", ElementType::vec3, firn::graph::Vector3{3, 2, 5}, "m", ""},
                           {"scene_min", ElementType::vec3, firn::graph::Vector3{1, 0, -2}, "m", ""}};
  environment.provided = {"field_height", "edge_factors", "corner"};
  Arrays in;
  in.floats["field_height"] = random_depths(engine, 64 * 64, 2);
  const Arrays out = run_pipeline(
      "firn: 1\nstep:\n  - test.edge_factors: {patches: 9, factor: 20, near: 1, range: 6, tessellation: " + mode + "}\n",
      environment, registry, in, 0, 1);
  const std::vector<float>& factors = out.floats.at("edge_factors");
  const auto edge = [&](int x, int z, int which) { return factors[static_cast<std::size_t>(4 * (z * side + x) + which)]; };
  const auto corner = [&](int x, int z) -> Vector3d {
    const float* p = &out.floats.at("corner")[static_cast<std::size_t>(3 * (z * side + x))];
    return {p[0], p[1], p[2]};
  };
  for (int z = 0; z + 1 < side; ++z)
    for (int x = 0; x + 1 < side; ++x) {
      CHECK(edge(x, z, 2) == edge(x + 1, z, 0));
      CHECK(edge(x, z, 3) == edge(x, z + 1, 1));
      const double away = (0.5 * (corner(x, z) + corner(x + 1, z)) - Vector3d(3, 2, 5)).norm();
      const double expected = mode == "constant" ? 20 : 20 * (1 - std::clamp((away - 1) / 6, 0.0, 1.0)) + 1;
      CHECK(edge(x, z, 1) == Approx(expected).epsilon(1e-5));
    }
}

TEST_CASE("the slopes of a plane are those of the plane, up to the field's edges") {
  FieldText scene;
  Shot shot = field_shot(scene);
  shot.write("depth", depths_by_cell([](int x, int z) { return 1 + 0.1 * (0.25 * x - 0.5 * z) + 3.2; }));
  shot.frame();
  const std::vector<float> slope = shot.read("field_slope");
  for (std::size_t i = 0; i < slope.size(); i += 2) {
    CHECK(slope[i] == Approx(0.25).margin(1e-4));
    CHECK(slope[i + 1] == Approx(-0.5).margin(1e-4));
  }
}

TEST_CASE("a slope toward the sun is brighter than level snow, one away from it darker") {
  const auto bright = [](double slope) {
    FieldText scene;
    scene.sun = "[-1, -1, 0]";
    Shot shot = field_shot(scene);
    shot.write("depth", depths_by_cell([&](int x, int) { return 2 + slope * 0.1 * (x - 32); }));
    const Picture picture = shot.frame();
    int sum = 0;  // over some pixels, as snow has a grain
    for (int x = 70; x < 90; ++x)
      for (int y = 35; y < 55; ++y) sum += brightness(picture.at(x, y));
    return sum;
  };
  const int level = bright(0), toward = bright(-0.4), away = bright(0.4);  // the sun stands at +x
  CHECK(toward > level * 1.02);
  CHECK(away < level * 0.95);
}

TEST_CASE("a body's shadow lies where its rays meet the snow, and nowhere else") {
  const std::string shape = GENERATE("sphere: {radius: 0.5}", "box: {size: [0.8, 0.8, 0.8]}");
  CAPTURE(shape);
  FieldText scene;
  scene.bodies = "[{" + shape + ", position: [4.6, 1.7, 3.2]}]";
  scene.sun = "[-1, -1, 0]";  // down to y = 0.3 it moves 1.4 m along -x
  Shot shot = field_shot(scene);
  shot.frame();
  const Picture picture = shot.picture();
  // From straight above: +x is right, +z down; 9 - 0.3 m away.
  const double scale = 45 / (8.7 * std::tan(20 * M_PI / 180));
  const auto seen = [&](double x, double z) {
    int sum = 0;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        sum += brightness(picture.at(static_cast<int>(80 + scale * (x - 3.2)) + i, static_cast<int>(45 - scale * (z - 3.2)) + j));
    return sum / 9;
  };
  const int lit = seen(1.5, 1.5);
  CHECK(seen(3.2, 3.2) < 0.75 * lit);
  for (const auto& [x, z] : {std::pair{3.2, 4.2}, {3.2, 2.2}, {2.0, 3.2}}) CHECK(seen(x, z) > 0.9 * lit);
}

TEST_CASE("a wall of snow shades what lies behind it") {
  FieldText scene;
  scene.sun = "[-1, -1, 0]";
  Shot shot = field_shot(scene);
  shot.write("depth", depths_by_cell([](int x, int) { return x >= 30 && x < 33 ? 1.0 : 0.2; }));
  shot.frame();
  const std::vector<float> light = shot.read("field_light");
  const auto sun = [&](int x) { return light[static_cast<std::size_t>(2 * (32 * 64 + x) + 1)]; };
  CHECK(sun(26) < 0.05);  // the shadow reaches 0.8 m from the wall at 3.0 m
  CHECK(sun(23) < 0.3);
  CHECK(sun(19) > 0.95);
  CHECK(sun(35) > 0.95);
  // In the corner at the wall's foot less of the sky is seen.
  const auto sky = [&](int x) { return light[static_cast<std::size_t>(2 * (32 * 64 + x))]; };
  CHECK(sky(33) < 0.8);
  CHECK(sky(10) > 0.97);
}

TEST_CASE("pressed snow is darker and bluer than fresh snow, bare ground is brown") {
  const FieldText scene;
  Shot shot = field_shot(scene);
  shot.write("density", depths_by_cell([](int x, int) { return x < 21 ? 100 : 150; }));
  shot.write("depth", depths_by_cell([](int x, int) { return x < 42 ? 0.3 : 0.0; }));
  shot.frame();
  const Picture picture = shot.picture();
  const Pixel fresh = picture.at(55, 45), pressed = picture.at(80, 45), bare = picture.at(102, 45);
  CHECK(brightness(pressed) < brightness(fresh) - 30);
  CHECK(blueness(pressed) > blueness(fresh) + 0.05);
  CHECK(blueness(bare) < 0.9);
  CHECK(brightness(bare) < 0.7 * brightness(pressed));
}

TEST_CASE("sand keeps its colour") {
  FieldText scene;
  scene.field = "{size: [6.4, 6.4], cells: [64, 64], depth: 0.3, material: sand}";
  const Picture picture = field_shot(scene).frame();
  CHECK(blueness(picture.at(80, 45)) < 0.85);
}

TEST_CASE("snow hides what lies in it, a body hides the snow behind it") {
  FieldText scene;
  scene.bodies = "[{sphere: {radius: 0.5}, position: [3.2, 0.3, 3.2], color: [0.9, 0.05, 0.05]}]";
  scene.camera = "{from: [3.2, 0.6, 8], to: [3.2, 0.6, 3.2], fov: 20}";
  Shot shot = field_shot(scene);
  shot.frame();
  const auto is_red = [](const Pixel& pixel) { return pixel[0] > 2 * pixel[1]; };
  CHECK(is_red(shot.at({3.2, 0.6, 3.6})));
  CHECK_FALSE(is_red(shot.at({3.2, 0.1, 3.6})));
}

TEST_CASE("a mesh is seen in its colour and casts its shadow") {
  const firn::test::Folder folder;
  // A square pyramid, its base 1 m wide at y = 0, its top at y = 1.
  const std::string file = folder
                               .write("pyramid.obj",
                                      "v -0.5 0 -0.5\nv 0.5 0 -0.5\nv 0.5 0 0.5\nv -0.5 0 0.5\nv 0 1 0\n"
                                      "f 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n")
                               .string();
  FieldText scene;
  scene.bodies = "[{mesh: {file: " + file + "}, position: [3.2, 1.0, 3.2], color: [0.9, 0.05, 0.05]}]";
  scene.sun = "[-1, -1, 0]";
  Shot shot = field_shot(scene);
  const Picture picture = shot.frame();
  const auto is_red = [](const Pixel& pixel) { return pixel[0] > 2 * pixel[1] && pixel[0] > 60; };
  CHECK(is_red(picture.at(84, 45)));
  // The base's shadow is moved 0.7 m along -x: 2.0 to 3.0 m.
  const double scale = 45 / (8.7 * std::tan(20 * M_PI / 180));
  const auto px = [&](double x) { return static_cast<int>(80 + scale * (x - 3.2)); };
  CHECK(brightness(picture.at(px(2.45), 45)) < 0.75 * brightness(picture.at(px(1.2), 45)));
  CHECK_FALSE(is_red(picture.at(px(2.45), 45)));
}

TEST_CASE("without surroundings the field is a block with snow over earth on its sides") {
  FieldText scene;
  scene.bodies = "[" + magenta_below + "]";
  scene.field = "{size: [6.4, 6.4], cells: [64, 64], ground: 1, depth: 0.5, material: new_snow}";
  scene.camera = "{from: [3.2, 1.3, 14], to: [3.2, 1.3, 3.2], fov: 30}";
  Shot shot = field_shot(scene, "{surroundings: none}");
  shot.write("ground", depths_by_cell([](int, int) { return 1.5; }));
  shot.frame();
  CHECK(blueness(shot.at({3.2, 1.8, 6.4})) > 1.0);   // snow, from 1.5 to 2.0 m
  CHECK(blueness(shot.at({3.2, 1.2, 6.4})) < 0.95);  // earth below
  CHECK(is_magenta(shot.at({3.2, 0.2, 6.4})));       // and beneath the block
  CHECK(is_magenta(shot.at({-0.6, 0.2, 6.4})));
}

TEST_CASE("a field of one cell is drawn") {
  FieldText scene;
  scene.field = "{size: [6.4, 6.4], cells: [1, 1], depth: 0.3, material: new_snow}";
  scene.bodies = "[" + magenta_below + "]";
  CHECK(count(field_shot(scene).frame(), is_magenta) == 0);
}
