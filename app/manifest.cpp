#include "app/manifest.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "app/version.h"

namespace firn::app {
namespace {

nlohmann::json stages_json(const graph::Plan& plan) {
  nlohmann::json list = nlohmann::json::array();
  for (const graph::PlannedStage& stage : plan.stages) {
    nlohmann::json parameters = nlohmann::json::object();
    for (const auto& [name, value] : stage.parameters) std::visit([&, key = name](const auto& v) { parameters[key] = v; }, value);
    nlohmann::json buffers = nlohmann::json::object();
    for (std::size_t p = 0; p < stage.buffers.size(); ++p)
      if (stage.buffers[p] >= 0) buffers[stage.spec.ports[p].name] = plan.buffers[static_cast<std::size_t>(stage.buffers[p])].name;
    list.push_back({{"stage", stage.label}, {"parameters", parameters}, {"buffers", buffers}, {"every", stage.every}});
  }
  return list;
}

}  // namespace

nlohmann::json manifest(const Loaded& loaded, const gpu::DeviceInfo& device, const RunFacts& facts) {
  nlohmann::json sizes = nlohmann::json::object();
  for (const auto& [name, size] : loaded.plan.environment.domains) sizes[name] = size.count;
  return {{"firn", version()},
          {"command", facts.command},
          {"started", facts.started},
          {"pipeline", {{"file", loaded.pipeline_file}, {"name", loaded.pipeline.name}, {"stages", stages_json(loaded.plan)}}},
          {"scene",
           {{"file", loaded.scene_file},
            {"name", loaded.problem->scene.name},
            {"seed", loaded.problem->scene.seed},
            {"resolved", config::to_yaml(loaded.scene_node)}}},
          {"sizes", sizes},
          {"device", {{"name", device.name}, {"vendor", device.vendor}, {"version", device.version}}},
          {"result",
           {{"exit_status", facts.exit_status},
            {"message", facts.message},
            {"steps", facts.steps},
            {"frames", facts.frames},
            {"simulated_seconds", facts.time},
            {"seconds", facts.seconds}}}};
}

void write_manifest(const std::string& file, const nlohmann::json& manifest) {
  const std::string beside = file + ".part";
  {
    std::ofstream out(beside);
    // File names need not be UTF-8, JSON must be.
    out << manifest.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    out.flush();
    if (!out) throw std::runtime_error(fmt::format("cannot write {}", file));
  }
  std::filesystem::rename(beside, file);
}

}  // namespace firn::app
