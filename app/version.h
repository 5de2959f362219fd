#pragma once

#include <string>

namespace firn::app {

std::string version();       // "0.1.0"
std::string version_line();  // "firn 0.1.0"

}  // namespace firn::app
