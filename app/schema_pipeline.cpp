#include <fmt/format.h>

#include <cmath>

#include "app/schema.h"

namespace firn::app {
namespace {

using nlohmann::json;

json reference(const std::string& definition) { return {{"$ref", "#/definitions/" + definition}}; }

// A value, or a text that takes the pipeline's parameters up: "${k}".
json or_parameter(const json& schema) { return {{"anyOf", json::array({schema, reference("from_parameter")})}}; }

json value_of(const graph::Value& value) {
  return std::visit([](const auto& v) { return json(v); }, value);
}

json with_range(json schema, const graph::ParameterSpec& parameter) {
  if (std::isfinite(parameter.min)) schema["minimum"] = parameter.min;
  if (std::isfinite(parameter.max)) schema["maximum"] = parameter.max;
  return schema;
}

json type_of(const graph::ParameterSpec& parameter) {
  switch (parameter.kind) {
    case graph::ParameterKind::number:
      return with_range({{"type", "number"}}, parameter);
    case graph::ParameterKind::integer:
      return with_range({{"type", "integer"}}, parameter);
    case graph::ParameterKind::boolean:
      return {{"type", "boolean"}};
    case graph::ParameterKind::choice:
      return {{"enum", parameter.choices}};
    case graph::ParameterKind::vector3:
      return {{"type", "array"}, {"minItems", 3}, {"maxItems", 3}, {"items", with_range({{"type", "number"}}, parameter)}};
    case graph::ParameterKind::path:
      return {{"type", "string"}};
  }
  return json::object();
}

json parameter_schema(const graph::ParameterSpec& parameter) {
  json schema = or_parameter(type_of(parameter));
  schema["description"] = parameter.unit == "1" ? parameter.doc : fmt::format("{} ({})", parameter.doc, parameter.unit);
  schema["default"] = value_of(parameter.initial);
  return schema;
}

// What every use of a stage may have besides its parameters (graph/stage_uses.h).
json common_options() {
  return {{"every", or_parameter({{"type", "integer"}, {"minimum", 1}, {"maximum", 1e9}})},
          {"enable", or_parameter({{"type", "boolean"}})},
          {"as", {{"type", "string"}, {"description", "a name of its own for this use of the stage"}}},
          {"when", reference("when")}};
}

json options_of(const graph::StageSpec& spec) {
  json properties = common_options(), ports = json::object();
  for (const graph::Port& port : spec.ports)
    ports[port.name] = {{"type", "string"}, {"description", fmt::format("buffer for: {} ({})", port.doc, port.unit)}};
  properties["bind"] = {{"type", "object"}, {"properties", ports}, {"additionalProperties", false}};
  for (const graph::ParameterSpec& parameter : spec.parameters) properties[parameter.name] = parameter_schema(parameter);
  return {{"type", {"object", "null"}},
          {"description", spec.equation.empty() ? spec.doc : fmt::format("{} {}", spec.doc, spec.equation)},
          {"properties", properties},
          {"additionalProperties", false}};
}

// Of a stage that is a file; its head knows the parameters.
json options_of_file() {
  json properties = common_options();
  properties["bind"] = reference("any_bindings");
  return {{"type", {"object", "null"}}, {"properties", properties}};
}

json definitions(const graph::Registry& registry) {
  json stages = json::object(), names = json::array();
  for (const auto& [name, type] : registry.all()) {
    stages[name] = options_of(type.spec);
    names.push_back(name);
  }
  const json by_name = {{"anyOf", json::array({json{{"enum", names}}, json{{"type", "string"}, {"pattern", "\\.comp$"}}})}};
  json by_key = options_of_file();
  by_key["type"] = "object";
  by_key["required"] = {"stage"};
  by_key["properties"]["stage"] = by_name;
  const json turns = or_parameter({{"type", "integer"}, {"minimum", 1}, {"maximum", 1e6}});
  const json until = {{"type", "object"},
                      {"required", {"buffer", "below"}},
                      {"properties", {{"buffer", {{"type", "string"}}}, {"below", or_parameter({{"type", "number"}})}}},
                      {"additionalProperties", false}};
  const json limited = {{"type", "object"},
                        {"required", {"max"}},
                        {"properties", {{"max", turns}, {"until", until}}},
                        {"additionalProperties", false}};
  json result;
  result["from_parameter"] = {{"type", "string"}, {"pattern", "\\$\\{"}};
  const json plain = {{"type", {"string", "number", "boolean"}}};
  result["when"] = {{"type", "object"},
                    {"minProperties", 1},
                    {"description", "takes part only where the pipeline's parameters have these values"},
                    {"additionalProperties", {{"anyOf", json::array({plain, json{{"type", "array"}, {"items", plain}}})}}}};
  result["any_bindings"] = {{"type", "object"}, {"additionalProperties", {{"type", "string"}}}};
  result["stage_with_options"] = {{"type", "object"},
                                  {"minProperties", 1},
                                  {"maxProperties", 1},
                                  {"properties", stages},
                                  {"patternProperties", {{"\\.comp$", options_of_file()}}},
                                  {"additionalProperties", false}};
  result["stage_by_key"] = by_key;
  result["repeat"] = {
      {"type", "object"},
      {"required", {"repeat", "stages"}},
      {"properties",
       {{"repeat", {{"anyOf", json::array({turns, limited})}}}, {"stages", reference("stages")}, {"when", reference("when")}}},
      {"additionalProperties", false}};
  result["group"] = {
      {"type", "object"},
      {"required", {"group", "stages"}},
      {"properties", {{"group", {{"type", "string"}}}, {"stages", reference("stages")}, {"when", reference("when")}}},
      {"additionalProperties", false}};
  result["stages"] = {{"type", {"array", "null"}},
                      {"items",
                       {{"anyOf", json::array({by_name, reference("stage_with_options"), reference("stage_by_key"),
                                               reference("repeat"), reference("group")})}}}};
  return result;
}

}  // namespace

json pipeline_schema(const graph::Registry& registry) {
  const auto list = [](const char* doc) { return json{{"allOf", json::array({reference("stages")})}, {"description", doc}}; };
  const auto text = [](const char* doc) { return json{{"type", "string"}, {"description", doc}}; };
  const auto needs = [](const char* key) { return json{{"required", {key}}}; };
  return {
      {"$schema", "http://json-schema.org/draft-07/schema#"},
      {"title", "Firn pipeline"},
      {"type", "object"},
      {"properties",
       {{"firn", {{"const", 1}, {"description", "version of the format"}}},
        {"name", text("the pipeline's name (default: the file's)")},
        {"doc", text("what it does, in a line")},
        {"scene", text("scene file it runs on unless --scene names another; relative to this file")},
        {"include", text("another pipeline whose keys hold where this file gives none; relative to this file")},
        {"parameters", {{"type", {"object", "null"}}, {"description", "values for ${name} below; --set name=value changes them"}}},
        {"setup", list("stages that run once")},
        {"step", list("stages of every step of the simulation")},
        {"frame", list("stages of every picture")},
        {"replace",
         {{"type", "object"}, {"additionalProperties", reference("stages")}, {"description", "other stages for groups"}}}}},
      {"additionalProperties", false},
      {"anyOf", json::array({needs("firn"), needs("include")})},
      {"definitions", definitions(registry)}};
}

}  // namespace firn::app
