#pragma once

// What comes with Firn, by the names that find_input() knows.

#include <string>
#include <vector>

namespace firn::app {

std::vector<std::string> shipped_pipelines();  // "mpm_snow", "examples/melt"
std::vector<std::string> shipped_scenes();     // "snowball"

// Tail of an error text: that links go in a circle, or the nearest of the files that `name` could mean - those that come with Firn
// (`shipped`), and YAML files where it points to.
std::string suggest_file(const std::string& name, std::vector<std::string> shipped);

}  // namespace firn::app
