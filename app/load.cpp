#include "app/load.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "app/choice.h"
#include "app/export.h"
#include "app/scene_kinds.h"
#include "app/shipped.h"
#include "config/links.h"
#include "config/nearest.h"
#include "scene/emission.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

// Names that are too long, and circles of links, are no files either.
bool exists(const std::string& name) {
  std::error_code error;
  return fs::exists(name, error);
}

stages::Image read_image_size(const std::string& text, config::Diagnostics& diagnostics) {
  stages::Image image;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &image.width, &image.height, &rest) != 2 || image.width < 16 || image.height < 16 ||
      image.width > 16384 || image.height > 16384) {
    diagnostics.error({"--image " + text, 0, 0}, "expected WIDTHxHEIGHT in pixels, 16 to 16384 each, such as 1280x720");
    return {};
  }
  return image;
}

std::vector<std::pair<std::string, config::Node>> read_replacements(const std::vector<std::string>& words,
                                                                    config::Diagnostics& diagnostics) {
  std::vector<std::pair<std::string, config::Node>> replacements;
  for (const std::string& word : words) {
    const config::Place place{"--replace " + word, 0, 0};
    const std::size_t sign = word.find('=');
    config::Node list;
    list.kind = config::Node::Kind::sequence;
    list.place = place;
    bool complete = sign != std::string::npos && sign > 0;
    for (std::size_t begin = sign; complete && begin != std::string::npos;) {
      const std::size_t end = word.find(',', begin + 1);
      config::Node& stage = list.items.emplace_back();
      stage.kind = config::Node::Kind::scalar;
      stage.place = place;
      stage.scalar = word.substr(begin + 1, end == std::string::npos ? end : end - begin - 1);
      complete = !stage.scalar.empty();
      begin = end;
    }
    if (complete)
      replacements.emplace_back(word.substr(0, sign), std::move(list));
    else
      diagnostics.error(place, "expected GROUP=STAGE,STAGE, such as displace=heightfield.distance_transform,./push.comp");
  }
  return replacements;
}

// Memory is told before it is taken: particles on the host while they are sampled, and their state on the device. What a pipeline's
// grid takes is known once it is planned.
void check_memory(const scene::Scene& scene, double allowed, config::Diagnostics& diagnostics) {
  constexpr double per_particle = 64 + 64 + 400;  // bytes: sampling, scene and upload, the pipelines' buffers
  const double particles = static_cast<double>(std::max(scene::estimate_particles(scene), scene.max_particles));
  const double needed = particles * per_particle;
  const double there =
      allowed > 0 ? allowed : static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (needed <= there) return;
  constexpr double gib = 1 << 30;
  diagnostics.error(
      scene.domain ? scene.domain->place : config::Place{scene.file, 0, 0},
      fmt::format(
          "up to {:.0f} particles would take about {:.1f} GiB; this machine has {:.1f} GiB; make the cell larger or the snow "
          "smaller",
          particles, needed / gib, there / gib));
}

// What a scene has for particles, and no stage of the pipeline makes use of.
void warn_of_idle_parts(const scene::Scene& scene, const graph::Plan& plan, config::Diagnostics& diagnostics) {
  if (plan.buffer("position") < 0) return;
  const auto check = [&](const auto& parts, const char* what, const char* stage) {
    if (!parts.empty() && std::ranges::none_of(plan.stages, [&](const graph::PlannedStage& s) { return s.spec.name == stage; }))
      diagnostics.warning(parts.front().place, fmt::format("{} do nothing in this pipeline: it has no stage {}", what, stage));
  };
  check(scene.emitters, "emitters", "mpm.emit");
  check(scene.sinks, "sinks", "mpm.remove");
}

}  // namespace

scene::Scene nominal_scene() {
  scene::Scene scene;
  scene.domain = scene::Domain{};
  scene.materials.emplace_back();
  scene::Snow snow;
  snow.what = scene::Sphere{scene::Vector3d(0.5, 0.5, 0.5), 0.1};
  scene.snow.push_back(snow);
  scene.field = scene::Field{};
  return scene;
}

std::vector<config::Override> read_overrides(const std::vector<std::string>& words, config::Diagnostics& diagnostics) {
  std::vector<config::Override> changes;
  for (const std::string& text : words) {
    // One that cannot be read is not applied: its value would only bring errors of its own.
    config::Diagnostics of_set;
    config::Override change = config::parse_override(text, of_set);
    if (change.path == std::vector<std::string>{"scene"})
      of_set.error(change.place, "write scene.<key>=<value> for a part of the scene, or --scene FILE for another one");
    if (!of_set.has_errors()) changes.push_back(std::move(change));
    diagnostics.append(of_set);
  }
  return changes;
}

std::shared_ptr<const stages::Problem> load_problem(const std::string& file, const std::vector<config::Override>& changes,
                                                    stages::Image image, const std::string& output, config::Node& node,
                                                    config::Diagnostics& diagnostics, double memory) {
  config::Diagnostics of_scene;
  std::shared_ptr<const stages::Problem> problem;
  node = config::load(file, of_scene);
  if (!of_scene.has_errors()) {
    for (const config::Override& change : changes)
      if (change.path.front() == "scene")
        config::apply_override(node, {change.path.begin() + 1, change.path.end()}, change.value, change.place, of_scene);
    scene::Scene scene = scene::read_scene(node, of_scene);
    if (!of_scene.has_errors()) check_memory(scene, memory, of_scene);
    if (!of_scene.has_errors()) problem = stages::make_problem(std::move(scene), image, output);
    if (problem) scene::check_room(problem->scene, problem->particles.position.size(), of_scene);
    if (of_scene.has_errors()) problem = nullptr;
  }
  diagnostics.append(of_scene);
  return problem;
}

void add_inputs(CLI::App& verb, Inputs& inputs) {
  verb.add_option("PIPELINE", inputs.pipeline, "Pipeline file (YAML), or the name of one that comes with Firn")->required();
  verb.add_option("--scene", inputs.scene, "Scene file instead of the pipeline's own");
  verb.add_option("--set", inputs.set,
                  "K=V: a pipeline parameter (k=4), a stage's (mpm.grid_to_particles.flip=0.9), or part of the scene "
                  "(scene.gravity=[0,-1.62,0]); V is YAML")
      ->allow_extra_args(false);
  verb.add_option("--disable", inputs.disable, "Leave a stage out")->allow_extra_args(false);
  verb.add_flag("!--no-alias", inputs.share_memory, "Give every scratch buffer memory of its own");
  verb.add_option("--repeats", inputs.repeats,
                  "Who finds that a repeat has reached its end: device; host, which reads back after every turn; auto: host on "
                  "software renderers, else device")
      ->check(one_of({"auto", "host", "device"}))
      ->capture_default_str();
  verb.add_option("--replace", inputs.replace, "GROUP=STAGE,STAGE: other stages for a group; those that are files by their paths")
      ->allow_extra_args(false);
  verb.add_option("--image", inputs.image, "Size of pictures, WIDTHxHEIGHT")->capture_default_str();
}

std::vector<fs::path> data_folders() {
  std::vector<fs::path> folders;
  if (const char* data = std::getenv("FIRN_DATA")) folders.emplace_back(data);
  std::error_code error;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error)
    folders.push_back(program.parent_path().parent_path() / "share" / "firn");
  folders.emplace_back(FIRN_SOURCE_DIR);
  std::erase_if(folders, [](const fs::path& folder) { return !fs::is_directory(folder / "shaders"); });
  return folders;
}

std::vector<fs::path> shader_folders() {
  std::vector<fs::path> folders;
  for (const fs::path& folder : data_folders()) folders.push_back(folder / "shaders");
  return folders;
}

std::string find_input(const std::string& name, const std::string& folder) {
  if (exists(name)) return name;
  for (const fs::path& data : data_folders())
    for (const fs::path& candidate : {data / name, data / folder / name, data / folder / (name + ".yaml")})
      if (std::error_code error; fs::is_regular_file(candidate, error)) return candidate.string();
  return name;
}

void print(const config::Diagnostics& diagnostics) {
  for (const config::Diagnostic& diagnostic : diagnostics.all()) fmt::print(stderr, "{}\n", config::to_string(diagnostic));
}

Loaded load(const Inputs& inputs, const std::string& output) {
  Loaded loaded;
  config::Diagnostics& diagnostics = loaded.diagnostics;
  graph::Edits edits;
  edits.set = read_overrides(inputs.set, diagnostics);
  edits.disable = inputs.disable;
  edits.replace = read_replacements(inputs.replace, diagnostics);
  edits.frame = read_exports(inputs.exports, diagnostics);
  const stages::Image image = read_image_size(inputs.image, diagnostics);

  loaded.pipeline_file = find_input(inputs.pipeline, "pipelines");
  if (exists(loaded.pipeline_file))
    loaded.pipeline = graph::load_pipeline(loaded.pipeline_file, edits, diagnostics);
  else
    diagnostics.error({inputs.pipeline, 0, 0}, "there is no such file" + suggest_file(inputs.pipeline, shipped_pipelines()));
  loaded.scene_file = inputs.scene.empty() ? loaded.pipeline.scene : find_input(inputs.scene, "pipelines/scenes");

  std::shared_ptr<const stages::Problem> problem;
  if (!loaded.scene_file.empty()) {
    if (inputs.scene.empty() && !exists(loaded.scene_file)) {
      diagnostics.error(loaded.pipeline.scene_place,
                        fmt::format("no such scene file: '{}'{}", loaded.scene_file, config::circle_hint(loaded.scene_file)));
    } else if (!exists(loaded.scene_file)) {
      diagnostics.error({inputs.scene, 0, 0}, "there is no such file" + suggest_file(inputs.scene, shipped_scenes()));
    } else {
      problem = load_problem(loaded.scene_file, edits.set, image, output, loaded.scene_node, diagnostics, inputs.memory);
    }
  } else if (!loaded.pipeline.file.empty() && !diagnostics.has_errors()) {
    diagnostics.error({loaded.pipeline_file, 0, 0},
                      "no scene: name one in the pipeline ('scene: scenes/snowball.yaml') or by --scene FILE");
  }
  const bool nominal = problem == nullptr;
  if (nominal) problem = stages::make_problem(nominal_scene(), image, "");
  loaded.registry = stages::all_stages(problem);
  graph::Environment environment = stages::environment(*problem);
  environment.provided.insert(inputs.keep.begin(), inputs.keep.end());
  const config::Diagnostics of_files = diagnostics;
  const auto compile = [&] {
    loaded.plan = graph::compile(loaded.pipeline, loaded.registry, environment, diagnostics,
                                 {.share_memory = inputs.share_memory, .decide_on_device = inputs.repeats == "device"});
  };
  compile();
  loaded.problem = problem;
  if (diagnostics.has_errors()) {  // told once more with what may help
    diagnostics = of_files;
    name_scenes_that_would_do(environment);
    compile();
  }
  config::throw_if_errors(diagnostics);
  warn_of_idle_parts(problem->scene, loaded.plan, diagnostics);
  return loaded;
}

std::string plan_for(Loaded& loaded, const Inputs& inputs, const stages::DeviceProfile& device) {
  const stages::Forms forms = stages::forms_for(device, loaded.plan.environment);
  graph::Environment environment = loaded.plan.environment;
  for (const auto& [parameter, form] : forms.choices) environment.choices[parameter] = form;
  const bool by_device = inputs.repeats == "device" || (inputs.repeats == "auto" && !device.software);
  if (environment.choices == loaded.plan.environment.choices && by_device == (inputs.repeats == "device")) return forms.reason;
  config::Diagnostics told_before;
  loaded.plan = graph::compile(loaded.pipeline, loaded.registry, environment, told_before,
                               {.share_memory = inputs.share_memory, .decide_on_device = by_device});
  config::throw_if_errors(told_before);
  return forms.reason;
}

}  // namespace firn::app
