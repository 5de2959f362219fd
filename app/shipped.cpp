#include "app/shipped.h"

#include <algorithm>
#include <filesystem>

#include "app/load.h"
#include "config/links.h"
#include "config/nearest.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

// YAML files below `folder` of every data folder, without their ending; not those below `except`.
std::vector<std::string> names_below(const std::string& folder, const std::string& except) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::path& data : data_folders())
    for (auto at = fs::recursive_directory_iterator(data / folder, error); !error && at != fs::recursive_directory_iterator();
         ++at) {
      const std::string name = at->path().lexically_relative(data / folder).replace_extension().string();
      if (at->path().extension() == ".yaml" && (except.empty() || !name.starts_with(except))) names.push_back(name);
    }
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

std::vector<std::string> shipped_pipelines() { return names_below("pipelines", "scenes/"); }
std::vector<std::string> shipped_scenes() { return names_below("pipelines/scenes", ""); }

std::string suggest_file(const std::string& name, std::vector<std::string> shipped) {
  if (const std::string circle = config::circle_hint(name); !circle.empty()) return circle;
  const fs::path folder = fs::path(name).parent_path();
  std::vector<std::string> beside;
  std::error_code error;
  for (auto at = fs::directory_iterator(folder.empty() ? "." : folder, error); !error && at != fs::directory_iterator(); ++at)
    if (at->path().extension() == ".yaml") beside.push_back((folder / at->path().filename()).string());
  std::ranges::sort(beside);
  const bool with_ending = fs::path(name).extension() == ".yaml";
  for (std::string& one : shipped)
    if (with_ending) one += ".yaml";
  shipped.insert(shipped.end(), beside.begin(), beside.end());
  if (folder.empty()) return config::suggestion(name, shipped);
  const auto near = config::nearest(name, shipped);
  return near ? "; did you mean '" + *near + "'?" : "";
}

}  // namespace firn::app
