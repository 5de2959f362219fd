#include "app/spec_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace firn::app {
namespace {

using nlohmann::json;

std::string_view kind_name(graph::ParameterKind kind) {
  switch (kind) {
    case graph::ParameterKind::number:
      return "number";
    case graph::ParameterKind::integer:
      return "integer";
    case graph::ParameterKind::boolean:
      return "boolean";
    case graph::ParameterKind::choice:
      return "choice";
    case graph::ParameterKind::vector3:
      return "vector";
    case graph::ParameterKind::path:
      return "path";
  }
  return "";
}

json value_json(const graph::Value& value) {
  return std::visit([](const auto& v) { return json(v); }, value);
}

std::string when_text(const graph::Condition& when) {
  return when.name.empty() ? "" : fmt::format("only where {} is {}", when.name, when.value);
}

const graph::Condition& condition(const graph::Work& work) {
  return std::visit([](const auto& one) -> const graph::Condition& { return one.when; }, work);
}

const std::vector<graph::PortUse>& uses_of(const graph::Work& work) {
  return std::visit([](const auto& one) -> const std::vector<graph::PortUse>& { return one.uses; }, work);
}

json port_json(const graph::Port& port) {
  json result = {{"name", port.name},
                 {"type", graph::name(port.type)},
                 {"domain", port.domain},
                 {"access", graph::name(port.access)},
                 {"usage", graph::name(port.usage)},
                 {"unit", port.unit},
                 {"doc", port.doc},
                 {"optional", port.optional}};
  if (!port.when.name.empty()) result["when"] = {{port.when.name, port.when.value}};
  return result;
}

json parameter_json(const graph::ParameterSpec& parameter) {
  json result = {{"name", parameter.name},
                 {"kind", kind_name(parameter.kind)},
                 {"default", value_json(parameter.initial)},
                 {"unit", parameter.unit},
                 {"doc", parameter.doc}};
  if (std::isfinite(parameter.min)) result["min"] = parameter.min;
  if (std::isfinite(parameter.max)) result["max"] = parameter.max;
  if (!parameter.choices.empty()) result["choices"] = parameter.choices;
  return result;
}

json work_json(const graph::Work& work) {
  json result;
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) {
    result = {{"dispatch", dispatch->kernel}, {"group", dispatch->group}};
    if (dispatch->indirect.empty())
      result["over"] = dispatch->over;
    else
      result["indirect"] = dispatch->indirect;
    if (!dispatch->needs.empty()) result["needs"] = dispatch->needs;
    for (const graph::Arithmetic& one : dispatch->arithmetic) {
      json entry = {{"per", one.per}, {"operations", one.operations}};
      if (!one.when.name.empty()) entry["when"] = {{one.when.name, one.when.value}};
      result["arithmetic"].push_back(entry);
    }
  } else if (const auto* draw = std::get_if<graph::Draw>(&work)) {
    result = {{"draw", draw->name},           {"vertex", draw->vertex},     {"fragment", draw->fragment},
              {"instances", draw->instances}, {"vertices", draw->vertices}, {"colors", draw->colors}};
    if (!draw->tessellation_control.empty()) result["tessellation_control"] = draw->tessellation_control;
    if (!draw->tessellation_evaluation.empty()) result["tessellation_evaluation"] = draw->tessellation_evaluation;
    if (!draw->depth.empty()) result["depth"] = draw->depth;
  } else {
    result = {{"host", true}};
  }
  if (const graph::Condition& when = condition(work); !when.name.empty()) result["when"] = {{when.name, when.value}};
  for (const graph::PortUse& use : uses_of(work)) {
    json entry = {{"port", use.port}, {"access", graph::name(use.access)}};
    if (use.usage) entry["usage"] = graph::name(*use.usage);
    result["uses"].push_back(entry);
  }
  return result;
}

// A table whose columns are as wide as their longest entry; the last one is not filled up.
void print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const std::vector<std::string>& row : rows)
    for (std::size_t c = 0; c + 1 < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  for (const std::vector<std::string>& row : rows) {
    std::string line = " ";
    for (std::size_t c = 0; c < row.size(); ++c) line += fmt::format(" {:{}} ", row[c], widths[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
  }
}

std::string with(const std::string& doc, const std::string& note) { return note.empty() ? doc : fmt::format("{} ({})", doc, note); }

}  // namespace

std::string describe(const graph::Work& work) {
  std::string text = "C++ on the host";
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work))
    text =
        fmt::format("{} {}, in groups of {}", dispatch->kernel,
                    dispatch->indirect.empty() ? "over " + dispatch->over : "in as many groups as " + dispatch->indirect + " says",
                    dispatch->group);
  if (const auto* draw = std::get_if<graph::Draw>(&work))
    text = fmt::format("draws {} ({} and {}), {} vertices for each of {}", draw->name, draw->vertex, draw->fragment, draw->vertices,
                       draw->instances);
  std::string note = when_text(condition(work));
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work); dispatch && !dispatch->needs.empty())
    note += fmt::format("{}only if there are {}", note.empty() ? "" : ", ", dispatch->needs);
  return with(text, note);
}

std::string describe_range(const graph::ParameterSpec& spec) {
  if (!spec.choices.empty()) return fmt::format("{}", fmt::join(spec.choices, " or "));
  if (spec.kind == graph::ParameterKind::boolean) return "true or false";
  if (std::isfinite(spec.min) && std::isfinite(spec.max)) return fmt::format("{} to {}", spec.min, spec.max);
  if (std::isfinite(spec.min)) return fmt::format("from {}", spec.min);
  if (std::isfinite(spec.max)) return fmt::format("up to {}", spec.max);
  return "any";
}

json spec_json(const graph::StageSpec& spec, const graph::Environment& known) {
  json result = {{"name", spec.name},
                 {"doc", spec.doc},
                 {"equation", spec.equation},
                 {"ports", json::array()},
                 {"parameters", json::array()},
                 {"constants", json::array()},
                 {"faults", json::array()},
                 {"work", json::array()},
                 {"sets_time_step", spec.sets_time_step},
                 {"resizes", spec.resizes.empty() ? json() : json(spec.resizes)}};
  for (const graph::Port& port : spec.ports) result["ports"].push_back(port_json(port));
  for (const graph::ParameterSpec& parameter : spec.parameters) result["parameters"].push_back(parameter_json(parameter));
  for (const std::string& name : spec.constants) {
    json entry = {{"name", name}};
    if (const graph::Constant* constant = known.constant(name))
      entry.update({{"type", graph::name(constant->type)}, {"unit", constant->unit}, {"doc", constant->doc}});
    result["constants"].push_back(entry);
  }
  for (const graph::Fault fault : spec.faults) result["faults"].push_back(graph::describe(fault));
  for (const graph::Work& work : spec.work) result["work"].push_back(work_json(work));
  return result;
}

void print_spec(const graph::StageSpec& spec, const graph::Environment& known) {
  fmt::print("{}\n  {}\n", spec.name, spec.doc);
  if (!spec.equation.empty()) {
    const bool tagged = spec.equation.find("[M ") != std::string::npos || spec.equation.find("[H ") != std::string::npos;
    fmt::print("  Equation: {}{}\n", spec.equation, tagged ? " (docs/references.md says of which works)" : "");
  }
  if (!spec.ports.empty()) {
    std::vector<std::vector<std::string>> rows{{"port", "type", "domain", "access", "usage", "unit", "what it is"}};
    for (const graph::Port& port : spec.ports) {
      std::string note = port.optional ? "optional" : "";
      if (const std::string when = when_text(port.when); !when.empty()) note += (note.empty() ? "" : ", ") + when;
      rows.push_back({port.name, std::string(graph::name(port.type)), port.domain, std::string(graph::name(port.access)),
                      std::string(graph::name(port.usage)), port.unit, with(port.doc, note)});
    }
    fmt::print("\nPorts\n");
    print_table(rows);
  }
  if (!spec.parameters.empty()) {
    std::vector<std::vector<std::string>> rows{{"parameter", "kind", "default", "range", "unit", "what it is"}};
    for (const graph::ParameterSpec& parameter : spec.parameters)
      rows.push_back({parameter.name, std::string(kind_name(parameter.kind)), graph::to_string(parameter.initial),
                      describe_range(parameter), parameter.unit, parameter.doc});
    fmt::print("\nParameters\n");
    print_table(rows);
  }
  if (!spec.constants.empty()) {
    std::vector<std::vector<std::string>> rows{{"constant", "type", "unit", "what it is"}};
    for (const std::string& name : spec.constants)
      if (const graph::Constant* constant = known.constant(name))
        rows.push_back({name, std::string(graph::name(constant->type)), constant->unit, constant->doc});
      else
        rows.push_back({name, "", "", ""});
    fmt::print("\nConstants of the scene\n");
    print_table(rows);
  }
  fmt::print("\nWork\n");
  for (const graph::Work& work : spec.work) {
    fmt::print("  {}\n", describe(work));
    std::vector<std::string> uses;
    for (const graph::PortUse& use : uses_of(work)) uses.push_back(fmt::format("{} {}", use.port, graph::name(use.access)));
    if (!uses.empty()) fmt::print("      {}\n", fmt::join(uses, ", "));
  }
  if (!spec.faults.empty()) {
    std::vector<std::string_view> faults;
    for (const graph::Fault fault : spec.faults) faults.push_back(graph::describe(fault));
    fmt::print("\nEnds the run at: {}\n", fmt::join(faults, ", "));
  }
  if (spec.sets_time_step) fmt::print("\nSets the length of the step\n");
  if (!spec.resizes.empty()) fmt::print("\nMakes {} come and go\n", spec.resizes);
}

}  // namespace firn::app
