#pragma once

#include <string>

namespace firn::app {

std::string version();       // "0.1.0"
std::string version_line();  // "firn 0.1.0"

// What this program was built from.
struct Revision {
  std::string commit;   // 40 hexadecimal digits; empty: not known
  std::string changes;  // to tracked files since: "none", "some" or "unknown"
};
Revision revision();

}  // namespace firn::app
