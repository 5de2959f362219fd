#include "app/version.h"

namespace firn::app {

std::string version() { return FIRN_VERSION; }
std::string version_line() { return std::string("firn ") + FIRN_VERSION; }

}  // namespace firn::app
