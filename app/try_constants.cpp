#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/try_sizes.h"
#include "config/nearest.h"
#include "config/reader.h"

namespace firn::app {
namespace {

using graph::Constant;

std::optional<graph::Value> read_constant(const Constant& known, const config::Node& node, config::Diagnostics& diagnostics) {
  if (graph::components(known.type) == 3) {
    const auto vector = config::read_vector3(node, known.name, {}, diagnostics);
    const bool whole = known.type == graph::ElementType::ivec3;
    if (vector && whole && std::ranges::any_of(*vector, [](double part) { return part != std::floor(part); }))
      diagnostics.error(node.place, fmt::format("{} must be three whole numbers, not {}", known.name, graph::to_string(*vector)));
    else if (vector)
      return graph::Value(*vector);
  } else if (const auto number = config::read_number(node, known.name, {}, diagnostics)) {
    return graph::Value(*number);
  }
  return std::nullopt;
}

std::string_view pattern(graph::ElementType type) {
  if (type == graph::ElementType::ivec3) return "[NX, NY, NZ]";
  return type == graph::ElementType::vec3 ? "[X, Y, Z]" : "VALUE";
}

// Fixed-point scales from the arrays: no node can get more than all particles have.
std::optional<double> scale_from(const std::string& name, const GivenArrays& arrays) {
  const auto mass = arrays.find("mass"), velocity = arrays.find("velocity"), position = arrays.find("position");
  if (name == "crowd" && position != arrays.end())
    return std::max(1.0, static_cast<double>(position->second.array.values.size()) / 3);
  if (mass == arrays.end()) return std::nullopt;
  double bound = 0;
  for (const double m : mass->second.array.values) bound += std::abs(m);
  if (name == "momentum_scale") {
    double fastest = 0;  // without velocities they rest
    if (velocity != arrays.end())
      for (const double v : velocity->second.array.values) fastest = std::max(fastest, std::abs(v));
    bound *= fastest;
  } else if (name != "mass_scale") {
    return std::nullopt;
  }
  constexpr double range = 2147483647.0 / 2;
  if (!std::isfinite(bound)) return std::nullopt;
  return bound > 0 ? std::exp2(std::floor(std::log2(range / bound))) : 1.0;
}

// What a scene without anything special says.
std::optional<graph::Value> fallback(const std::string& name, const graph::Environment& known) {
  if (name == "field_cell") return 1.0;
  if (name == "field_min" || name == "grid_min") return graph::Vector3{0, 0, 0};
  constexpr std::string_view usual[] = {"gravity",       "min_density", "max_density", "material_slope", "field_color",
                                        "sun_direction", "camera_from", "camera_to",   "camera_fov"};
  if (std::ranges::find(usual, name) == std::end(usual)) return std::nullopt;
  return known.constant(name)->value;
}

}  // namespace

void set_constants(const graph::StageSpec& spec, const GivenArrays& arrays, const std::vector<std::string>& words,
                   const graph::Environment& known, graph::Environment& environment, std::vector<std::string>& notes,
                   config::Diagnostics& diagnostics) {
  const auto put = [&](Constant constant, const graph::Value& value) {
    std::erase_if(environment.constants, [&](const Constant& other) { return other.name == constant.name; });
    constant.value = value;
    environment.constants.push_back(constant);
  };
  for (const std::string& word : words) {
    const config::Place place{"--constant " + word, 0, 0};
    config::Diagnostics of_word;
    config::Override given = config::parse_override(word, of_word);
    if (of_word.has_errors() || given.path.size() != 1) {
      diagnostics.error(place, "expected NAME=VALUE, such as field_cell=0.1 or gravity=[0, -1.62, 0]");
      continue;
    }
    given.value.place = place;
    const std::string& name = given.path.front();
    const Constant* constant = known.constant(name);
    if (constant == nullptr || std::ranges::find(spec.constants, name) == spec.constants.end())
      diagnostics.error(place, spec.constants.empty() ? fmt::format("{} uses no constants", spec.name)
                                                      : fmt::format("{} uses no constant '{}'{}", spec.name, name,
                                                                    config::suggestion(name, spec.constants)));
    else if (const auto value = read_constant(*constant, given.value, diagnostics))
      put(*constant, *value);
  }
  const bool works_on_nodes =
      std::ranges::any_of(spec.ports, [](const graph::Port& port) { return graph::base_domain(port.domain) == "nodes"; });
  for (const std::string& name : spec.constants) {
    if (environment.constant(name) != nullptr) continue;
    const Constant* constant = known.constant(name);
    if (constant == nullptr) continue;  // compiling tells
    std::optional<graph::Value> value;
    if (const auto scale = scale_from(name, arrays)) value = *scale;
    const bool from_arrays = value.has_value();
    if (!value) value = fallback(name, known);
    if (value) {
      put(*constant, *value);
      notes.push_back(fmt::format("{} = {} {} ({}): {}", name, graph::to_string(*value), constant->unit, constant->doc,
                                  from_arrays ? "from the arrays" : "not given"));
    } else if (name != "grid_nodes" || !works_on_nodes) {  // else their size is missing, which is told
      diagnostics.error({"try " + spec.name, 0, 0},
                        fmt::format("needs '{}' ({}, {}): {}; give --constant {}={} or --scene SCENE", name,
                                    graph::name(constant->type), constant->unit, constant->doc, name, pattern(constant->type)));
    }
  }
}

}  // namespace firn::app
