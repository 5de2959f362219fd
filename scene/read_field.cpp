#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/image.h"
#include "scene/read.h"

namespace firn::scene::detail {

namespace {

constexpr double most_cells = 2147483648.0;  // 2^31: cells are counted in 32 bits on the device

// A number, or {image: file, <unit_key>: value where the image is white}. Arrays hold plain values: their <unit_key> may be left
// out.
FieldSource read_source(Reader& field, const char* key, const char* unit_key, const Range& range, double fallback,
                        const std::filesystem::path& folder) {
  FieldSource source;
  source.value = fallback;
  const Node* node = field.find(key);
  source.place = node != nullptr ? node->place : field.node().place;
  if (node == nullptr) return source;
  Diagnostics& diagnostics = field.diagnostics();
  if (node->kind != Node::Kind::map) {
    source.value = config::read_number(*node, fmt::format("{} (a number or {{image: file, {}: value of white}})", key, unit_key),
                                       range, diagnostics)
                       .value_or(fallback);
    return source;
  }
  Reader reader(*node, fmt::format("the field's {}", key), diagnostics);
  source.image = required_file(reader, "image", folder).value_or("");
  source.unit_value = is_array(source.image) ? reader.number(unit_key, 1, range) : reader.required_number(unit_key, range);
  reader.finish();
  return source;
}

void check_cells(const Node& node, const Field& field, Diagnostics& diagnostics) {
  const double cell_x = field.size.x() / field.cells_x, cell_z = field.size.y() / field.cells_z;
  if (std::abs(cell_x - cell_z) > 1e-6 * std::max(cell_x, cell_z)) {
    diagnostics.error(
        node.find("cells")->place,
        fmt::format("the field's cells must be square, but are {:.9g} m x {:.9g} m; a size of [{:.9g}, {:.9g}] fits these cells",
                    cell_x, cell_z, field.size.x(), cell_x * field.cells_z));
  }
  const double count = static_cast<double>(field.cells_x) * field.cells_z;
  if (count > most_cells) {
    // Ground, height and density, 4 bytes each, are the least that a cell holds.
    diagnostics.error(
        node.find("cells")->place,
        fmt::format("a field of {} x {} = {:.0f} cells is beyond 2^31 and would take at least {:.0f} GiB; fewer cells are needed",
                    field.cells_x, field.cells_z, count, count * 12 / (1 << 30)));
  }
}

void check_density(const Node& node, const FieldSource& density, const Material& material, Diagnostics& diagnostics) {
  if (is_array(density.image)) return;  // sample_field sees its values
  const double value = density.image.empty() ? density.value : density.unit_value;
  if (std::isnan(value) || (value >= material.min_density && value <= material.max_density)) return;
  const Node* at = node.find("density");
  diagnostics.error(
      at != nullptr ? at->place : node.place,
      fmt::format(
          "the field's density of {:.6g} kg/m3{} lies outside of material '{}', which goes from {:.6g} (min_density) to {:.6g} "
          "(max_density)",
          value, at == nullptr ? " (the material's)" : (density.image.empty() ? "" : " at white"), material.name,
          material.min_density, material.max_density));
}

}  // namespace

std::optional<Field> read_field(const Node& node, const std::filesystem::path& folder, std::vector<Material>& materials,
                                Diagnostics& diagnostics) {
  Reader reader(node, "the field", diagnostics);
  Field field;
  field.place = node.place;

  bool measured = false;
  const Node* size = reader.require("size");
  const Node* cells = reader.require("cells");
  const auto pair = [&](const Node* list, const char* what, const Range& range) -> std::optional<std::vector<double>> {
    return list == nullptr ? std::nullopt : read_numbers(*list, what, 2, range, diagnostics);
  };
  const std::optional<std::vector<double>> extents = pair(size, "size [x, z]", positive);
  std::optional<std::vector<double>> counts = pair(cells, "cells [x, z]", {1, 1 << 20});
  for (int i = 0; counts && i < 2; ++i) {
    if (!config::read_integer(cells->items[static_cast<std::size_t>(i)], "cells [x, z]", {}, diagnostics)) counts.reset();
  }
  if (extents && counts) {
    field.size = {(*extents)[0], (*extents)[1]};
    field.cells_x = static_cast<int>((*counts)[0]);
    field.cells_z = static_cast<int>((*counts)[1]);
    check_cells(node, field, diagnostics);
    measured = true;
  }
  if (const Node* origin = reader.find("origin"))
    if (const auto corner = read_numbers(*origin, "origin [x, z]", 2, {}, diagnostics)) field.origin = {(*corner)[0], (*corner)[1]};

  const std::optional<int> material = required_material(reader, "material", materials);
  field.material = material.value_or(0);
  field.ground = read_source(reader, "ground", "metres", {}, 0, folder);
  reader.require("depth");
  field.depth = read_source(reader, "depth", "metres", not_negative, 0, folder);
  const double density = material ? materials[static_cast<std::size_t>(*material)].density : 0;
  field.density = read_source(reader, "density", "density", positive, density, folder);
  reader.finish();
  if (!measured || !material) return std::nullopt;
  check_density(node, field.density, materials[static_cast<std::size_t>(*material)], diagnostics);
  return field;
}

}  // namespace firn::scene::detail
