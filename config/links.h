#pragma once

#include <filesystem>
#include <string>

namespace firn::config {

// To follow "there is no such file": "; its symbolic links go in a circle", or nothing where that is not why.
std::string circle_hint(const std::filesystem::path& path);

}  // namespace firn::config
