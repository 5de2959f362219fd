#include "stages/listed.h"

namespace firn::stages {

graph::DomainText groups_of_all(std::string_view port) {
  if (port == "active_groups") return "grid_blocks";
  if (port == "block_groups") return "grid_blocks/64";
  if (port == "active_tile_groups" || port == "flatten_groups") return "tiles";
  return {};
}

Places places(std::string_view domain) {
  if (domain == "cells" || domain == "tiles") return {"tiles", "tiles"};
  if (domain == "grid_blocks") return {"grid_blocks", "grid_blocks"};
  if (domain == "block_table") return {"grid_blocks", "block_table"};  // an entry for every block
  if (domain == "nodes" || domain == "grid_rows") return {"nodes", "nodes"};
  return {};
}

bool is_order(std::string_view port) { return port == "order"; }

}  // namespace firn::stages
