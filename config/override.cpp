#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <optional>
#include <utility>

#include "config/nearest.h"
#include "config/node.h"
#include "config/places.h"
#include "config/text.h"

namespace firn::config {
namespace {

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find('.', begin);
    parts.emplace_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

Node parse_value(std::string_view text, const Place& place, Diagnostics& diagnostics) {
  Diagnostics found;
  Node value = parse(text, "", found);
  for (const Diagnostic& diagnostic : found.all()) {
    diagnostics.error(place, fmt::format("the value {} is no YAML: {}", quote(text), diagnostic.text));
  }
  put_at(value, place);
  return value;
}

std::vector<std::string> keys(const Node& map) {
  std::vector<std::string> names;
  for (const Entry& entry : map.entries) names.push_back(entry.key);
  return names;
}

// "the file" or "'a.b'": what the first `count` steps lead to.
std::string name_of(const std::vector<std::string>& path, std::size_t count) {
  if (count == 0) return "the file";
  return quote(fmt::format("{}", fmt::join(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(count), ".")));
}

Node* list_item(Node& list, const std::vector<std::string>& path, std::size_t step, const Place& place, Diagnostics& diagnostics) {
  const std::string& text = path[step];
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error == std::errc() && end == text.data() + text.size() && index < list.items.size()) return &list.items[index];
  const std::string range =
      list.items.empty() ? "it is empty" : fmt::format("a number from 0 to {} is needed", list.items.size() - 1);
  diagnostics.error(place, fmt::format("{} is a list and has no item {}; {}", name_of(path, step), quote(text), range));
  return nullptr;
}

Node* map_value(Node& map, const std::vector<std::string>& path, std::size_t step, const Place& place, Diagnostics& diagnostics) {
  const std::string& key = path[step];
  if (Node* value = map.find(key)) return value;
  if (step + 1 == path.size()) {
    map.kind = Node::Kind::map;
    return &map.entries.emplace_back(Entry{key, place, {}}).value;
  }
  diagnostics.error(place, fmt::format("{} has no key {}{}", name_of(path, step), quote(key), suggestion(key, keys(map))));
  return nullptr;
}

}  // namespace

void put_at(Node& node, const Place& place) {
  node.place = place;
  for (Node& item : node.items) put_at(item, place);
  for (Entry& entry : node.entries) {
    entry.place = place;
    put_at(entry.value, place);
  }
}

Override parse_override(std::string_view text, Diagnostics& diagnostics) {
  Override result;
  result.place = {fmt::format("--set {}", text), 0, 0};
  result.value.place = result.place;
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    diagnostics.error(result.place, "'=' is missing; the form is path=value, as in scene.gravity=[0,-9.81,0]");
    return result;
  }
  result.path = split(text.substr(0, equals));
  for (const std::string& part : result.path) {
    if (!part.empty()) continue;
    diagnostics.error(result.place, "a name before, between or after the dots of the path is missing; the form is path=value");
    break;
  }
  const std::string_view value = text.substr(equals + 1);
  if (value.find_first_not_of(" \t") == std::string_view::npos) {
    diagnostics.error(result.place,
                      "the value after '=' is missing; the form is path=value (null for nothing, '' for an empty text)");
    return result;
  }
  result.value = parse_value(value, result.place, diagnostics);
  return result;
}

void apply_override(Node& root, const std::vector<std::string>& path, const Node& value, const Place& place,
                    Diagnostics& diagnostics) {
  if (path.empty()) {
    diagnostics.error(place, "the path is empty; the form is path=value");
    return;
  }
  Node* node = &root;
  for (std::size_t step = 0; step < path.size(); ++step) {
    if (node->kind == Node::Kind::scalar) {
      diagnostics.error(place, fmt::format("{} is {} and has nothing below it, so no {}", name_of(path, step), describe(*node),
                                           quote(path[step])));
      return;
    }
    node = node->kind == Node::Kind::sequence ? list_item(*node, path, step, place, diagnostics)
                                              : map_value(*node, path, step, place, diagnostics);
    if (node == nullptr) return;
  }
  *node = Node(value);
  put_at(*node, place);
}

}  // namespace firn::config
