// Programs of a plan: from the cache on disk or compiled, the results are the same.

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "gpu/calls.h"
#include "graph/compile.h"
#include "graph/execution/execution.h"
#include "tests/catch.h"

using namespace firn;
using namespace firn::graph;

namespace {

gpu::Device& device() {
  static const std::unique_ptr<gpu::Device> one = gpu::Device::open();
  return *one;
}

struct Folder {
  Folder() : path(std::filesystem::temp_directory_path() / ("firn-programs-" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path);
    std::filesystem::create_directory(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

struct Result {
  float runs = 0;              // after three steps
  std::uint64_t compiled = 0;  // shaders
};

Result run(const Folder& folder, const std::filesystem::path& cache) {
  Registry registry;
  const std::string shaders = std::string(FIRN_SOURCE_DIR) + "/tests/graph/execution/shaders/";
  const auto add = [&](const char* name, const char* kernel, std::vector<const char*> ports) {
    StageSpec spec;
    spec.name = name;
    spec.doc = "of the test";
    for (const char* port : ports)
      spec.ports.push_back({.name = port,
                            .type = ElementType::float1,
                            .domain = "1",
                            .access = ports.size() == 1 ? Access::write : Access::read_write,
                            .unit = "1",
                            .doc = "of the test"});
    spec.work = {Dispatch{.kernel = shaders + kernel, .over = "4"}};
    registry.add(std::move(spec));
  };
  add("test.start", "start.comp", {"left"});
  add("test.count", "count.comp", {"runs", "left"});
  const std::filesystem::path file = folder.path / "counts.yaml";
  std::ofstream(file) << "firn: 1\nstep: [test.start, test.count]\n";
  config::Diagnostics diagnostics;
  const PipelineSpec pipeline = load_pipeline(file, {}, diagnostics);
  Environment environment;
  environment.provided = {"runs", "left"};
  const Plan plan = compile(pipeline, registry, environment, diagnostics, {});
  config::throw_if_errors(diagnostics);
  device();
  const gpu::CallCounter counter;
  execution::Execution execution(device(), plan, registry,
                                 {.shader_folders = {std::string(FIRN_SOURCE_DIR) + "/shaders"},
                                  .barriers_all = false,
                                  .profile = false,
                                  .program_cache = cache});
  Result result;
  const auto calls = gpu::CallCounter::take();
  if (calls.contains("glCompileShader")) result.compiled = calls.at("glCompileShader");
  execution.setup();
  for (int i = 0; i < 3; ++i) execution.step();
  std::memcpy(&result.runs, execution.read("runs").data(), sizeof result.runs);
  return result;
}

}  // namespace

TEST_CASE("programs are compiled once, then come from the cache, and do the same") {
  const Folder folder;
  const std::filesystem::path cache = folder.path / "cache";
  const bool cached = device().info().program_binary_formats > 0;
  const Result first = run(folder, cache);
  CHECK((first.runs == 3 && first.compiled == 2));
  const Result second = run(folder, cache);
  CHECK(second.runs == 3);
  CHECK(second.compiled == (cached ? 0u : 2u));
  if (!cached) return;
  for (const auto& entry : std::filesystem::directory_iterator(cache)) {
    std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 2);
    break;
  }
  const Result one_damaged = run(folder, cache);
  CHECK((one_damaged.runs == 3 && one_damaged.compiled == 1));
  CHECK(run(folder, cache).compiled == 0);
}

TEST_CASE("without a folder for programs nothing is kept") {
  const Folder folder;
  CHECK(run(folder, "").compiled == 2);
  CHECK(run(folder, "").compiled == 2);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path)) CHECK(entry.path().filename() == "counts.yaml");
}
