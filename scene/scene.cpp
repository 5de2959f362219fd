#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "scene/read.h"

namespace firn::scene {

namespace detail {
namespace {

constexpr int format_version = 1;
constexpr int fewest_cells = 8;  // per axis: twice the cubic kernel's stencil, so that some cells are free of its margins
constexpr double nodes_per_block = 64;
constexpr double bytes_per_node = 36;         // mass and two velocities in single precision
constexpr double most_blocks = 2147483648.0;  // 2^31: blocks of 4 x 4 x 4 nodes are counted in 32 bits on the device

void read_version(Reader& reader) {
  const Node* node = reader.require("firn");
  if (node == nullptr) return;
  const std::optional<std::int64_t> version = config::read_integer(*node, "firn (the format version)", {}, reader.diagnostics());
  if (version && *version != format_version)
    reader.diagnostics().error(node->place, fmt::format("this scene has format version {}; this program reads version {}: firn: {}",
                                                        *version, format_version, format_version));
}

Time read_time(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "time", diagnostics);
  Time time;
  const Node* step = reader.find("dt");
  if (step != nullptr && !(step->kind == Node::Kind::scalar && step->scalar == "auto"))
    time.dt = config::read_number(*step, "dt (a number of seconds, or auto)", positive, diagnostics);
  time.cfl = reader.number("cfl", time.cfl, {0, 1, true, false});
  time.fps = reader.number("fps", time.fps, positive);
  time.end = reader.number("end", time.end, positive);
  reader.finish();
  return time;
}

Camera read_camera(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "the camera", diagnostics);
  Camera camera;
  camera.from = vector3(reader, "from", camera.from);
  camera.to = vector3(reader, "to", camera.to);
  camera.fov = reader.number("fov", camera.fov, {1, 170, true, true});
  reader.finish();
  if (camera.from == camera.to) diagnostics.error(node.place, "the camera must look somewhere: from and to are the same point");
  return camera;
}

Light read_light(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "the light", diagnostics);
  Light light;
  light.sun = vector3(reader, "sun", light.sun);
  reader.finish();
  if (!(light.sun.norm() > 0))
    diagnostics.error(node.place, "the sun's direction must not be zero; [0, -1, 0] shines straight down");
  return light;
}

void check_names(const std::vector<Body>& bodies, Diagnostics& diagnostics) {
  std::set<std::string> names;
  for (const Body& body : bodies)
    if (!names.insert(body.name).second)
      diagnostics.error(body.place, fmt::format("two bodies are called '{}'; names must differ", body.name));
}

}  // namespace

std::optional<Domain> read_domain(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "the domain", diagnostics);
  const std::optional<Vector3d> min = required_vector3(reader, "min");
  const std::optional<Vector3d> max = required_vector3(reader, "max");
  const double cell = reader.required_number("cell", positive);
  const std::int64_t blocks = reader.integer("blocks", 0, {1, most_blocks, false, false});
  reader.finish();
  if (!min || !max || std::isnan(cell)) return std::nullopt;

  const Place at_max = node.find("max")->place;
  bool good = true;
  const auto report = [&](std::string text) {
    diagnostics.error(at_max, std::move(text));
    good = false;
  };
  double nodes = 1;
  Vector3d fitting = *max;
  bool whole = true;
  for (int axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    const double cells = ((*max)[axis] - (*min)[axis]) / cell, count = std::round(cells);
    if (cells <= 0) {
      report(fmt::format("the domain's max must be greater than its min along {}: {:.6g} is not greater than {:.6g}", name,
                         (*max)[axis], (*min)[axis]));
      continue;
    }
    if (count < fewest_cells)
      report(fmt::format("the domain must have at least {} cells along {}, but has {:.4g}; max {} = {:.6g} is enough", fewest_cells,
                         name, cells, name, (*min)[axis] + fewest_cells * cell));
    if (std::abs(cells - count) > 1e-6 * std::max(1.0, count)) whole = false;
    fitting[axis] = (*min)[axis] + count * cell;
    nodes *= count + 1;
  }
  if (good && !whole)
    report(fmt::format("the domain's extent must be a whole multiple of cell = {:.6g}; the nearest that fits is max: {}", cell,
                       to_text(fitting)));
  if (good && nodes > most_blocks * nodes_per_block)
    report(fmt::format(
        "a grid of {:.4g} nodes is beyond 2^31 blocks of 4 x 4 x 4 (all of it would take {:.4g} GiB); a larger cell or a "
        "smaller domain is needed",
        nodes, nodes * bytes_per_node / (1 << 30)));
  if (!good) return std::nullopt;
  Domain domain;
  domain.min = *min;
  domain.max = *max;
  domain.cell = cell;
  if (blocks > 0) domain.blocks = blocks;
  domain.place = node.place;
  return domain;
}

}  // namespace detail

Eigen::Vector3i Domain::nodes() const { return ((max - min) / cell).array().round().cast<int>() + 1; }

bool may_turn(const Body& body) {
  const auto turned = [&](const KeyFrame& key) { return key.orientation.coeffs() != body.path.front().orientation.coeffs(); };
  return body.path.empty() ? body.mass || !body.spin.isZero(0) : std::ranges::any_of(body.path, turned);
}

Scene read_scene(const config::Node& root, config::Diagnostics& diagnostics) {
  using namespace detail;
  Reader reader(root, "a scene", diagnostics);
  Scene scene;
  scene.file = root.place.file;
  const std::filesystem::path file(scene.file);
  const std::filesystem::path folder = file.parent_path();

  read_version(reader);
  scene.name = reader.text("name", file.stem().string());
  scene.doc = reader.text("doc", "");
  scene.seed = static_cast<std::uint64_t>(reader.integer("seed", 1, not_negative));
  if (const Node* time = reader.find("time")) scene.time = read_time(*time, diagnostics);
  scene.gravity = vector3(reader, "gravity", scene.gravity);
  const Node* domain = reader.find("domain");
  if (domain != nullptr) scene.domain = read_domain(*domain, diagnostics);
  if (const Node* materials = reader.find("materials")) scene.materials = read_materials(*materials, diagnostics);

  const std::vector<Node>& snow = list(reader, "snow");
  for (const Node& node : snow)
    if (std::optional<Snow> each = read_snow(node, folder, scene.materials, diagnostics)) scene.snow.push_back(std::move(*each));
  const std::vector<Node>& emitters = list(reader, "emitters");
  for (const Node& node : emitters)
    if (std::optional<Emitter> each = read_emitter(node, scene.materials, diagnostics)) scene.emitters.push_back(*each);
  for (const Node& node : list(reader, "sinks"))
    if (std::optional<Sink> each = read_sink(node, diagnostics)) scene.sinks.push_back(*each);
  if (const Node* most = reader.find("max_particles")) {
    scene.max_particles = static_cast<std::uint64_t>(reader.integer("max_particles", 0, {1, most_particles, false, false}));
    scene.max_particles_place = most->place;
  }
  const Node* field = reader.find("field");
  if (field != nullptr) scene.field = read_field(*field, folder, scene.materials, diagnostics);
  const std::vector<Node>& bodies = list(reader, "bodies");
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (std::optional<Body> body = read_body(bodies[i], folder, i + 1, diagnostics)) scene.bodies.push_back(std::move(*body));
  if (const Node* camera = reader.find("camera")) scene.camera = read_camera(*camera, diagnostics);
  if (const Node* light = reader.find("light")) scene.light = read_light(*light, diagnostics);
  reader.finish();

  check_names(scene.bodies, diagnostics);
  const auto is_unreadable = [&](const char* key) {
    const Node* node = root.find(key);
    return node != nullptr && node->kind != Node::Kind::sequence && node->kind != Node::Kind::null;
  };
  if (root.kind == Node::Kind::map && snow.empty() && emitters.empty() && !is_unreadable("snow") && !is_unreadable("emitters") &&
      field == nullptr)
    diagnostics.error(
        root.place,
        "nothing to simulate: the scene has neither snow nor emitters (for particles), nor a field (for the height field)");
  if (domain == nullptr && !(snow.empty() && emitters.empty()))
    diagnostics.error((snow.empty() ? emitters : snow).front().place,
                      "snow needs a domain that it moves in: domain: {min: [x, y, z], max: [x, y, z], cell: h}");
  if (scene.domain) {
    check_snow(scene.snow, *scene.domain, diagnostics);
    check_emitters(scene, diagnostics);
    check_bodies(scene.bodies, *scene.domain, scene.time, scene.gravity, diagnostics);
  }
  return scene;
}

}  // namespace firn::scene
