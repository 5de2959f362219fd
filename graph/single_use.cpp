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

bool is_automatic(const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr && *text == automatic;
}

// What the environment has chosen for a parameter that may be `auto`; nothing where it has no choice, or none that is offered.
const std::string* chosen_for(const ParameterSpec& parameter, const Environment& environment) {
  const auto offers = [&](const std::string& value) {
    return std::ranges::find(parameter.choices, value) != parameter.choices.end();
  };
  if (parameter.kind != ParameterKind::choice || !offers(automatic)) return nullptr;
  const auto choice = environment.choices.find(parameter.name);
  return choice != environment.choices.end() && offers(choice->second) ? &choice->second : nullptr;
}

void add(const std::vector<Item>& items, const PipelineSpec& pipeline, const Registry& registry, const Environment& environment,
         std::vector<AutomaticChoice>& list) {
  Diagnostics told_elsewhere;
  for (const Item& item : items) {
    if (const auto* repeat = std::get_if<RepeatUse>(&item.what)) add(repeat->stages, pipeline, registry, environment, list);
    const auto* use = std::get_if<StageUse>(&item.what);
    const StageSpec* spec = use != nullptr && use->enabled ? spec_of(*use, pipeline, registry) : nullptr;
    if (spec == nullptr) continue;
    const ParameterValues values = parameter_values(*use, *spec, told_elsewhere);
    for (const ParameterSpec& parameter : spec->parameters)
      if (const std::string* chosen = chosen_for(parameter, environment)) {
        const bool left_open = is_automatic(values.at(parameter.name));
        list.push_back({use->label, parameter.name, left_open ? *chosen : to_string(values.at(parameter.name)), left_open});
      }
  }
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
  for (const ParameterSpec& parameter : stage.spec.parameters)
    if (Value& value = stage.parameters.at(parameter.name); is_automatic(value))
      if (const std::string* chosen = chosen_for(parameter, environment)) value = *chosen;
  std::erase_if(stage.spec.ports, [&](const Port& port) { return !holds(port.when, stage, environment); });
  std::erase_if(stage.spec.work, [&](const Work& work) {
    return !holds(std::visit([](const auto& w) { return w.when; }, work), stage, environment);
  });
  for (Work& work : stage.spec.work)
    if (auto* dispatch = std::get_if<Dispatch>(&work))
      std::erase_if(dispatch->arithmetic, [&](const Arithmetic& one) { return !holds(one.when, stage, environment); });
}

std::vector<std::string> undecided(const PlannedStage& stage, const StageSpec& spec) {
  std::vector<std::string> names;
  for (const ParameterSpec& parameter : spec.parameters) {
    if (parameter.kind != ParameterKind::choice || !is_automatic(stage.parameters.at(parameter.name))) continue;
    const auto decides = [&](const Condition& condition) { return condition.name == parameter.name; };
    if (std::ranges::any_of(spec.ports, decides, &Port::when) || std::ranges::any_of(spec.work, [&](const Work& work) {
          return decides(std::visit([](const auto& w) { return w.when; }, work));
        }))
      names.push_back(parameter.name);
  }
  return names;
}

std::vector<AutomaticChoice> automatic_choices(const PipelineSpec& pipeline, const Registry& registry,
                                               const Environment& environment) {
  std::vector<AutomaticChoice> list;
  for (const std::vector<Item>* items : {&pipeline.setup, &pipeline.step, &pipeline.frame})
    add(*items, pipeline, registry, environment, list);
  return list;
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
