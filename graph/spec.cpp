#include "graph/spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace firn::graph {
namespace {

bool is_name(std::string_view text) {
  return !text.empty() && !(text.front() >= '0' && text.front() <= '9') &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

// Names that a use of a stage in a pipeline gives a meaning of its own (pipeline.cpp).
const std::set<std::string> reserved{"bind", "every", "enable", "as", "stage", "when", "dt", "time", "step", "frame"};

void check_parameter(const ParameterSpec& parameter, std::vector<std::string>& found) {
  const auto wrong = [&](std::string_view text) { found.push_back(fmt::format("parameter {}: {}", parameter.name, text)); };
  if (!is_name(parameter.name)) wrong("its name may hold a-z, 0-9 and _");
  if (reserved.contains(parameter.name)) wrong("its name is reserved");
  if (parameter.doc.empty()) wrong("has no doc");
  const Value& value = parameter.initial;
  switch (parameter.kind) {
    case ParameterKind::number:
      if (const auto* number = std::get_if<double>(&value); !number || *number < parameter.min || *number > parameter.max)
        wrong("its default is no number in its range");
      break;
    case ParameterKind::integer:
      if (const auto* number = std::get_if<std::int64_t>(&value);
          !number || static_cast<double>(*number) < parameter.min || static_cast<double>(*number) > parameter.max)
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
      if (!std::holds_alternative<Vector3>(value)) wrong("its default is no vector");
      break;
    case ParameterKind::path:
      if (!std::holds_alternative<std::string>(value)) wrong("its default is no text");
      break;
  }
}

}  // namespace

std::string_view describe(Fault fault) {
  switch (fault) {
    case Fault::not_a_number:
      return "a value that is not a finite number";
    case Fault::overflow:
      return "a sum that overflows its fixed-point range";
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

  std::set<std::string> ports;
  std::set<std::string> keys;
  for (const Port& port : spec.ports) {
    ports.insert(port.name);
    if (!is_name(port.name)) found.push_back(fmt::format("port {}: its name may hold a-z, 0-9 and _", port.name));
    if (port.doc.empty()) found.push_back(fmt::format("port {}: has no doc", port.name));
    if (port.domain.empty()) found.push_back(fmt::format("port {}: has no domain", port.name));
    if (port.unit.empty()) found.push_back(fmt::format("port {}: has no unit", port.name));
    if (!keys.insert(port.name + "/" + port.when.name + "=" + port.when.value).second)
      found.push_back(fmt::format("port {}: declared twice", port.name));
  }
  std::set<std::string> parameters;
  for (const ParameterSpec& parameter : spec.parameters) {
    check_parameter(parameter, found);
    if (!parameters.insert(parameter.name).second || ports.contains(parameter.name))
      found.push_back(fmt::format("parameter {}: the name is taken", parameter.name));
  }

  const auto need_port = [&](const std::string& name) {
    if (!ports.contains(name)) found.push_back(fmt::format("its work uses port {}, which it does not have", name));
  };
  for (const Work& work : spec.work) {
    std::visit(
        [&](const auto& w) {
          for (const PortUse& use : w.uses) need_port(use.port);
        },
        work);
    if (const auto* dispatch = std::get_if<Dispatch>(&work)) {
      if (dispatch->over.empty() == dispatch->indirect.empty())
        found.push_back(fmt::format("kernel {}: needs either a domain or an indirect port", dispatch->kernel));
      if (!dispatch->indirect.empty()) need_port(dispatch->indirect);
    }
    if (const auto* draw = std::get_if<Draw>(&work)) {
      for (const std::string& color : draw->colors) need_port(color);
      if (!draw->depth.empty()) need_port(draw->depth);
    }
  }
  return found;
}

}  // namespace firn::graph
