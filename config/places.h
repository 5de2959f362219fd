#pragma once

#include "config/node.h"

namespace firn::config {

// Gives a tree and all below it one place: that of the text which brought it there.
void put_at(Node& node, const Place& place);

}  // namespace firn::config
