#include "app/program_cache.h"

#include <cstdlib>
#include <string>

namespace firn::app {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::filesystem::path program_cache_folder() {
  if (const std::string told = variable("FIRN_CACHE"); !told.empty()) return told == "off" ? "" : told;
  // A relative XDG_CACHE_HOME is invalid, says the XDG Base Directory Specification, and to be ignored.
  if (const std::filesystem::path caches = variable("XDG_CACHE_HOME"); caches.is_absolute()) return caches / "firn";
  if (const std::string home = variable("HOME"); !home.empty()) return std::filesystem::path(home) / ".cache" / "firn";
  return "";
}

}  // namespace firn::app
