#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "scene/points.h"
#include "scene/read.h"

namespace firn::scene::detail {

namespace {

std::optional<PointFile> read_point_file(const Node& node, const std::filesystem::path& folder, Diagnostics& diagnostics) {
  Reader reader(node, "points", diagnostics);
  const std::optional<std::string> file = required_file(reader, "file", folder);
  const double mass = reader.required_number("mass", positive);
  reader.finish();
  if (!file || std::isnan(mass)) return std::nullopt;
  try {
    count_points(*file);  // what the header tells; the points themselves are read when particles are made
  } catch (const std::runtime_error& error) {
    diagnostics.error(node.find("file")->place, error.what());
    return std::nullopt;
  }
  return PointFile{*file, mass};
}

}  // namespace

std::optional<Snow> read_snow(const Node& node, const std::filesystem::path& folder, std::vector<Material>& materials,
                              Diagnostics& diagnostics) {
  Reader reader(node, "a piece of snow", diagnostics);
  Snow snow;
  snow.place = node.place;
  bool complete = false;
  const auto take = [&](auto shape) {
    complete = shape.has_value();
    if (complete) snow.what = *shape;
  };
  const std::optional<Kind> kind = one_of(reader, {"sphere", "box", "capsule", "mesh", "points"}, "a piece of snow");
  if (kind && kind->name == "sphere") {
    take(read_sphere(*kind->node, true, diagnostics));
  } else if (kind && kind->name == "box") {
    take(read_box(*kind->node, true, diagnostics));
  } else if (kind && kind->name == "capsule") {
    take(read_capsule(*kind->node, diagnostics));
  } else if (kind && kind->name == "points") {
    take(read_point_file(*kind->node, folder, diagnostics));
  } else if (kind) {
    take(read_solid_mesh(*kind->node, folder, diagnostics));
  }

  const std::optional<int> material = required_material(reader, "material", materials);
  snow.velocity = vector3(reader, "velocity", snow.velocity);
  snow.spin = vector3(reader, "spin", snow.spin);
  snow.orientation = orientation(reader, snow.orientation);
  snow.per_cell = static_cast<int>(reader.integer("per_cell", snow.per_cell, {1, 64}));
  snow.sampling =
      reader.choice("sampling", {"jittered", "poisson"}, "jittered") == "poisson" ? Sampling::poisson : Sampling::jittered;
  if (kind && kind->name == "mesh") tell_keys_of_mesh(reader, {"file", "scale", "rotate", "translate"});
  reader.finish();
  if (kind && kind->name == "mesh")
    if (const Node* given = node.find("orientation"))
      diagnostics.error(given->place, "a mesh is turned by 'rotate' beside its file; 'orientation' is for boxes and capsules");
  if (kind && kind->name == "points")
    for (const char* key : {"orientation", "per_cell", "sampling"})
      if (const Node* given = node.find(key))
        diagnostics.error(given->place,
                          fmt::format("'{}' has no meaning for points, which stand where their file says; remove it", key));

  if (!complete || !material) return std::nullopt;
  snow.material = *material;
  return snow;
}

}  // namespace firn::scene::detail
