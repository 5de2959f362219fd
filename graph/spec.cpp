#include "graph/spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <set>

namespace firn::graph {
namespace {

bool is_name(std::string_view text) {
  return !text.empty() && !(text.front() >= '0' && text.front() <= '9') &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

// Names that a use of a stage in a pipeline gives a meaning of its own (pipeline.cpp).
const std::set<std::string> reserved{"bind", "every", "enable", "as", "stage", "when"};
// Names that every kernel has (glsl.h).
const std::set<std::string> clock_names{"dt", "time", "step", "frame"};

void check_parameter(const ParameterSpec& parameter, std::vector<std::string>& found) {
  const auto wrong = [&](std::string_view text) { found.push_back(fmt::format("parameter {}: {}", parameter.name, text)); };
  if (!is_name(parameter.name)) wrong("its name may hold a-z, 0-9 and _");
  if (reserved.contains(parameter.name) || clock_names.contains(parameter.name)) wrong("its name is reserved");
  if (parameter.doc.empty()) wrong("has no doc");
  const Value& value = parameter.initial;
  const auto in_range = [&](double number) { return number >= parameter.min && number <= parameter.max; };  // NaN is not
  switch (parameter.kind) {
    case ParameterKind::number:
      if (const auto* number = std::get_if<double>(&value); !number || !in_range(*number))
        wrong("its default is no number in its range");
      break;
    case ParameterKind::integer:
      if (const auto* number = std::get_if<std::int64_t>(&value); !number || !in_range(static_cast<double>(*number)))
        wrong("its default is no whole number in its range");
      break;
    case ParameterKind::boolean:
      if (!std::holds_alternative<bool>(value)) wrong("its default is not true or false");
      break;
    case ParameterKind::choice:
      if (const auto* text = std::get_if<std::string>(&value); !text || std::ranges::count(parameter.choices, *text) != 1)
        wrong("its default is none of its choices");
      break;
    case ParameterKind::vector3:
      if (const auto* vector = std::get_if<Vector3>(&value); !vector || !std::ranges::all_of(*vector, in_range))
        wrong("its default is no vector in its range");
      break;
    case ParameterKind::path:
      if (!std::holds_alternative<std::string>(value)) wrong("its default is no text");
      break;
  }
}

bool is_one_of(ElementType type, std::initializer_list<ElementType> types) { return std::ranges::find(types, type) != types.end(); }

// Whether OpenGL can have the port's elements in this way.
void check_usage(const Port& port, Usage usage, std::vector<std::string>& found) {
  using enum ElementType;
  const auto wrong = [&](std::string_view text) {
    found.push_back(fmt::format("port {}: {} {}", port.name, name(port.type), text));
  };
  const bool in_block = usage == Usage::storage || usage == Usage::uniform || usage == Usage::vertex || usage == Usage::indirect;
  if (is_texel(port.type) && in_block) wrong("is only in textures");
  if (usage == Usage::uniform && port.domain != "1" && stride(port.type) % 16 != 0)
    wrong("cannot be an array with usage uniform, whose elements fill 16 bytes");
  if (usage == Usage::image && !is_one_of(port.type, {float1, vec2, vec3, vec4, int1, uint1, rgba8})) wrong("cannot be an image");
  if (usage == Usage::framebuffer && !is_one_of(port.type, {float1, vec2, vec3, vec4, rgba8, depth})) wrong("cannot be drawn to");
}

// Conditions on the stage's own choices; others are the environment's.
void check_condition(const Condition& condition, const StageSpec& spec, std::vector<std::string>& found) {
  const auto parameter = std::ranges::find(spec.parameters, condition.name, &ParameterSpec::name);
  if (parameter == spec.parameters.end() || parameter->kind != ParameterKind::choice) return;
  if (std::ranges::find(parameter->choices, condition.value) == parameter->choices.end())
    found.push_back(fmt::format("condition {} = {}: never holds", condition.name, condition.value));
}

}  // namespace

std::string_view describe(Fault fault) {
  switch (fault) {
    case Fault::not_a_number:
      return "a value that is not a finite number";
    case Fault::overflow:
      return "a sum or a list that outgrows the room kept for it";
    case Fault::left_domain:
      return "a particle outside the domain";
  }
  return "";
}

std::vector<std::string> problems(const StageSpec& spec) {
  std::vector<std::string> found;
  if (spec.name.empty()) found.emplace_back("has no name");
  if (spec.doc.empty()) found.emplace_back("has no doc");
  if (spec.work.empty()) found.emplace_back("has no work");
  // Far more than any device binds at once.
  constexpr std::size_t most_ports = 100, most_parameters = 100;
  if (spec.ports.size() > most_ports) return {fmt::format("has more than {} ports", most_ports)};
  if (spec.parameters.size() > most_parameters) return {fmt::format("has more than {} parameters", most_parameters)};

  std::set<std::string> ports;
  std::set<std::string> keys;
  for (const Port& port : spec.ports) {
    ports.insert(port.name);
    if (!is_name(port.name)) found.push_back(fmt::format("port {}: its name may hold a-z, 0-9 and _", port.name));
    if (clock_names.contains(port.name)) found.push_back(fmt::format("port {}: its name is reserved", port.name));
    if (port.doc.empty()) found.push_back(fmt::format("port {}: has no doc", port.name));
    if (port.domain.empty()) found.push_back(fmt::format("port {}: has no domain", port.name));
    if (port.unit.empty()) found.push_back(fmt::format("port {}: has no unit", port.name));
    if (!keys.insert(port.name + "/" + port.when.name + "=" + port.when.value).second)
      found.push_back(fmt::format("port {}: declared twice", port.name));
    check_usage(port, port.usage, found);
    check_condition(port.when, spec, found);
  }
  std::set<std::string> parameters;
  for (const ParameterSpec& parameter : spec.parameters) {
    check_parameter(parameter, found);
    if (!parameters.insert(parameter.name).second || ports.contains(parameter.name))
      found.push_back(fmt::format("parameter {}: the name is taken", parameter.name));
  }

  if (!spec.resizes.empty() &&
      (std::ranges::none_of(spec.ports, [&](const Port& port) { return port.domain == spec.resizes; }) ||
       std::ranges::none_of(spec.work, [](const Work& work) { return std::holds_alternative<HostWork>(work); })))
    found.push_back(fmt::format("resizes {}: needs a port over it, and work on the host", spec.resizes));

  const auto need_port = [&](const std::string& name) {
    if (!ports.contains(name)) found.push_back(fmt::format("its work uses port {}, which it does not have", name));
  };
  for (const Work& work : spec.work) {
    std::visit(
        [&](const auto& w) {
          check_condition(w.when, spec, found);
          for (const PortUse& use : w.uses) {
            need_port(use.port);
            for (const Port& port : spec.ports)
              if (port.name == use.port && use.usage && *use.usage != port.usage) check_usage(port, *use.usage, found);
          }
        },
        work);
    if (const auto* dispatch = std::get_if<Dispatch>(&work)) {
      if (dispatch->over.empty() == dispatch->indirect.empty())
        found.push_back(fmt::format("kernel {}: needs either a domain or an indirect port", dispatch->kernel));
      if (!dispatch->indirect.empty()) need_port(dispatch->indirect);
      for (const Arithmetic& one : dispatch->arithmetic) check_condition(one.when, spec, found);
    }
    if (const auto* draw = std::get_if<Draw>(&work)) {
      for (const std::string& color : draw->colors) need_port(color);
      if (!draw->depth.empty()) need_port(draw->depth);
    }
  }
  return found;
}

}  // namespace firn::graph
