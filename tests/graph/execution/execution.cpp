// Plans on a device: order, repeats, thinning, faults, and what is refused.

#include "graph/execution/execution.h"

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "gpu/program.h"
#include "graph/compile.h"
#include "tests/catch.h"

using namespace firn;
using namespace firn::graph;

namespace {

gpu::Device& device() {
  static const std::unique_ptr<gpu::Device> one = gpu::Device::open();
  return *one;
}

Registry made_up_stages() {
  const std::string folder = std::string(FIRN_SOURCE_DIR) + "/tests/graph/execution/shaders/";
  const auto port = [](const char* name, Access access) {
    return Port{.name = name, .type = ElementType::float1, .domain = "1", .access = access, .unit = "1", .doc = "of the test"};
  };
  Registry registry;
  const auto add = [&](const char* name, const char* kernel, std::vector<Port> ports, std::vector<Fault> faults) {
    StageSpec spec;
    spec.name = name;
    spec.doc = "of the test";
    spec.ports = std::move(ports);
    spec.faults = std::move(faults);
    spec.work = {Dispatch{.kernel = folder + kernel, .over = "4"}};
    registry.add(std::move(spec));
  };
  add("test.start", "start.comp", {port("left", Access::write)}, {});
  add("test.count", "count.comp", {port("runs", Access::read_write), port("left", Access::read_write)}, {});
  add("test.faulty", "faulty.comp", {port("runs", Access::read)}, {Fault::not_a_number});
  add("test.broken", "broken.comp", {port("runs", Access::write)}, {});
  return registry;
}

std::unique_ptr<execution::Execution> executed(const std::string& yaml, int steps) {
  const auto file = std::filesystem::temp_directory_path() / ("firn-execution-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(file) << yaml;
  config::Diagnostics diagnostics;
  const PipelineSpec pipeline = load_pipeline(file, {}, diagnostics);
  std::filesystem::remove(file);
  const Registry registry = made_up_stages();
  Environment environment;
  environment.provided = {"runs", "left"};
  const Plan plan = compile(pipeline, registry, environment, diagnostics);
  config::throw_if_errors(diagnostics);
  auto execution = std::make_unique<execution::Execution>(device(), plan, registry, execution::Options{});
  execution->setup();
  for (int i = 0; i < steps; ++i) execution->step();
  return execution;
}

float value(const execution::Execution& execution, const std::string& buffer) {
  float number = 0;
  std::memcpy(&number, execution.read(buffer).data(), sizeof number);
  return number;
}

}  // namespace

TEST_CASE("a repeat runs its stages as often as it says") {
  const auto execution = executed("firn: 1\nstep:\n  - repeat: 5\n    stages: [test.count]\n", 3);
  CHECK(value(*execution, "runs") == 15);
}

TEST_CASE("a repeat ends as soon as the watched buffer is below the limit") {
  const auto execution = executed(
      "firn: 1\nstep:\n  - test.start\n  - repeat: {max: 64, until: {buffer: left, below: 0.1}}\n    stages: [test.count]\n", 1);
  CHECK(value(*execution, "runs") == 4);  // 1/2, 1/4, 1/8, 1/16
}

TEST_CASE("every N runs a stage in every Nth step, the first one included") {
  const auto execution = executed("firn: 1\nstep:\n  - test.count: {every: 3}\n", 7);
  CHECK(value(*execution, "runs") == 3);
}

TEST_CASE("a disabled stage does not run") {
  const auto execution = executed("firn: 1\nstep:\n  - test.count\n  - test.count: {enable: false}\n", 2);
  CHECK(value(*execution, "runs") == 2);
}

TEST_CASE("a fault names stage, step and count") {
  const auto execution = executed("firn: 1\nstep:\n  - test.count\n  - test.faulty\n", 3);
  CHECK_NOTHROW(execution->check_faults());
  execution->step();
  execution->step();
  try {
    execution->check_faults();
    FAIL("no fault was reported");
  } catch (const execution::NumbersError& error) {
    const std::string text = error.what();
    CHECK(text.find("test.faulty") != std::string::npos);
    CHECK(text.find("step 3") != std::string::npos);
    CHECK(text.find("2 cases") != std::string::npos);
  }
}

TEST_CASE("a kernel that does not compile is told with its own file and line") {
  try {
    executed("firn: 1\nstep: [test.broken]\n", 0);
    FAIL("it compiled");
  } catch (const gpu::ShaderError& error) {
    CHECK(std::string(error.what()).find("shaders/broken.comp:2") != std::string::npos);
  }
}

TEST_CASE("what a device lacks for a plan is told by stage and number") {
  const auto execution = executed("firn: 1\nstep: [test.count]\n", 0);
  gpu::Limits limits = device().info().limits;
  CHECK(execution::shortcomings(execution->plan(), limits).empty());
  limits.storage_blocks_compute = 1;
  const std::vector<std::string> missing = execution::shortcomings(execution->plan(), limits);
  REQUIRE(missing.size() == 1);
  CHECK(missing[0].find("test.count") != std::string::npos);
  CHECK(missing[0].find("needs 2 storage blocks; the device has 1") != std::string::npos);
}
