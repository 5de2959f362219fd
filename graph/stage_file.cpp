#include "graph/stage_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "config/reader.h"

namespace firn::graph {
namespace {

using config::Diagnostics;
using config::Entry;
using config::Node;
using config::Place;
using config::Reader;

// A kernel reaches its ports in these ways.
const std::vector<std::string> usages{"storage", "uniform", "sampled", "image"};
const std::vector<std::string> accesses{"read", "write", "read_write", "accumulate"};

template <typename T>
using Named = std::vector<std::pair<const char*, T>>;
const Named<ParameterKind> kinds{{"number", ParameterKind::number},
                                 {"integer", ParameterKind::integer},
                                 {"boolean", ParameterKind::boolean},
                                 {"choice", ParameterKind::choice},
                                 {"vector3", ParameterKind::vector3}};
const Named<Fault> faults{
    {"not_a_number", Fault::not_a_number}, {"overflow", Fault::overflow}, {"left_domain", Fault::left_domain}};

template <typename T>
std::vector<std::string> names_of(const Named<T>& table) {
  std::vector<std::string> names;
  for (const auto& [name, value] : table) names.emplace_back(name);
  return names;
}

template <typename T>
std::optional<T> named(const Named<T>& table, const std::string& name) {
  for (const auto& [known, value] : table)
    if (name == known) return value;
  return std::nullopt;
}

// The first comment's text; all else is blanked out, so that its lines have the numbers that they have in the file.
std::optional<std::string> head_of(const std::string& text) {
  const std::size_t open = text.find("/*");
  const std::size_t close = open == std::string::npos ? open : text.find("*/", open + 2);
  if (close == std::string::npos) return std::nullopt;
  std::string head = text.substr(0, close);
  for (std::size_t i = 0; i < open + 2; ++i)
    if (head[i] != '\n') head[i] = ' ';
  return head;
}

class HeadReader {
 public:
  HeadReader(const std::filesystem::path& file, Diagnostics& diagnostics) : file_(file), diagnostics_(diagnostics) {}

  StageSpec read(const Node& root) {
    Reader reader(root, "the head of a stage", diagnostics_);
    if (reader.integer("firn", 0, {.min = 1, .max = 1}) == 0 && root.kind == Node::Kind::map && !reader.has("firn"))
      diagnostics_.error(root.place, "missing key 'firn': a stage's head begins with 'firn: 1', the version of its format");
    StageSpec spec;
    spec.name = reader.required_text("name");
    spec.doc = reader.required_text("doc");
    spec.equation = reader.text("equation", "");
    places_[""] = root.place;
    if (const Node* ports = reader.require("ports")) each(*ports, "ports", [&](const Entry& e) { spec.ports.push_back(port(e)); });
    if (const Node* parameters = reader.find("parameters"))
      each(*parameters, "parameters", [&](const Entry& e) { spec.parameters.push_back(parameter(e)); });
    for (const Node& name : list(reader.find("constants"), "constants"))
      if (const auto text = config::read_text(name, "a constant", diagnostics_)) spec.constants.push_back(*text);
    for (const Node& name : list(reader.find("faults"), "faults"))
      if (const auto text = config::read_choice(name, "a fault", names_of(faults), diagnostics_))
        spec.faults.push_back(*named(faults, *text));
    Dispatch dispatch;
    dispatch.kernel = std::filesystem::absolute(file_).lexically_normal().string();
    dispatch.over = reader.required_text("over");
    dispatch.group = static_cast<int>(reader.integer("group", dispatch.group, {.min = 1, .max = 1024}));
    spec.work = {dispatch};
    reader.finish();
    return spec;
  }

  // Of the port or parameter that one of problems() speaks of.
  [[nodiscard]] Place place_of(const std::string& problem) const {
    const auto known = places_.find(problem.substr(0, problem.find(':')));
    return known == places_.end() ? places_.at("") : known->second;
  }

 private:
  template <typename Visit>
  void each(const Node& map, const char* what, const Visit& visit) {
    if (map.kind != Node::Kind::map)
      diagnostics_.error(map.place,
                         fmt::format("{} must be a map of names such as {{name: {{...}}}}, not {}", what, describe(map)));
    for (const Entry& e : map.entries) visit(e);
  }

  std::vector<Node> list(const Node* node, const char* what) {
    if (node == nullptr || node->kind == Node::Kind::sequence) return node == nullptr ? std::vector<Node>{} : node->items;
    diagnostics_.error(node->place, fmt::format("{} must be a list of names, not {}", what, describe(*node)));
    return {};
  }

  // Where required texts are missing, what stands for them brings no further error.
  Port port(const Entry& e) {
    places_["port " + e.key] = e.place;
    Reader reader(e.value, "port " + e.key, diagnostics_);
    const auto choice = [&](const char* key, const std::vector<std::string>& choices, const char* fallback) {
      return reader.require(key) == nullptr ? fallback : reader.choice(key, choices, fallback);
    };
    Port port;
    port.name = e.key;
    port.type = element_type(choice("type", element_type_names(), "float")).value_or(ElementType::float1);
    port.domain = reader.required_text("domain");
    port.access = access(choice("access", accesses, "read")).value_or(Access::read);
    port.usage = usage(reader.choice("usage", usages, "storage")).value_or(Usage::storage);
    port.unit = reader.required_text("unit");
    port.doc = reader.required_text("doc");
    port.optional = reader.boolean("optional", false);
    reader.finish();
    return port;
  }

  ParameterSpec parameter(const Entry& e) {
    places_["parameter " + e.key] = e.place;
    Reader reader(e.value, "parameter " + e.key, diagnostics_);
    ParameterSpec parameter;
    parameter.name = e.key;
    parameter.kind = named(kinds, reader.choice("kind", names_of(kinds), "number")).value_or(ParameterKind::number);
    parameter.min = reader.number("min", parameter.min);
    parameter.max = reader.number("max", parameter.max);
    for (const Node& choice : list(reader.find("choices"), "choices"))
      if (const auto text = config::read_text(choice, "a choice", diagnostics_)) parameter.choices.push_back(*text);
    parameter.unit = reader.text("unit", parameter.unit);
    parameter.doc = reader.required_text("doc");
    if (const Node* initial = reader.require("default")) parameter.initial = value(*initial, parameter);
    reader.finish();
    return parameter;
  }

  Value value(const Node& node, const ParameterSpec& parameter) {
    const config::Range range{.min = parameter.min, .max = parameter.max};
    const auto or_nothing = [](const auto& read) { return read ? Value(*read) : Value(std::string()); };
    switch (parameter.kind) {
      case ParameterKind::number:
        return or_nothing(config::read_number(node, "default", range, diagnostics_));
      case ParameterKind::integer:
        return or_nothing(config::read_integer(node, "default", range, diagnostics_));
      case ParameterKind::boolean:
        return or_nothing(config::read_boolean(node, "default", diagnostics_));
      case ParameterKind::vector3:
        return or_nothing(config::read_vector3(node, "default", range, diagnostics_));
      default:
        return or_nothing(config::read_choice(node, "default", parameter.choices, diagnostics_));
    }
  }

  const std::filesystem::path& file_;
  Diagnostics& diagnostics_;
  std::map<std::string, Place> places_;  // "port velocity", "parameter rate"; "": of the head
};

}  // namespace

bool is_stage_file(const std::string& name) { return name.ends_with(".comp"); }

std::optional<StageSpec> read_stage_file(const std::filesystem::path& file, Diagnostics& diagnostics) {
  constexpr std::uintmax_t largest = 1 << 20;
  std::error_code error;
  if (const std::uintmax_t size = std::filesystem::file_size(file, error); !error && size > largest) {
    diagnostics.error({file.string(), 0, 0}, "a shader of more than 1 MiB is none");
    return std::nullopt;
  }
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::optional<std::string> head = head_of(text);
  if (!stream || !head) {
    diagnostics.error({file.string(), 0, 0}, !stream ? "cannot be read"
                                                     : "a stage's file begins with a comment that is its spec, in YAML: /*, then "
                                                       "'firn: 1', name, doc, ports, over, then */");
    return std::nullopt;
  }
  Diagnostics of_head;
  const Node root = config::parse(*head, file.string(), of_head);
  StageSpec spec;
  if (!of_head.has_errors()) {
    HeadReader reader(file, of_head);
    spec = reader.read(root);
    // What is wrong with single values has been told; the spec as a whole is looked at once they are right.
    if (!of_head.has_errors())
      for (const std::string& problem : problems(spec)) of_head.error(reader.place_of(problem), problem);
  }
  diagnostics.append(of_head);
  return of_head.has_errors() ? std::nullopt : std::optional(std::move(spec));
}

}  // namespace firn::graph
