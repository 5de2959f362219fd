#pragma once

#include <string>
#include <vector>

namespace firn::app {

// The words this process was started with.
std::vector<std::string> command_line();

}  // namespace firn::app
