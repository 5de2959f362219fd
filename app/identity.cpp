#include "app/identity.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "app/sha256.h"
#include "graph/execution/kernels.h"

namespace firn::app {
namespace {

using nlohmann::json;

json stages_json(const graph::Plan& plan) {
  json list = json::array();
  for (const graph::PlannedStage& stage : plan.stages) {
    json parameters = json::object(), buffers = json::object();
    for (const auto& [name, value] : stage.parameters) std::visit([&, key = name](const auto& v) { parameters[key] = v; }, value);
    for (std::size_t p = 0; p < stage.buffers.size(); ++p)
      if (stage.buffers[p] >= 0) buffers[stage.spec.ports[p].name] = plan.buffers[static_cast<std::size_t>(stage.buffers[p])].name;
    list.push_back({{"stage", stage.label}, {"parameters", parameters}, {"buffers", buffers}, {"every", stage.every}});
  }
  return list;
}

// Labels in the order of execution, a stage's own work taken together; what a repeat repeats is a list below it.
json order_json(const graph::Plan& plan, const std::vector<graph::Op>& ops) {
  json list = json::array();
  for (const graph::Op& op : ops) {
    if (const auto* run = std::get_if<graph::Run>(&op.what)) {
      const std::string& label = plan.stages[static_cast<std::size_t>(run->stage)].label;
      if (list.empty() || list.back() != label) list.push_back(label);
    } else if (const auto* repeat = std::get_if<graph::Repeat>(&op.what)) {
      json each{{"max", repeat->max}, {"stages", order_json(plan, repeat->body)}};
      if (repeat->until)
        each["until"] = {{"buffer", plan.buffers[static_cast<std::size_t>(repeat->until->buffer)].name},
                         {"below", repeat->until->below}};
      list.push_back({{"repeat", each}});
    }
  }
  return list;
}

// Files of shaders that a piece of work is made of, with their kinds.
std::vector<std::pair<std::string, gpu::ShaderKind>> shaders_of(const graph::Work& work) {
  if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) return {{dispatch->kernel, gpu::ShaderKind::compute}};
  const auto* draw = std::get_if<graph::Draw>(&work);
  if (draw == nullptr) return {};
  std::vector<std::pair<std::string, gpu::ShaderKind>> files{
      {draw->vertex, gpu::ShaderKind::vertex},
      {draw->fragment, gpu::ShaderKind::fragment},
      {draw->tessellation_control, gpu::ShaderKind::tessellation_control},
      {draw->tessellation_evaluation, gpu::ShaderKind::tessellation_evaluation}};
  std::erase_if(files, [](const auto& file) { return file.first.empty(); });
  return files;
}

// With the traits of a device that offers nothing beyond the least, so that the hashes are the same on all.
json shaders_json(const graph::Plan& plan) {
  json hashes = json::object();
  const std::vector<std::filesystem::path> folders = shader_folders();
  for (int s = 0; s < static_cast<int>(plan.stages.size()); ++s) {
    const graph::PlannedStage& stage = plan.stages[static_cast<std::size_t>(s)];
    for (int w = 0; w < static_cast<int>(stage.spec.work.size()); ++w)
      for (const auto& [file, kind] : shaders_of(stage.spec.work[static_cast<std::size_t>(w)]))
        hashes[fmt::format("{}: {}", stage.label, file)] =
            sha256(execution::kernel_source(plan, s, w, file, kind, {}, folders).text);
  }
  return hashes;
}

std::set<std::string> files_of(const scene::Scene& scene) {
  std::set<std::string> files;
  for (const scene::Snow& snow : scene.snow) {
    if (const auto* mesh = std::get_if<scene::SolidMesh>(&snow.what)) files.insert(mesh->mesh.file);
    if (const auto* points = std::get_if<scene::PointFile>(&snow.what)) files.insert(points->file);
  }
  for (const scene::Body& body : scene.bodies)
    if (const auto* mesh = std::get_if<scene::Mesh>(&body.shape)) files.insert(mesh->file);
  if (scene.field)
    for (const scene::FieldSource* source : {&scene.field->ground, &scene.field->depth, &scene.field->density})
      if (!source->image.empty()) files.insert(source->image);
  return files;
}

using Leaves = std::map<std::string, std::string>;

void add_leaves(const config::Node& node, const std::string& path, Leaves& leaves) {
  for (const config::Entry& entry : node.entries) add_leaves(entry.value, fmt::format("{}.{}", path, entry.key), leaves);
  for (std::size_t i = 0; i < node.items.size(); ++i) add_leaves(node.items[i], fmt::format("{}.{}", path, i), leaves);
  if (node.kind == config::Node::Kind::scalar) leaves[path] = node.scalar;
}

void add_leaves(const json& value, const std::string& path, Leaves& leaves) {
  const std::string prefix = path.empty() ? "" : path + ".";
  if (value.is_object())
    for (const auto& [key, each] : value.items()) add_leaves(each, prefix + key, leaves);
  else if (value.is_array() && !std::ranges::all_of(value, [](const json& each) { return each.is_primitive(); }))
    for (std::size_t i = 0; i < value.size(); ++i) add_leaves(value[i], prefix + std::to_string(i), leaves);
  else
    leaves[path] = value.dump(-1, ' ', false, json::error_handler_t::replace);
}

Leaves scene_leaves(const json& identity) {
  Leaves leaves;
  const json& text = identity.value("scene", json());
  if (!text.is_string()) return leaves;
  config::Diagnostics ignored;
  add_leaves(config::parse(text.get<std::string>(), "", ignored), "scene", leaves);
  for (const char* key : {"scene.time.end", "scene.name", "scene.doc"}) leaves.erase(key);
  return leaves;
}

Leaves leaves_of(const json& identity, const std::string& part) {
  Leaves leaves;
  add_leaves(identity.value(part, json::object()), "", leaves);
  return leaves;
}

void compare(const Leaves& before, const Leaves& now, const std::string& what, bool hashes, std::vector<std::string>& list) {
  for (const auto& [key, value] : before) {
    const auto found = now.find(key);
    if (found == now.end())
      list.push_back(fmt::format("{}{} is no longer there", what, key));
    else if (found->second != value)
      list.push_back(hashes ? fmt::format("{}{} has changed", what, key)
                            : fmt::format("{}{} is {}, was {}", what, key, found->second, value));
  }
  for (const auto& [key, value] : now)
    if (!before.contains(key)) list.push_back(fmt::format("{}{} is new", what, key));
}

// json::value() throws where a value is not of the default's kind, or what is asked is no object.
json object_in(const json& value, const char* key) {
  const auto found = value.find(key);
  return value.is_object() && found != value.end() && found->is_object() ? *found : json::object();
}
std::string label_of(const json& stage) {
  const json label = stage.value("stage", json());
  return label.is_string() ? label.get<std::string>() : "";
}

std::map<std::string, json> stages_of(const json& pipeline) {
  std::map<std::string, json> stages;
  for (const json& stage : pipeline.value("stages", json::array()))
    if (stage.is_object()) stages[label_of(stage)] = stage;
  return stages;
}

Leaves stage_leaves(const json& stage) {
  Leaves leaves;
  const std::string label = label_of(stage);
  add_leaves(object_in(stage, "parameters"), label, leaves);
  add_leaves(object_in(stage, "buffers"), label + ".bind", leaves);
  leaves[label + ".every"] = stage.value("every", json(1)).dump(-1, ' ', false, json::error_handler_t::replace);
  return leaves;
}

void compare_pipelines(const json& before, const json& now, std::vector<std::string>& list) {
  const std::map<std::string, json> stages_before = stages_of(before), stages_now = stages_of(now);
  const std::size_t told = list.size();
  for (const auto& [label, stage] : stages_before)
    if (const auto found = stages_now.find(label); found != stages_now.end())
      compare(stage_leaves(stage), stage_leaves(found->second), "", false, list);
    else
      list.push_back(fmt::format("the stage {} is no longer there", label));
  for (const auto& [label, stage] : stages_now)
    if (!stages_before.contains(label)) list.push_back(fmt::format("the stage {} is new", label));
  if (list.size() > told) return;
  for (const char* phase : {"setup", "step", "frame"})
    if (before.value(phase, json()) != now.value(phase, json()))
      list.push_back(fmt::format("the order or repetition of stages in '{}' has changed", phase));
}

}  // namespace

json identity_of(const Loaded& loaded) {
  const graph::Plan& plan = loaded.plan;
  json sizes = json::object(), files = json::object();
  for (const auto& [name, size] : plan.environment.domains) sizes[name] = size.count;
  // By their places beside the scene, wherever that is seen from.
  const auto absolute = [](const std::string& file) { return std::filesystem::absolute(file).lexically_normal(); };
  for (const std::string& file : files_of(loaded.problem->scene))
    files[absolute(file).lexically_relative(absolute(loaded.scene_file).parent_path()).string()] = sha256_of(file);
  return {{"pipeline",
           {{"name", loaded.pipeline.name},
            {"stages", stages_json(plan)},
            {"setup", order_json(plan, plan.setup)},
            {"step", order_json(plan, plan.step)},
            {"frame", order_json(plan, plan.frame)}}},
          {"scene", config::to_yaml(loaded.scene_node)},
          {"files", files},
          {"sizes", sizes},
          {"shaders", shaders_json(plan)}};
}

std::vector<std::string> differences(const json& before, const json& now) {
  std::vector<std::string> list;
  compare(scene_leaves(before), scene_leaves(now), "", false, list);
  compare(leaves_of(before, "files"), leaves_of(now, "files"), "the file ", true, list);
  compare_pipelines(object_in(before, "pipeline"), object_in(now, "pipeline"), list);
  compare(leaves_of(before, "sizes"), leaves_of(now, "sizes"), "the number of ", false, list);
  // A shader's source holds sizes and constants of the scene, too: told only where nothing else has changed.
  if (list.empty()) compare(leaves_of(before, "shaders"), leaves_of(now, "shaders"), "the shader of ", true, list);
  return list;
}

}  // namespace firn::app
