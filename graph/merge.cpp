#include "graph/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "config/links.h"
#include "config/nearest.h"
#include "config/reader.h"

namespace firn::graph {
namespace {

using config::Diagnostics;
using config::Entry;
using config::Node;
using config::Place;

Entry& entry(Node& map, const std::string& key, const Place& place) {
  for (Entry& e : map.entries)
    if (e.key == key) return e;
  map.kind = Node::Kind::map;
  map.entries.push_back({key, place, {}});
  return map.entries.back();
}

// Calls `visit` for every group in a list of stages, and for those in groups and repeats below it where it says so.
void each_group(Node& list, const std::function<bool(Node& item, const std::string& group)>& visit) {
  for (Node& item : list.items) {
    const Node* group = item.find("group");
    const bool goes_on = group == nullptr || visit(item, group->scalar);
    if (Node* inner = item.find("stages"); inner != nullptr && goes_on) each_group(*inner, visit);
  }
}

// A few lines can replace many groups by long lists, which hold groups to be replaced.
constexpr std::size_t most_nodes = 200'000;
constexpr std::size_t most_replacements = 200;

std::size_t count_nodes(const Node& node) {
  std::size_t count = 1;
  for (const Node& item : node.items) count += count_nodes(item);
  for (const Entry& e : node.entries) count += 1 + count_nodes(e.value);
  return count;
}

std::string canonical_name(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path found = std::filesystem::weakly_canonical(file, error);
  return (error ? file : found).string();
}

// `chain`: the files that include this one, directly or through others.
Node load_in_chain(const std::filesystem::path& file, std::vector<std::string> chain, Diagnostics& diagnostics) {
  Node own = config::load(file, diagnostics);
  if (Node* scene = own.find("scene"); scene && scene->kind == Node::Kind::scalar)
    scene->scalar = beside(scene->place, scene->scalar);
  const Node* include = own.find("include");
  Node merged = own;
  if (include != nullptr) {
    std::erase_if(merged.entries, [](const Entry& e) { return e.key == "include"; });
    const auto path = config::read_text(*include, "include", diagnostics);
    chain.push_back(canonical_name(file));
    const std::string other = path ? beside(include->place, *path) : "";
    std::error_code error;  // of names that are too long, circles of links and the like: there is no such file
    if (path && !std::filesystem::is_regular_file(other, error)) {
      diagnostics.error(include->place, fmt::format("no such file: '{}'{}", other, config::circle_hint(other)));
    } else if (path && std::ranges::find(chain, canonical_name(other)) != chain.end()) {
      diagnostics.error(include->place, fmt::format("'{}' includes itself, directly or through others", *path));
    } else if (path) {
      Node base = load_in_chain(other, chain, diagnostics);
      for (Entry& e : merged.entries) {
        Node& target = entry(base, e.key, e.place).value;
        if (e.key == "parameters" && target.kind == Node::Kind::map && e.value.kind == Node::Kind::map) {
          for (Entry& parameter : e.value.entries) entry(target, parameter.key, parameter.place).value = parameter.value;
        } else {
          target = e.value;
        }
      }
      base.place = own.place;
      merged = std::move(base);
    }
  }
  if (const Node* replace = merged.find("replace")) {
    if (replace->kind != Node::Kind::map)
      diagnostics.error(replace->place,
                        fmt::format("replace must be a map of groups to lists of stages, not {}", describe(*replace)));
    const std::vector<Entry> groups = replace->entries;
    if (groups.size() > most_replacements)
      diagnostics.error(replace->place, fmt::format("more than {} groups are replaced", most_replacements));
    else
      for (const Entry& group : groups) replace_group(merged, group.key, group.value, group.place, diagnostics);
    std::erase_if(merged.entries, [](const Entry& e) { return e.key == "replace"; });
  }
  return merged;
}

}  // namespace

std::string beside(const Place& place, const std::string& path) {
  if (place.line == 0) return path;
  return (std::filesystem::path(place.file).parent_path() / path).lexically_normal().string();
}

void replace_group(Node& root, const std::string& group, const Node& stages, const Place& place, Diagnostics& diagnostics) {
  std::vector<std::string> known;
  bool found = false;
  const std::size_t more = count_nodes(stages);
  std::size_t nodes = count_nodes(root);
  for (const char* phase : phase_names)
    if (Node* list = root.find(phase))
      each_group(*list, [&](Node& item, const std::string& name) {
        known.push_back(name);
        if (name != group) return true;
        found = true;
        if (nodes <= most_nodes && nodes + more > most_nodes)
          diagnostics.error(place, fmt::format("replacing '{}' makes more than {} values and keys", group, most_nodes));
        nodes += more;
        if (nodes <= most_nodes) entry(item, "stages", place).value = stages;
        return false;  // a list may hold a group of the name that it replaces
      });
  if (!found)
    diagnostics.error(place, known.empty() ? fmt::format("no group '{}' to replace: the pipeline has no groups", group)
                                           : fmt::format("no group '{}' to replace{}", group, config::suggestion(group, known)));
}

Node load_merged(const std::filesystem::path& file, Diagnostics& diagnostics) { return load_in_chain(file, {}, diagnostics); }

}  // namespace firn::graph
