#include "app/version.h"

#include <revision.h>

namespace firn::app {

std::string version() { return FIRN_VERSION; }
std::string version_line() { return std::string("firn ") + FIRN_VERSION; }
Revision revision() { return {FIRN_COMMIT, FIRN_CHANGES}; }

}  // namespace firn::app
