#include "config/links.h"

namespace firn::config {

std::string circle_hint(const std::filesystem::path& path) {
  std::error_code error;
  static_cast<void>(std::filesystem::status(path, error));
  return error == std::errc::too_many_symbolic_link_levels ? "; its symbolic links go in a circle" : "";
}

}  // namespace firn::config
