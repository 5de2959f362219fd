// Plans on a device: order, repeats, thinning, faults, and what is refused.

#include "graph/execution/execution.h"

#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>

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
  const auto add_array = [&](const char* name, ElementType type, std::vector<Port> ports, std::vector<Work> work) {
    StageSpec spec;
    spec.name = name;
    spec.doc = "of the test";
    spec.ports = std::move(ports);
    for (Port& p : spec.ports) p.type = p.type == ElementType::float1 ? type : p.type;
    spec.work = std::move(work);
    spec.parameters = {{.name = "kind",
                        .kind = ParameterKind::choice,
                        .initial = std::string(graph::name(type)),
                        .choices = {"int", "uint", "float"},
                        .doc = "of the buffer"}};
    registry.add(std::move(spec));
  };
  const auto four = [](const char* name, Access access) {
    return Port{.name = name, .type = ElementType::float1, .domain = "4", .access = access, .unit = "1", .doc = "of the test"};
  };
  for (const auto& [type, name] :
       {std::pair{ElementType::int1, "int"}, {ElementType::uint1, "uint"}, {ElementType::float1, "float"}}) {
    add_array((std::string("test.fill_") + name).c_str(), type, {four("rest", Access::write)},
              {Dispatch{.kernel = folder + "fill.comp", .over = "4"}});
    add_array((std::string("test.drain_") + name).c_str(), type, {four("rest", Access::read_write)},
              {Dispatch{.kernel = folder + "drain.comp", .over = "4"}});
  }
  // Reads through a texture, so that what lies behind a small buffer in shared memory would show.
  add_array("test.take_int", ElementType::int1, {four("rest", Access::read), four("taken", Access::write)},
            {Dispatch{.kernel = folder + "take.comp",
                      .over = "4",
                      .uses = {{"rest", Access::read, Usage::sampled}, {"taken", Access::write}}}});
  // The second kernel runs over as many groups as the first one says.
  const Port counts{
      .name = "counts", .type = ElementType::uint1, .domain = "3", .access = Access::read_write, .unit = "1", .doc = "d"};
  add_array("test.drain_listed", ElementType::int1, {four("rest", Access::read_write), counts},
            {Dispatch{.kernel = folder + "list.comp", .over = "1", .uses = {{"counts", Access::write}}},
             Dispatch{.kernel = folder + "drain.comp", .over = "", .indirect = "counts", .uses = {{"rest", Access::read_write}}}});
  add_array("test.drain_if_bodies", ElementType::int1, {four("rest", Access::read_write)},
            {Dispatch{.kernel = folder + "drain.comp", .over = "4", .needs = "bodies"}});
  add("test.start", "start.comp", {port("left", Access::write)}, {});
  add("test.count", "count.comp", {port("runs", Access::read_write), port("left", Access::read_write)}, {});
  add("test.faulty", "faulty.comp", {port("runs", Access::read)}, {Fault::not_a_number});
  add("test.broken", "broken.comp", {port("runs", Access::write)}, {});
  return registry;
}

std::unique_ptr<execution::Execution> executed(const std::string& yaml, int steps, const PlanOptions& options = {},
                                               std::uint64_t bodies = 0) {
  const auto file = std::filesystem::temp_directory_path() / ("firn-execution-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(file) << yaml;
  config::Diagnostics diagnostics;
  const PipelineSpec pipeline = load_pipeline(file, {}, diagnostics);
  std::filesystem::remove(file);
  const Registry registry = made_up_stages();
  Environment environment;
  environment.provided = {"runs", "left", "rest"};
  environment.domains["bodies"] = {.count = bodies};
  const Plan plan = compile(pipeline, registry, environment, diagnostics, options);
  config::throw_if_errors(diagnostics);
  auto execution = std::make_unique<execution::Execution>(
      device(), plan, registry, execution::Options{.shader_folders = {std::string(FIRN_SOURCE_DIR) + "/shaders"}});
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

TEST_CASE("a kernel that needs bodies does nothing where there are none, and works where there are some") {
  const std::string yaml = "firn: 1\nsetup: [test.fill_int]\nstep: [test.drain_if_bodies]\n";
  const auto rest = [](const execution::Execution& execution) {
    std::int32_t number = 0;
    std::memcpy(&number, execution.read("rest").data(), sizeof number);
    return number;
  };
  const std::int32_t untouched = rest(*executed(yaml, 0));
  CHECK(rest(*executed(yaml, 1)) == untouched);
  CHECK(rest(*executed(yaml, 1, {}, 2)) < untouched);
}

TEST_CASE("a repeat ends as soon as the watched buffer is below the limit") {
  const auto execution = executed(
      "firn: 1\nstep:\n  - test.start\n  - repeat: {max: 64, until: {buffer: left, below: 0.1}}\n    stages: [test.count]\n", 1);
  CHECK(value(*execution, "runs") == 4);  // 1/2, 1/4, 1/8, 1/16
}

TEST_CASE("a repeat ends after the same turn whether the device decides or the host") {
  const auto watched = GENERATE(as<std::string>(), "{buffer: left, below: 0.1}", "{buffer: left, below: 0.0625}",
                                "{buffer: left, below: -1}", "{buffer: left, below: 2}");
  const std::string yaml = "firn: 1\nstep:\n  - test.start\n  - repeat: {max: 6, until: " + watched +
                           "}\n    stages: [test.count]\n  - repeat: 2\n    stages: [test.count]\n";
  const auto by_host = executed(yaml, 3);
  const auto by_device = executed(yaml, 3, {.decide_on_device = true});
  REQUIRE(by_device->plan().stages.size() == by_host->plan().stages.size() + 1);
  CAPTURE(watched);
  CHECK(value(*by_device, "runs") == value(*by_host, "runs"));
  CHECK(value(*by_device, "left") == value(*by_host, "left"));
  REQUIRE(by_device->turns().size() == 2);
  for (const auto* execution : {&by_host, &by_device}) {
    const std::vector<execution::RepeatTurns> turns = (*execution)->turns();
    CHECK(static_cast<float>(turns.at(0).turns) == value(**execution, "runs") - 6);
    CHECK((turns[0].rounds == 3 && turns[0].max == 6 && turns[0].place.line == 4));
    CHECK((turns[1].rounds == 3 && turns[1].turns == 6));
  }
}

TEST_CASE("a repeat ends once every element is below the limit, whatever they are") {
  const auto type = GENERATE(as<std::string>(), "int", "uint", "float");
  const bool by_device = GENERATE(false, true);
  CAPTURE(type, by_device);
  // 3, 1, 4, 2 left; every turn takes one away.
  const auto execution =
      executed("firn: 1\nstep:\n  - test.fill_" + type + "\n  - repeat: {max: 9, until: {buffer: rest, below: 0.5}}\n" +
                   "    stages: [test.drain_" + type + "]\n",
               2, {.decide_on_device = by_device});
  CHECK(execution->turns().at(0).turns == 8);
}

TEST_CASE("a value that is not a number is below no limit") {
  const bool by_device = GENERATE(false, true);
  const auto execution =
      executed("firn: 1\nstep:\n  - repeat: {max: 5, until: {buffer: left, below: 0.1}}\n    stages: [test.count]\n", 0,
               {.decide_on_device = by_device});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  execution->write("left", std::as_bytes(std::span(&nan, 1)));
  execution->step();
  CHECK(execution->turns().at(0).turns == 5);
  CHECK(value(*execution, "runs") == 5);
}

TEST_CASE("dispatches with group counts of their own stand still as well once the device has decided") {
  const bool by_device = GENERATE(false, true);
  const auto execution = executed(
      "firn: 1\nstep:\n  - test.fill_int\n  - repeat: {max: 9, until: {buffer: rest, below: 3}}\n    stages: [test.drain_listed]\n",
      2, {.decide_on_device = by_device});
  CHECK((execution->plan().stages.size() == 3) == by_device);
  CHECK(execution->turns().at(0).turns == 4);  // 3, 1, 4, 2 are 1, 0, 2, 0 after two turns
  std::array<std::int32_t, 4> rest{};
  std::memcpy(rest.data(), execution->read("rest").data(), sizeof rest);
  CHECK(rest == std::array<std::int32_t, 4>{1, 0, 2, 0});
}

TEST_CASE("buffers that share memory bring the same bytes as buffers of their own") {
  const std::string yaml =
      "firn: 1\nstep:\n  - test.fill_int: {bind: {rest: a}}\n  - test.take_int: {bind: {rest: a, taken: b}}\n"
      "  - test.take_int: {bind: {rest: b, taken: c}}\n  - test.take_int: {bind: {rest: c, taken: d}}\n"
      "  - test.take_int: {bind: {rest: d, taken: rest}}\n";
  const auto shared = executed(yaml, 3, {.share_memory = true});
  const auto own = executed(yaml, 3);
  CHECK(shared->plan().bytes + 32 == own->plan().bytes);
  CHECK(shared->read("rest") == own->read("rest"));
  std::array<std::int32_t, 4> rest{};
  std::memcpy(rest.data(), shared->read("rest").data(), sizeof rest);
  CHECK(rest == std::array<std::int32_t, 4>{-1, -3, 0, -2});
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

TEST_CASE("a kernel named by its whole path that does not compile is wrong input, told with its own file and line") {
  try {
    executed("firn: 1\nstep: [test.broken]\n", 0);
    FAIL("it compiled");
  } catch (const config::InputError& error) {
    CHECK(std::string(error.what()).find("shaders/broken.comp:2") != std::string::npos);
  }
}

TEST_CASE("memory is added up and held against the device's") {
  const auto execution = executed("firn: 1\nstep: [test.count]\n", 0);
  gpu::Limits limits = device().info().limits;
  CHECK((limits.memory_bytes > 1'000'000 || !device().info().software));
  limits.memory_bytes = 7;
  const std::vector<std::string> missing = execution::shortcomings(execution->plan(), limits);
  REQUIRE(missing.size() == 1);
  CHECK(missing[0] == "all buffers together need 8 bytes; the device has 7");
  limits.memory_bytes = 8;
  CHECK(execution::shortcomings(execution->plan(), limits).empty());
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
