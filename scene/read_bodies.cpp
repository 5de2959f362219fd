#include <fmt/format.h>

#include <cmath>

#include "scene/read.h"

namespace firn::scene::detail {

namespace {

// A place written inside the shape, and whether it was written at all.
struct OwnPlace {
  Vector3d place{0, 0, 0};
  bool given = false;
};

// Reads the shape and moves its centre to the origin; where it stood goes to `own`.
bool read_shape(const Kind& kind, const std::filesystem::path& folder, Shape& shape, OwnPlace& own, Diagnostics& diagnostics) {
  const Node& node = *kind.node;
  if (kind.name == "plane") {
    std::optional<Plane> plane = read_plane(node, diagnostics);
    if (!plane) return false;
    own = {plane->point, node.find("point") != nullptr};
    plane->point = Vector3d::Zero();
    shape = *plane;
  } else if (kind.name == "sphere") {
    std::optional<Sphere> sphere = read_sphere(node, false, diagnostics);
    if (!sphere) return false;
    own = {sphere->center, node.find("center") != nullptr};
    sphere->center = Vector3d::Zero();
    shape = *sphere;
  } else if (kind.name == "box") {
    std::optional<Box> box = read_box(node, false, diagnostics);
    if (!box) return false;
    own = {box->center, node.find("center") != nullptr || node.find("min") != nullptr};
    box->center = Vector3d::Zero();
    shape = *box;
  } else if (kind.name == "capsule") {
    std::optional<Capsule> capsule = read_capsule(node, diagnostics);
    if (!capsule) return false;
    const Vector3d middle = 0.5 * (capsule->start + capsule->end);
    const Vector3d half_axis = 0.5 * (capsule->end - capsule->start);
    own = {middle, middle.norm() > 1e-9 * half_axis.norm()};
    shape = Capsule{-half_axis, half_axis, capsule->radius};
  } else {
    const std::optional<Mesh> mesh = read_mesh(node, folder, diagnostics);
    if (!mesh) return false;
    shape = *mesh;
  }
  return true;
}

// A place inside the shape beside one for the body.
std::string twice_placed(const std::string& kind, const Shape& shape, const char* other) {
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    return fmt::format("beside a {}, a capsule's from and to must lie opposite each other about [0, 0, 0]: from: {}, to: {}", other,
                       to_text(capsule->start), to_text(capsule->end));
  const char* keys = kind == "plane" ? "point" : kind == "box" ? "center (or min and max)" : "center";
  return fmt::format("this body's place is given twice, by the {}'s {} and by {}; one of them must go", kind, keys, other);
}

void read_path(Reader& body, Body& result) {
  Diagnostics& diagnostics = body.diagnostics();
  double last = -1;
  Quaterniond turn = result.orientation;
  for (const Node& node : list(body, "path")) {
    Reader reader(node, "a point of the path", diagnostics);
    KeyFrame key;
    key.time = reader.required_number("t", not_negative);
    const std::optional<Vector3d> position = required_vector3(reader, "position");
    key.orientation = turn = orientation(reader, turn);
    reader.finish();
    if (std::isnan(key.time) || !position) continue;
    if (key.time <= last)
      diagnostics.error(node.find("t")->place,
                        fmt::format("the times of a path must ascend, but {:.6g} s comes after {:.6g} s", key.time, last));
    last = key.time;
    key.position = *position;
    result.path.push_back(key);
  }
}

}  // namespace

std::optional<Body> read_body(const Node& node, const std::filesystem::path& folder, std::size_t number, Diagnostics& diagnostics) {
  Reader reader(node, "a body", diagnostics);
  Body body;
  body.place = node.place;
  OwnPlace own;
  const std::optional<Kind> kind = one_of(reader, {"plane", "sphere", "box", "capsule", "mesh"}, "a body");
  const bool complete = kind && read_shape(*kind, folder, body.shape, own, diagnostics);

  body.name = reader.text("name", fmt::format("body {}", number));
  body.orientation = orientation(reader, body.orientation);
  read_path(reader, body);
  body.position = vector3(reader, "position", body.path.empty() ? own.place : body.path.front().position);
  body.velocity = vector3(reader, "velocity", body.velocity);
  body.spin = vector3(reader, "spin", body.spin);
  if (const Node* mass = reader.find("mass")) body.mass = config::read_number(*mass, "mass", positive, diagnostics);
  body.friction = reader.number("friction", body.friction, not_negative);
  body.color = vector3(reader, "color", body.color, {0, 1});
  tell_placement_of_snow(reader);
  if (kind && kind->name == "mesh") tell_keys_of_mesh(reader, {"file", "scale"});
  reader.finish();

  const bool has_path = !body.path.empty();
  if (complete && own.given && (reader.has("position") || has_path))
    diagnostics.error(kind->node->place, twice_placed(kind->name, body.shape, reader.has("position") ? "position" : "path"));
  if (has_path)
    for (const char* key : {"velocity", "spin"})
      if (const Node* given = node.find(key))
        diagnostics.error(given->place,
                          fmt::format("a body with a path moves along it; '{}' would have no effect: remove one of them", key));
  if (body.mass && kind && kind->name == "plane")
    diagnostics.error(node.find("mass")->place, "a plane has no end and so no mass; without mass it moves as told");
  if (!complete) return std::nullopt;
  return body;
}

}  // namespace firn::scene::detail
