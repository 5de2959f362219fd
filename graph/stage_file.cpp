#include "graph/stage_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "config/parsed.h"
#include "config/reader.h"
#include "graph/environment.h"
#include "graph/format_version.h"
#include "graph/spec_problems.h"

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

// A port, a parameter, a constant, or the head itself.
struct Part {
  Place place;
  std::map<std::string, Place> keys;  // of their values
  std::set<std::string> wrong;        // keys that an error speaks of
};

class HeadReader {
 public:
  // `whole`: the head was read to its end, so that what is not there is missing.
  HeadReader(const std::filesystem::path& file, bool whole, Diagnostics& diagnostics)
      : file_(file), whole_(whole), diagnostics_(diagnostics) {}

  StageSpec read(const Node& root) {
    Reader reader(root, "the head of a stage", diagnostics_);
    if (whole_ || reader.has("firn")) read_version(reader, "a stage's head");
    Part& head = part("", root.place, root);
    StageSpec spec;
    spec.name = text(reader, head, "name");
    spec.doc = text(reader, head, "doc");
    spec.equation = reader.text("equation", "");
    if (const Node* ports = require(reader, head, "ports"))
      each(*ports, "ports", [&](const Entry& e) { spec.ports.push_back(port(e)); });
    if (const Node* parameters = reader.find("parameters"))
      each(*parameters, "parameters", [&](const Entry& e) { spec.parameters.push_back(parameter(e)); });
    for (const Node& name : list(reader.find("constants"), "constants"))
      if (const auto constant = config::read_text(name, "a constant", diagnostics_)) {
        spec.constants.push_back(*constant);
        part("constant " + *constant, name.place, name);
      }
    for (const Node& name : list(reader.find("faults"), "faults"))
      if (const auto fault = config::read_choice(name, "a fault", names_of(faults), diagnostics_))
        spec.faults.push_back(*named(faults, *fault));
    Dispatch dispatch;
    dispatch.kernel = std::filesystem::absolute(file_).lexically_normal().string();
    dispatch.over = text(reader, head, "over");
    dispatch.group = static_cast<int>(reader.integer("group", dispatch.group, {.min = 1, .max = 1024}));
    spec.work = {dispatch};
    reader.finish();
    return spec;
  }

  // What is wrong with the spec and does not follow from what has been told of it.
  void tell(const std::vector<Problem>& problems) const {
    for (const Problem& problem : problems) {
      const Part& of = parts_.at(problem.part);
      if (std::ranges::any_of(problem.keys, [&](const std::string& key) { return of.wrong.contains(key); })) continue;
      const auto given = std::ranges::find_if(problem.keys, [&](const std::string& key) { return of.keys.contains(key); });
      diagnostics_.error(given == problem.keys.end() ? of.place : of.keys.at(*given), problem.text);
    }
  }

 private:
  Part& part(const std::string& name, const Place& place, const Node& node) {
    Part& part = parts_[name];
    part.place = place;
    for (const Entry& e : node.entries) part.keys[e.key] = e.value.place;
    return part;
  }

  template <typename Read>
  auto noting(Part& part, const char* key, const Read& read) {
    const std::size_t before = diagnostics_.all().size();
    auto value = read();
    if (diagnostics_.all().size() > before) part.wrong.insert(key);
    return value;
  }

  const Node* require(Reader& reader, Part& part, const char* key) {
    const Node* value = whole_ ? reader.require(key) : reader.find(key);
    if (value == nullptr) part.wrong.insert(key);
    return value;
  }

  std::string text(Reader& reader, Part& part, const char* key) {
    if (require(reader, part, key) == nullptr) return "";
    return noting(part, key, [&] { return reader.text(key, ""); });
  }

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

  Port port(const Entry& e) {
    Part& part = this->part("port " + e.key, e.place, e.value);
    Reader reader(e.value, "port " + e.key, diagnostics_);
    const auto choice = [&](const char* key, const std::vector<std::string>& choices, const char* fallback) {
      return noting(part, key, [&] { return reader.choice(key, choices, fallback); });
    };
    const auto required = [&](const char* key, const std::vector<std::string>& choices, const char* fallback) {
      return require(reader, part, key) == nullptr ? fallback : choice(key, choices, fallback);
    };
    Port port;
    port.name = e.key;
    port.type = element_type(required("type", element_type_names(), "float")).value_or(ElementType::float1);
    port.domain = text(reader, part, "domain");
    port.access = access(required("access", accesses, "read")).value_or(Access::read);
    port.usage = usage(choice("usage", usages, "storage")).value_or(Usage::storage);
    port.unit = text(reader, part, "unit");
    port.doc = text(reader, part, "doc");
    port.optional = reader.boolean("optional", false);
    reader.finish();
    return port;
  }

  ParameterSpec parameter(const Entry& e) {
    Part& part = this->part("parameter " + e.key, e.place, e.value);
    Reader reader(e.value, "parameter " + e.key, diagnostics_);
    ParameterSpec parameter;
    parameter.name = e.key;
    const std::string kind = noting(part, "kind", [&] { return reader.choice("kind", names_of(kinds), "number"); });
    parameter.kind = named(kinds, kind).value_or(ParameterKind::number);
    const std::size_t before = diagnostics_.all().size();
    parameter.min = reader.number("min", parameter.min);
    parameter.max = reader.number("max", parameter.max);
    if (parameter.min > parameter.max)
      diagnostics_.error(part.keys.at("min"),
                         fmt::format("min must be at most max, which is {:g}, not {:g}", parameter.max, parameter.min));
    const Node* choices = parameter.kind == ParameterKind::choice ? require(reader, part, "choices") : reader.find("choices");
    for (const Node& choice : list(choices, "choices"))
      if (const auto text = config::read_text(choice, "a choice", diagnostics_)) parameter.choices.push_back(*text);
    // A default is held to what is known to be allowed.
    const bool bounds_known = diagnostics_.all().size() == before;
    if (!bounds_known) {
      parameter.min = ParameterSpec().min;
      parameter.max = ParameterSpec().max;
    }
    parameter.unit = reader.text("unit", parameter.unit);
    parameter.doc = text(reader, part, "doc");
    const Node* initial = require(reader, part, "default");
    if (part.wrong.contains("kind") || (parameter.kind == ParameterKind::choice && !bounds_known))
      part.wrong.insert("default");
    else if (initial != nullptr)
      parameter.initial = noting(part, "default", [&] { return value(*initial, parameter); });
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
  const bool whole_;
  Diagnostics& diagnostics_;
  std::map<std::string, Part> parts_;  // "port velocity", "parameter rate", "constant gravity"; "": the head
};

// Everything that is wrong with a head; the text before it as head_of() leaves it.
std::optional<StageSpec> read_head(const std::string& head, const std::filesystem::path& file, Diagnostics& diagnostics) {
  const config::Parsed parsed = config::parse_broken(head, file.string(), diagnostics);
  if (parsed.root.kind == Node::Kind::null && diagnostics.has_errors()) return std::nullopt;
  Diagnostics of_values;
  HeadReader reader(file, !parsed.broken_at, of_values);
  StageSpec spec = reader.read(parsed.root);
  if (!parsed.broken_at) reader.tell(find_problems(spec));
  // The line where a text is broken is read as something else than was meant.
  for (const config::Diagnostic& one : of_values.all())
    if (!parsed.broken_at || one.place.line < parsed.broken_at->line) diagnostics.error(one.place, one.text);
  return diagnostics.has_errors() ? std::nullopt : std::optional(std::move(spec));
}

// Calls `visit` with every text of a head that names a domain or a constant.
template <typename Visit>
void each_name(const Node& root, const Visit& visit) {
  if (const Node* ports = root.find("ports"))
    for (const Entry& port : ports->entries)
      if (const Node* domain = port.value.find("domain")) visit(*domain);
  if (const Node* over = root.find("over")) visit(*over);
  if (const Node* constants = root.find("constants"))
    for (const Node& constant : constants->items) visit(constant);
}

std::optional<std::string> text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  return stream ? std::optional(std::move(text)) : std::nullopt;
}

}  // namespace

bool is_stage_file(const std::string& name) { return name.ends_with(".comp"); }

std::optional<StageSpec> read_stage_file(const std::filesystem::path& file, Diagnostics& diagnostics) {
  constexpr std::uintmax_t largest = 1 << 20;
  std::error_code error;
  if (const std::uintmax_t size = std::filesystem::file_size(file, error); !error && size > largest) {
    diagnostics.error({file.string(), 0, 0}, "a shader of more than 1 MiB is none");
    return std::nullopt;
  }
  const std::optional<std::string> text = text_of(file), head = text ? head_of(*text) : std::nullopt;
  if (!head) {
    diagnostics.error({file.string(), 0, 0}, !text ? "cannot be read"
                                                   : "a stage's file begins with a comment that is its spec, in YAML: /*, then "
                                                     "'firn: 1', name, doc, ports, over, then */");
    return std::nullopt;
  }
  Diagnostics of_head;
  std::optional<StageSpec> spec = read_head(*head, file, of_head);
  diagnostics.append(of_head);
  return spec;
}

std::vector<Place> places_in_head(const StageSpec& spec, const std::string& name) {
  const std::string& file = std::get<Dispatch>(spec.work.front()).kernel;
  const std::optional<std::string> text = text_of(file), head = text ? head_of(*text) : std::nullopt;
  std::vector<Place> places;
  if (!head) return places;
  Diagnostics told_before;
  each_name(config::parse(*head, file, told_before), [&](const Node& node) {
    if (node.scalar == name || base_domain(node.scalar) == name) places.push_back(node.place);
  });
  return places;
}

}  // namespace firn::graph
