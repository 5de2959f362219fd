#include "graph/single_use.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "config/nearest.h"
#include "config/reader.h"

namespace firn::graph {
namespace {

using config::Diagnostics;

Value read_value(const config::Node& node, const ParameterSpec& parameter, Diagnostics& diagnostics) {
  config::Range range{.min = parameter.min, .max = parameter.max};
  if (parameter.kind == ParameterKind::integer) {  // GLSL's int
    range.min = std::max(range.min, static_cast<double>(std::numeric_limits<std::int32_t>::min()));
    range.max = std::min(range.max, static_cast<double>(std::numeric_limits<std::int32_t>::max()));
  }
  const auto or_initial = [&](const auto& read) { return read ? Value(*read) : parameter.initial; };
  switch (parameter.kind) {
    case ParameterKind::number:
      return or_initial(config::read_number(node, parameter.name, range, diagnostics));
    case ParameterKind::integer:
      return or_initial(config::read_integer(node, parameter.name, range, diagnostics));
    case ParameterKind::boolean:
      return or_initial(config::read_boolean(node, parameter.name, diagnostics));
    case ParameterKind::choice:
      return or_initial(config::read_choice(node, parameter.name, parameter.choices, diagnostics));
    case ParameterKind::vector3:
      return or_initial(config::read_vector3(node, parameter.name, range, diagnostics));
    case ParameterKind::path:
      return or_initial(config::read_text(node, parameter.name, diagnostics));
  }
  return parameter.initial;
}

bool holds(const Condition& condition, const PlannedStage& stage, const Environment& environment) {
  if (condition.name.empty()) return true;
  if (const auto value = stage.parameters.find(condition.name); value != stage.parameters.end())
    return to_string(value->second) == condition.value;
  const auto choice = environment.choices.find(condition.name);
  return choice != environment.choices.end() && choice->second == condition.value;
}

void add(const std::vector<Item>& items, const PipelineSpec& pipeline, const Registry& registry, const Environment& environment,
         Traffic& traffic) {
  Diagnostics told_later;
  for (const Item& item : items) {
    if (const auto* repeat = std::get_if<RepeatUse>(&item.what)) {
      add(repeat->stages, pipeline, registry, environment, traffic);
      for (const Until& until : repeat->until) traffic.read.insert(until.buffer);
    }
    const auto* use = std::get_if<StageUse>(&item.what);
    const StageSpec* spec = use != nullptr && use->enabled ? spec_of(*use, pipeline, registry) : nullptr;
    if (spec == nullptr) continue;
    PlannedStage planned;
    planned.spec = *spec;
    planned.parameters = parameter_values(*use, *spec, told_later);
    keep_what_holds(planned, environment);
    for (const Port& port : planned.spec.ports) {
      const std::string buffer = bound_name(port, *use).first;
      if (writes(port.access)) traffic.written.insert(buffer);
      if (reads(port.access) && (!port.optional || port.access == Access::read)) traffic.read.insert(buffer);
    }
  }
}

}  // namespace

const StageSpec* spec_of(const StageUse& use, const PipelineSpec& pipeline, const Registry& registry) {
  if (const auto file = pipeline.stage_files.find(use.stage); file != pipeline.stage_files.end()) return &file->second;
  const StageType* type = registry.find(use.stage);
  return type == nullptr ? nullptr : &type->spec;
}

ParameterValues parameter_values(const StageUse& use, const StageSpec& spec, Diagnostics& diagnostics) {
  ParameterValues values;
  for (const ParameterSpec& parameter : spec.parameters) values[parameter.name] = parameter.initial;
  for (const config::Entry& given : use.parameters) {
    const auto parameter = std::ranges::find(spec.parameters, given.key, &ParameterSpec::name);
    if (parameter == spec.parameters.end()) {
      std::vector<std::string> known{"bind", "every", "enable", "as", "when"};
      for (const ParameterSpec& p : spec.parameters) known.insert(known.end() - 5, p.name);
      diagnostics.error(given.place,
                        fmt::format("{} has no parameter '{}'{}", spec.name, given.key, config::suggestion(given.key, known)));
      continue;
    }
    values[given.key] = read_value(given.value, *parameter, diagnostics);
  }
  return values;
}

void keep_what_holds(PlannedStage& stage, const Environment& environment) {
  std::erase_if(stage.spec.ports, [&](const Port& port) { return !holds(port.when, stage, environment); });
  std::erase_if(stage.spec.work, [&](const Work& work) {
    return !holds(std::visit([](const auto& w) { return w.when; }, work), stage, environment);
  });
  for (Work& work : stage.spec.work)
    if (auto* dispatch = std::get_if<Dispatch>(&work))
      std::erase_if(dispatch->arithmetic, [&](const Arithmetic& one) { return !holds(one.when, stage, environment); });
}

std::pair<std::string, std::optional<Place>> bound_name(const Port& port, const StageUse& use) {
  for (const Binding& binding : use.bindings)
    if (binding.port == port.name) return {binding.buffer, binding.place};
  return {port.name, {}};
}

Traffic survey(const PipelineSpec& pipeline, const Registry& registry, const Environment& environment) {
  Traffic traffic;
  for (const std::vector<Item>* items : {&pipeline.setup, &pipeline.step, &pipeline.frame})
    add(*items, pipeline, registry, environment, traffic);
  return traffic;
}

}  // namespace firn::graph
