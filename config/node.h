#pragma once

// YAML that remembers its place. A Node is a plain value: copied, edited and compared freely.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/diagnostics.h"

namespace firn::config {

struct Entry;

struct Node {
  enum class Kind { null, scalar, sequence, map };

  Kind kind = Kind::null;
  Place place;
  std::string scalar;          // Kind::scalar: the text, quotes removed
  bool quoted = false;         // a quoted scalar is text, never a number, a boolean or null
  std::vector<Node> items;     // Kind::sequence
  std::vector<Entry> entries;  // Kind::map, in the order of the file, keys unique

  // The value of `key`; nullptr where this is no map or has no such key.
  [[nodiscard]] const Node* find(std::string_view key) const;
  [[nodiscard]] Node* find(std::string_view key);
};

struct Entry {
  std::string key;
  Place place;  // of the key
  Node value;
};

// "a list", "a map", "'text'", "nothing": for error texts.
std::string describe(const Node& node);

// One YAML document in UTF-8. A tag other than those of the core schema (!!str 5 is a text) and a merge key (<<) are errors; an
// alias copies what its anchor names, with the places there. Errors (syntax, duplicate keys, more than one document, aliases that
// grow without bound, nesting deeper than 100) go to `diagnostics`; the result is then whatever could be read.
Node parse(std::string_view text, const std::string& file, Diagnostics& diagnostics);

// The same from a file. A missing file, a directory, an empty file and one over 64 MiB are errors. `file` names in places are
// as given by the caller (relative stays relative).
Node load(const std::filesystem::path& path, Diagnostics& diagnostics);

// Block-style YAML text that parses back to an equal tree.
std::string to_yaml(const Node& node);

// One word of the command line, `--set path=value`, with a place of its own so that errors point at it ("--set k=4").
struct Override {
  std::vector<std::string> path;  // dots split it, save that callers may join leading parts again (stage names have dots)
  Node value;
  Place place;
};
Override parse_override(std::string_view text, Diagnostics& diagnostics);

// Puts `value` at `path` below `root`: map keys by name, list items by number. A missing last map key is added (whether it is
// valid is for the reader of the map to say, with the override's place); any other missing step is an error with the nearest name.
// List items count from 0. The value takes over `place`.
void apply_override(Node& root, const std::vector<std::string>& path, const Node& value, const Place& place,
                    Diagnostics& diagnostics);

// Replaces ${name} in scalars by the values of `parameters` (a map node). A scalar that is nothing but "${name}" takes over the
// whole value with its kind, but keeps its place; inside other text the parameter must be a scalar. "$${" stands for the characters
// "${". Unknown names are errors with the nearest one, and so are parameters that contain "${" themselves. Keys stay as they are.
void substitute(Node& node, const Node& parameters, Diagnostics& diagnostics);

}  // namespace firn::config
