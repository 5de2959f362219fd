#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "scene/mesh_solid.h"
#include "scene/read.h"

namespace firn::scene::detail {

std::optional<Plane> read_plane(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "a plane", diagnostics);
  Plane plane;
  plane.point = vector3(reader, "point", plane.point);
  const std::optional<Vector3d> normal = required_vector3(reader, "normal");
  reader.finish();
  if (!normal) return std::nullopt;
  if (!(normal->norm() > 0)) {
    diagnostics.error(node.find("normal")->place, "the normal of a plane must not be zero; [0, 1, 0] points up");
    return std::nullopt;
  }
  plane.normal = normal->normalized();
  return plane;
}

std::optional<Sphere> read_sphere(const Node& node, bool center_required, Diagnostics& diagnostics) {
  Reader reader(node, "a sphere", diagnostics);
  const std::optional<Vector3d> center =
      center_required ? required_vector3(reader, "center") : vector3(reader, "center", Vector3d::Zero());
  const double radius = reader.required_number("radius", positive);
  reader.finish();
  if (!center || std::isnan(radius)) return std::nullopt;
  return Sphere{*center, radius};
}

std::optional<Box> read_box(const Node& node, bool center_required, Diagnostics& diagnostics) {
  Reader reader(node, "a box", diagnostics);
  const bool by_corners = reader.has("min") || reader.has("max");
  if (by_corners && (reader.has("center") || reader.has("size"))) {
    diagnostics.error(node.place, "a box is given by center and size or by min and max, not by both");
    return std::nullopt;
  }
  if (by_corners) {
    const std::optional<Vector3d> min = required_vector3(reader, "min");
    const std::optional<Vector3d> max = required_vector3(reader, "max");
    reader.finish();
    if (!min || !max) return std::nullopt;
    for (int axis = 0; axis < 3; ++axis)
      if ((*min)[axis] >= (*max)[axis]) {
        diagnostics.error(node.find("max")->place,
                          fmt::format("the box's max must be greater than its min along {}: {:.6g} is not greater than {:.6g}",
                                      "xyz"[axis], (*max)[axis], (*min)[axis]));
        return std::nullopt;
      }
    return Box{0.5 * (*min + *max), 0.5 * (*max - *min)};
  }
  const std::optional<Vector3d> size = required_vector3(reader, "size", positive);
  const std::optional<Vector3d> center =
      center_required ? required_vector3(reader, "center") : vector3(reader, "center", Vector3d::Zero());
  reader.finish();
  if (!center || !size) return std::nullopt;
  return Box{*center, 0.5 * *size};
}

std::optional<Capsule> read_capsule(const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, "a capsule", diagnostics);
  const std::optional<Vector3d> from = required_vector3(reader, "from");
  const std::optional<Vector3d> to = required_vector3(reader, "to");
  const double radius = reader.required_number("radius", positive);
  reader.finish();
  if (!from || !to || std::isnan(radius)) return std::nullopt;
  if (*from == *to) {
    diagnostics.error(node.find("to")->place, "the two ends of a capsule must differ; a capsule without length is a sphere");
    return std::nullopt;
  }
  return Capsule{*from, *to, radius};
}

std::optional<Mesh> read_mesh(const Node& node, const std::filesystem::path& folder, Diagnostics& diagnostics) {
  Reader reader(node, "a mesh", diagnostics);
  const std::optional<std::string> file = required_file(reader, "file", folder);
  const double scale = reader.number("scale", 1, positive);
  tell_placement_of_snow(reader);
  reader.finish();
  if (!file) return std::nullopt;
  return Mesh{*file, scale};
}

namespace {

// Known from now on only where it is there, so that nobody is told it were valid.
const Node* misplaced(Reader& reader, const char* key) { return reader.has(key) ? reader.find(key) : nullptr; }

}  // namespace

void tell_placement_of_snow(Reader& reader) {
  for (const auto& [key, own] : {std::pair("translate", "position"), std::pair("rotate", "orientation")})
    if (const Node* given = misplaced(reader, key))
      reader.diagnostics().error(given->place,
                                 fmt::format("'{}' places snow of a mesh; a body takes '{}', beside its shape", key, own));
}

void tell_keys_of_mesh(Reader& reader, const std::vector<const char*>& keys) {
  for (const char* key : keys)
    if (const Node* given = misplaced(reader, key))
      reader.diagnostics().error(given->place, fmt::format("'{0}' belongs into the mesh: mesh: {{{0}: ...}}", key));
}

std::optional<SolidMesh> read_solid_mesh(const Node& node, const std::filesystem::path& folder, Diagnostics& diagnostics) {
  Reader reader(node, "a mesh", diagnostics);
  const std::optional<std::string> file = required_file(reader, "file", folder);
  const double scale = reader.number("scale", 1, positive);
  const Quaterniond rotate = orientation(reader, Quaterniond::Identity(), "rotate");
  const Vector3d translate = vector3(reader, "translate", Vector3d::Zero());
  reader.finish();
  if (!file) return std::nullopt;
  try {
    TriangleMesh mesh = scene::read_mesh(*file, scale);
    for (Vector3d& point : mesh.points) point = translate + rotate * point;
    if (const std::string wrong = to_string(repair(mesh)); !wrong.empty())
      diagnostics.warning(
          node.place,
          fmt::format("{}: this mesh has {}; what is inside is found all the same, but look at the result", *file, wrong));
    return SolidMesh{{*file, scale}, std::make_shared<const MeshSolid>(std::move(mesh))};
  } catch (const std::runtime_error& error) {
    diagnostics.error(node.find("file")->place, error.what());
    return std::nullopt;
  }
}

}  // namespace firn::scene::detail
