#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/verbs.h"
#include "stages/register.h"

namespace firn::app {

void add_list(CLI::App& program, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* verb = program.add_subcommand("list", "All stages, a line each");
  verb->add_flag("--json", *json, "As JSON");
  verb->callback([&action, json] {
    action = [json] {
      const graph::Registry registry = stages::all_stages(nullptr);
      std::size_t width = 0;
      nlohmann::json list = nlohmann::json::array();
      for (const auto& [name, type] : registry.all()) width = std::max(width, name.size());
      for (const auto& [name, type] : registry.all()) {
        if (*json)
          list.push_back({{"name", name}, {"doc", type.spec.doc}, {"equation", type.spec.equation}});
        else
          fmt::print("{:{}}  {}{}\n", name, width, type.spec.doc, type.spec.equation.empty() ? "" : "  " + type.spec.equation);
      }
      if (*json) fmt::print("{}\n", list.dump(2));
      return static_cast<int>(Status::done);
    };
  });
}

}  // namespace firn::app
