#include "app/scene_kinds.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/load.h"
#include "app/shipped.h"

namespace firn::app {

void name_scenes_that_would_do(graph::Environment& environment) {
  std::vector<std::string> with_field, with_particles;
  for (const std::string& name : shipped_scenes()) {
    config::Diagnostics not_told;
    const config::Node scene = config::load(find_input(name, "pipelines/scenes"), not_told);
    const auto has = [&](const char* key) { return scene.find(key) != nullptr; };
    if (has("field")) with_field.push_back(name);
    if (has("domain") && (has("snow") || has("emitters"))) with_particles.push_back(name);
  }
  const std::map<std::string, std::string> missing = environment.missing;
  const auto add = [&](const char* domain, const std::vector<std::string>& scenes) {
    for (const auto& [name, reason] : missing)
      if (reason == missing.at(domain) && !scenes.empty())
        environment.missing[name] += fmt::format("; of the scenes that come with Firn {} {}", fmt::join(scenes, ", "),
                                                 scenes.size() == 1 ? "has it" : "have it");
  };
  add("cells", with_field);
  add("particles", with_particles);
}

}  // namespace firn::app
