// Machine code is made while programs are compiled, not at the first dispatch or draw: told from what Mesa keeps of it on disk.

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "graph/compile.h"
#include "graph/execution/execution.h"
#include "tests/catch.h"

using namespace firn;
using namespace firn::graph;
namespace fs = std::filesystem;

namespace {

using Names = std::set<std::string>;

Names files_in(const fs::path& folder) {
  Names names;
  if (fs::exists(folder))
    for (const auto& file : fs::recursive_directory_iterator(folder))
      if (file.is_regular_file()) names.insert(file.path().filename().string());
  return names;
}

// Mesa writes on a thread of its own.
Names files_at_rest(const fs::path& folder) {
  Names names = files_in(folder);
  for (int still = 0; still < 20; ++still) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (const Names now = files_in(folder); now != names) {
      names = now;
      still = -1;
    }
  }
  return names;
}

// One kernel, triangles upon a depth, and patches without one.
Registry stages_of_each_kind() {
  const std::string folder = std::string(FIRN_SOURCE_DIR) + "/tests/graph/execution/shaders/";
  const auto port = [](const char* name, ElementType type, const char* domain, Usage usage) {
    return Port{
        .name = name, .type = type, .domain = domain, .access = Access::write, .usage = usage, .unit = "1", .doc = "of the test"};
  };
  const auto target = [&](const char* name, ElementType type) { return port(name, type, "image", Usage::framebuffer); };
  const auto used = [](std::vector<const char*> names) {
    std::vector<PortUse> uses;
    for (const char* name : names) uses.push_back({name, Access::write});
    return uses;
  };
  StageSpec spec;
  spec.name = "test.each";
  spec.doc = "of the test";
  spec.ports = {port("left", ElementType::float1, "1", Usage::storage), target("picture", ElementType::rgba8),
                target("picture_depth", ElementType::depth), target("lines", ElementType::float1)};
  spec.work = {Dispatch{.kernel = folder + "start.comp", .over = "4", .uses = used({"left"})},
               Draw{.name = "triangles",
                    .vertex = "render/whole_picture.vert",
                    .fragment = folder + "flat.frag",
                    .colors = {"picture"},
                    .depth = "picture_depth",
                    .clear = true,
                    .uses = used({"picture", "picture_depth"})},
               Draw{.name = "patches",
                    .vertex = folder + "corners.vert",
                    .fragment = folder + "flat.frag",
                    .tessellation_control = folder + "corners.tesc",
                    .tessellation_evaluation = folder + "corners.tese",
                    .colors = {"lines"},
                    .vertices = "4",
                    .topology = Topology::patches,
                    .clear = true,
                    .wireframe = true,
                    .uses = used({"lines"})}};
  Registry registry;
  registry.add(std::move(spec));
  return registry;
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

// What Mesa keeps of a process that runs the hidden test case below for `steps` steps.
Names kept_after(int steps, const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  const std::string command = fmt::format("MESA_SHADER_CACHE_DIR='{}' FIRN_STEPS={} '{}' '[.rehearsed]' > '{}.txt' 2>&1",
                                          folder.string(), steps, self, folder.string());
  INFO(command);
  CHECK(std::system(command.c_str()) == 0);
  return files_in(folder);
}

}  // namespace

TEST_CASE("what Mesa keeps is at rest after so many steps", "[.rehearsed]") {
  const fs::path folder = variable("MESA_SHADER_CACHE_DIR");
  const fs::path file = folder.string() + ".yaml";
  std::ofstream(file) << "firn: 1\nstep: [test.each]\n";
  config::Diagnostics diagnostics;
  const PipelineSpec pipeline = load_pipeline(file, {}, diagnostics);
  const Registry registry = stages_of_each_kind();
  Environment environment;
  environment.provided = {"left", "picture", "picture_depth", "lines"};
  environment.domains["image"] = {.count = 256, .width = 16, .height = 16};
  const Plan plan = compile(pipeline, registry, environment, diagnostics, {});
  config::throw_if_errors(diagnostics);
  const auto device = gpu::Device::open();
  execution::Execution execution(*device, plan, registry, {.shader_folders = {std::string(FIRN_SOURCE_DIR) + "/shaders"}});
  execution.setup();
  for (int i = 0; i < std::atoi(variable("FIRN_STEPS").c_str()); ++i) execution.step();
  device->finish();
  CHECK_NOTHROW(files_at_rest(folder));
}

TEST_CASE("the first dispatches and draws find machine code that was made with their programs") {
  if (const auto device = gpu::Device::open(); !device->info().software || device->info().program_binary_formats == 0) {
    WARN("skipped: only Mesa's software renderer with its cache on disk is told beforehand");
    return;
  }
  const fs::path folder = fs::temp_directory_path() / ("firn-rehearsal-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const Names before = kept_after(0, folder / "before"), after = kept_after(2, folder / "after");
  CHECK(before.size() >= 6);  // a vertex and a fragment shader, four of the patches, a kernel; equal ones may be kept once
  CHECK(before == after);
  fs::remove_all(folder);
}
