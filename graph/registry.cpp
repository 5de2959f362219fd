#include "graph/registry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

namespace firn::graph {

void Registry::add(StageSpec spec, HostFactory host) {
  std::vector<std::string> wrong = problems(spec);
  for (const Work& work : spec.work)
    if (std::holds_alternative<HostWork>(work) && !host) wrong.emplace_back("has host work, but no host stage");
  if (stages_.contains(spec.name)) wrong.emplace_back("is registered twice");
  if (!wrong.empty()) throw std::logic_error(fmt::format("stage {}: {}", spec.name, fmt::join(wrong, "; ")));
  std::string name = spec.name;
  stages_.emplace(std::move(name), StageType{std::move(spec), std::move(host)});
}

const StageType* Registry::find(const std::string& name) const {
  const auto found = stages_.find(name);
  return found == stages_.end() ? nullptr : &found->second;
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> list;
  for (const auto& [name, type] : stages_) list.push_back(name);
  return list;
}

}  // namespace firn::graph
