#include "graph/spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <utility>

#include "graph/spec_problems.h"

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

// A count, a domain, or one scaled (DomainText).
bool is_domain_text(std::string_view text) {
  const std::size_t sign = text.find_first_of("*/");
  const auto is_count = [](std::string_view part) {
    return !part.empty() && part != "0" && std::ranges::all_of(part, [](char c) { return c >= '0' && c <= '9'; });
  };
  const std::string_view base = text.substr(0, sign);
  return (is_name(base) || is_count(base) || base == "0") && (sign == std::string_view::npos || is_count(text.substr(sign + 1)));
}

// What is wrong with one part of a spec.
class Part {
 public:
  Part(std::string name, std::vector<Problem>& found) : name_(std::move(name)), found_(found) {}
  void wrong(std::vector<std::string> keys, std::string_view text) const {
    found_.push_back({name_, std::move(keys), fmt::format("{}: {}", name_, text)});
  }

 private:
  std::string name_;
  std::vector<Problem>& found_;
};

void check_parameter(const ParameterSpec& parameter, const Part& part) {
  if (!is_name(parameter.name)) part.wrong({}, "its name may hold a-z, 0-9 and _");
  if (reserved.contains(parameter.name) || clock_names.contains(parameter.name)) part.wrong({}, "its name is reserved");
  if (parameter.doc.empty()) part.wrong({"doc"}, "has no doc");
  const Value& value = parameter.initial;
  const auto in_range = [&](double number) { return number >= parameter.min && number <= parameter.max; };  // NaN is not
  const auto wrong_default = [&](std::string_view text) { part.wrong({"default", "kind"}, text); };
  switch (parameter.kind) {
    case ParameterKind::number:
      if (const auto* number = std::get_if<double>(&value); !number || !in_range(*number))
        wrong_default("its default is no number in its range");
      break;
    case ParameterKind::integer:
      if (const auto* number = std::get_if<std::int64_t>(&value); !number || !in_range(static_cast<double>(*number)))
        wrong_default("its default is no whole number in its range");
      break;
    case ParameterKind::boolean:
      if (!std::holds_alternative<bool>(value)) wrong_default("its default is not true or false");
      break;
    case ParameterKind::choice:
      if (const auto* text = std::get_if<std::string>(&value); !text || std::ranges::count(parameter.choices, *text) != 1)
        wrong_default("its default is none of its choices");
      break;
    case ParameterKind::vector3:
      if (const auto* vector = std::get_if<Vector3>(&value); !vector || !std::ranges::all_of(*vector, in_range))
        wrong_default("its default is no vector in its range");
      break;
    case ParameterKind::path:
      if (!std::holds_alternative<std::string>(value)) wrong_default("its default is no text");
      break;
  }
}

bool is_one_of(ElementType type, std::initializer_list<ElementType> types) { return std::ranges::find(types, type) != types.end(); }

// Whether OpenGL can have the port's elements in this way.
void check_usage(const Port& port, Usage usage, const Part& part) {
  using enum ElementType;
  const auto wrong = [&](std::string_view text) {
    part.wrong({"type", "usage", "domain"}, fmt::format("{} {}", name(port.type), text));
  };
  const bool in_block = usage == Usage::storage || usage == Usage::uniform || usage == Usage::vertex || usage == Usage::indirect;
  if (is_texel(port.type) && in_block) wrong("is only in textures");
  if (usage == Usage::uniform && port.domain != "1" && stride(port.type) % 16 != 0)
    wrong("cannot be an array with usage uniform, whose elements fill 16 bytes");
  if (usage == Usage::image && !is_one_of(port.type, {float1, vec2, vec3, vec4, int1, uint1, rgba8})) wrong("cannot be an image");
  if (usage == Usage::framebuffer && !is_one_of(port.type, {float1, vec2, vec3, vec4, rgba8, depth})) wrong("cannot be drawn to");
}

// Conditions on the stage's own choices; others are the environment's.
void check_condition(const Condition& condition, const StageSpec& spec, std::vector<Problem>& found) {
  const auto parameter = std::ranges::find(spec.parameters, condition.name, &ParameterSpec::name);
  if (parameter == spec.parameters.end() || parameter->kind != ParameterKind::choice) return;
  if (std::ranges::find(parameter->choices, condition.value) == parameter->choices.end())
    found.push_back({"", {}, fmt::format("condition {} = {}: never holds", condition.name, condition.value)});
}

void check_domain(const DomainText& domain, const Part& part) {
  if (domain.empty())
    part.wrong({"domain"}, "has no domain");
  else if (!is_domain_text(domain))
    part.wrong({"domain"},
               fmt::format("its domain '{}' is no count, no domain and none scaled, such as cells*2 or cells/4", domain));
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

std::vector<Problem> find_problems(const StageSpec& spec) {
  std::vector<Problem> found;
  const auto of_stage = [&](std::vector<std::string> keys, std::string text) {
    found.push_back({"", std::move(keys), std::move(text)});
  };
  if (spec.name.empty()) of_stage({"name"}, "has no name");
  if (spec.doc.empty()) of_stage({"doc"}, "has no doc");
  if (spec.work.empty()) of_stage({}, "has no work");
  // Far more than any device binds at once.
  constexpr std::size_t most_ports = 100, most_parameters = 100;
  if (spec.ports.size() > most_ports) return {{"", {"ports"}, fmt::format("has more than {} ports", most_ports)}};
  if (spec.parameters.size() > most_parameters)
    return {{"", {"parameters"}, fmt::format("has more than {} parameters", most_parameters)}};

  std::set<std::string> ports;
  std::set<std::string> keys;
  for (const Port& port : spec.ports) {
    const Part part("port " + port.name, found);
    ports.insert(port.name);
    if (!is_name(port.name)) part.wrong({}, "its name may hold a-z, 0-9 and _");
    if (clock_names.contains(port.name)) part.wrong({}, "its name is reserved");
    if (port.doc.empty()) part.wrong({"doc"}, "has no doc");
    check_domain(port.domain, part);
    if (port.unit.empty()) part.wrong({"unit"}, "has no unit");
    if (!keys.insert(port.name + "/" + port.when.name + "=" + port.when.value).second) part.wrong({}, "declared twice");
    check_usage(port, port.usage, part);
    check_condition(port.when, spec, found);
  }
  std::set<std::string> taken = ports;
  for (const ParameterSpec& parameter : spec.parameters) {
    const Part part("parameter " + parameter.name, found);
    check_parameter(parameter, part);
    if (!taken.insert(parameter.name).second) part.wrong({}, "the name is taken");
  }
  for (const std::string& constant : spec.constants)
    if (!taken.insert(constant).second) Part("constant " + constant, found).wrong({}, "the name is taken");

  if (!spec.resizes.empty() &&
      (std::ranges::none_of(spec.ports, [&](const Port& port) { return port.domain == spec.resizes; }) ||
       std::ranges::none_of(spec.work, [](const Work& work) { return std::holds_alternative<HostWork>(work); })))
    of_stage({}, fmt::format("resizes {}: needs a port over it, and work on the host", spec.resizes));

  const auto need_port = [&](const std::string& name) {
    if (!ports.contains(name)) of_stage({}, fmt::format("its work uses port {}, which it does not have", name));
  };
  for (const Work& work : spec.work) {
    std::visit(
        [&](const auto& w) {
          check_condition(w.when, spec, found);
          for (const PortUse& use : w.uses) {
            need_port(use.port);
            for (const Port& port : spec.ports)
              if (port.name == use.port && use.usage && *use.usage != port.usage)
                check_usage(port, *use.usage, Part("port " + port.name, found));
          }
        },
        work);
    if (const auto* dispatch = std::get_if<Dispatch>(&work)) {
      if (dispatch->over.empty() == dispatch->indirect.empty())
        of_stage({"over"}, fmt::format("kernel {}: needs either a domain or an indirect port", dispatch->kernel));
      else if (!dispatch->over.empty() && !is_domain_text(dispatch->over))
        of_stage({"over"}, fmt::format("'{}' is no count, no domain and none scaled, such as cells*2 or cells/4", dispatch->over));
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

std::vector<std::string> problems(const StageSpec& spec) {
  std::vector<std::string> texts;
  for (Problem& problem : find_problems(spec)) texts.push_back(std::move(problem.text));
  return texts;
}

}  // namespace firn::graph
