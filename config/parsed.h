#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/node.h"

namespace firn::config {

struct Parsed {
  Node root;
  std::optional<Place> broken_at;  // where the text stops to be YAML, or the bracket that is open there; nothing behind it counts
};

// parse() for those who go on reading a broken text, to tell what else is wrong with it.
Parsed parse_broken(std::string_view text, const std::string& file, Diagnostics& diagnostics);

}  // namespace firn::config
