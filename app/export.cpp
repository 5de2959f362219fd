#include "app/export.h"

#include <fmt/format.h>

#include "config/nearest.h"

namespace firn::app {
namespace {

const std::vector<std::string> kinds = {"particles", "grid", "surface", "heightfield", "bodies"};

config::Node scalar(const std::string& text, const config::Place& place) {
  config::Node node;
  node.kind = config::Node::Kind::scalar;
  node.scalar = text;
  node.place = place;
  return node;
}

config::Node map(const std::string& key, config::Node value, const config::Place& place) {
  config::Node node;
  node.kind = config::Node::Kind::map;
  node.place = place;
  node.entries.push_back({key, place, std::move(value)});
  return node;
}

}  // namespace

void add_export(CLI::App& verb, Inputs& inputs) {
  verb.add_option("--export", inputs.exports,
                  "KIND or KIND:FORMAT, one file per frame into the folder export/ of the results: particles:vtp, ply, npy; "
                  "grid:vdb, vti; surface:ply, obj; heightfield:vti, png, obj, ply; bodies:vtp, obj, poses")
      ->allow_extra_args(false);
}

config::Node read_exports(const std::vector<std::string>& words, config::Diagnostics& diagnostics) {
  config::Node list;
  list.kind = config::Node::Kind::sequence;
  for (const std::string& word : words) {
    const config::Place place{"--export " + word, 0, 0};
    const std::size_t colon = word.find(':');
    const std::string kind = word.substr(0, colon);
    if (std::ranges::find(kinds, kind) == kinds.end()) {
      diagnostics.error(place, fmt::format("there is no export of '{}'{}", kind, config::suggestion(kind, kinds)));
      continue;
    }
    const std::string stage = "io." + kind;
    list.items.push_back(colon == std::string::npos
                             ? scalar(stage, place)
                             : map(stage, map("format", scalar(word.substr(colon + 1), place), place), place));
  }
  return list;
}

}  // namespace firn::app
