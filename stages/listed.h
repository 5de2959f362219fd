#pragma once

// Which part of the field or grid kernels work on where not on all of it, for those who count bytes.

#include <string>
#include <string_view>

#include "graph/spec.h"

namespace firn::stages {

// How many groups an indirect dispatch by this port would have if every element were listed: "tiles", "grid_blocks/64"; empty:
// not known.
graph::DomainText groups_of_all(std::string_view port);

// Elements that are places, not things: few or many of them are touched, wherever bodies and particles are.
struct Places {
  std::string list;         // domain whose elements are listed: "tiles" for cells; "nodes": they are not
  graph::DomainText whole;  // as many elements listed would be all of the domain
};
// Of a domain without scaling. `list` is empty where its elements are things.
Places places(std::string_view domain);

// Whether its elements are numbers of others that are read in this order.
bool is_order(std::string_view port);

}  // namespace firn::stages
