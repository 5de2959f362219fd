#include <fmt/format.h>

#include "config/nearest.h"
#include "scene/materials.h"
#include "scene/read.h"

namespace firn::scene::detail {

namespace {

// Snow ends at 918 kg/m3, solid ice; sand, which the height field knows too, lies at about 1500. Beyond is a slip of the unit.
constexpr Range density_range{0, 2000, true, false};
constexpr Range fraction{0, 1, true, true};

Material read_material(const std::string& name, const Node& node, Diagnostics& diagnostics) {
  Reader reader(node, fmt::format("material '{}'", name), diagnostics);
  Material material;
  if (const Node* preset = reader.find("preset"))
    if (const std::optional<std::string> chosen = config::read_choice(*preset, "preset", preset_names(), diagnostics))
      material = find_preset(*chosen)->material;
  material.name = name;
  material.place = node.place;

  material.density = reader.number("density", material.density, density_range);
  material.young = reader.number("young", material.young, positive);
  material.poisson = reader.number("poisson", material.poisson, {0, 0.5, false, true});
  material.hardening = reader.number("hardening", material.hardening, not_negative);
  material.critical_compression = reader.number("critical_compression", material.critical_compression, fraction);
  material.critical_stretch = reader.number("critical_stretch", material.critical_stretch, fraction);
  material.min_density = reader.number("min_density", material.min_density, density_range);
  material.max_density = reader.number("max_density", material.max_density, density_range);
  material.slope = reader.number("slope", material.slope, not_negative);
  material.color = vector3(reader, "color", material.color, {0, 1});
  reader.finish();

  // [H 3.9] divides by the difference.
  if (!(material.min_density < material.max_density)) {
    const Node* at = reader.has("min_density") ? node.find("min_density") : node.find("max_density");
    diagnostics.error(at != nullptr ? at->place : node.place,
                      fmt::format("min_density must be less than max_density: {:.6g} is not less than {:.6g} kg/m3",
                                  material.min_density, material.max_density));
  }
  return material;
}

}  // namespace

std::vector<Material> read_materials(const Node& node, Diagnostics& diagnostics) {
  std::vector<Material> materials;
  if (node.kind == Node::Kind::null) return materials;
  if (node.kind != Node::Kind::map) {
    diagnostics.error(node.place, fmt::format("materials must be a map of name: {{...}}, not {}", config::describe(node)));
    return materials;
  }
  constexpr std::size_t most_materials = 1000;
  if (node.entries.size() > most_materials) {
    diagnostics.error(node.entries[most_materials].place, fmt::format("more than {} materials", most_materials));
    return materials;
  }
  for (const config::Entry& entry : node.entries) materials.push_back(read_material(entry.key, entry.value, diagnostics));
  return materials;
}

std::optional<int> required_material(Reader& reader, std::string_view key, std::vector<Material>& materials) {
  const Node* node = reader.require(key);
  if (node == nullptr) return std::nullopt;
  const std::optional<std::string> name = config::read_text(*node, key, reader.diagnostics());
  if (!name) return std::nullopt;
  std::vector<std::string> choices;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (materials[i].name == *name) return static_cast<int>(i);
    choices.push_back(materials[i].name);
  }
  if (const MaterialPreset* preset = find_preset(*name)) {
    materials.push_back(preset->material);
    materials.back().place = node->place;
    return static_cast<int>(materials.size()) - 1;
  }
  for (const std::string& preset : preset_names()) choices.push_back(preset);
  reader.diagnostics().error(node->place, fmt::format("there is no material '{}'{}", *name, config::suggestion(*name, choices)));
  return std::nullopt;
}

}  // namespace firn::scene::detail
