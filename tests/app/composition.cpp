#include "tests/app/inputs.h"
#include "tests/catch.h"

// Pipelines put together on the command line, with conditions, and with stages that are files.

namespace firn::test {
namespace {

const std::string damping = R"(/*
firn: 1
name: damping
doc: Slows particles down
ports:
  velocity: {type: vec3, domain: particles, access: read_write, unit: m/s, doc: velocity}
parameters:
  rate: {default: 1, min: 0, max: 10, unit: 1/s, doc: how much}
over: particles
*/
void main() {
  if (element_index() < particles_count) velocity[element_index()] *= exp(-rate * dt);
}
)";

std::string with(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return std::string(text).replace(at, from.size(), to);
}

struct Case {
  Case(const std::string& pipeline_text, const std::string& stage_text) {
    folder.write("scene.yaml", small_scene);
    folder.write("damping.comp", stage_text);
    pipeline = folder.write("pipeline.yaml", pipeline_text);
  }
  Folder folder;
  std::string pipeline;
};

std::string with_group() { return with(small_pipeline, "  - mpm.advect\n", "  - group: last\n    stages: [mpm.advect]\n"); }

// "17 stages": how many firn check counts.
std::string stages_in(const Outcome& outcome) {
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  const std::size_t end = outcome.out.find(" stages");
  REQUIRE(end != std::string::npos);
  return outcome.out.substr(outcome.out.rfind(' ', end - 1) + 1, end - outcome.out.rfind(' ', end - 1) - 1);
}

TEST_CASE("the option --replace gives a group other stages, by name or by path", "[app]") {
  const Case made(with_group(), damping);
  const int before = std::stoi(stages_in(run_firn({"check", made.pipeline})));
  const std::string two = "last=" + (made.folder / "damping.comp") + ",mpm.advect";
  CHECK(std::stoi(stages_in(run_firn({"check", made.pipeline, "--replace", two}))) == before + 1);
  CHECK(std::stoi(stages_in(run_firn({"check", made.pipeline, "--replace", two, "--set", "damping.rate=3"}))) == before + 1);
}

TEST_CASE("mistakes in --replace are told by the words they are in", "[app]") {
  const Case made(with_group(), damping);
  const auto error = [&](const std::string& words) {
    const Outcome outcome = run_firn({"check", made.pipeline, "--replace", words});
    CHECK(outcome.status == 2);
    return outcome.err;
  };
  CHECK(error("lst=mpm.advect").find("--replace lst=mpm.advect: error: no group 'lst' to replace; did you mean 'last'?") == 0);
  CHECK(error("last=mpm.advct").find("--replace last=mpm.advct: error: unknown stage 'mpm.advct'; did you mean 'mpm.advect'?") ==
        0);
  CHECK(error("last=./nowhere.comp").find("--replace last=./nowhere.comp: error: no such stage file: './nowhere.comp'") == 0);
  for (const char* words : {"last", "last=", "=mpm.advect", "last=mpm.advect,", "last=,mpm.advect"})
    CHECK(error(words).find("expected GROUP=STAGE,STAGE") != std::string::npos);
}

TEST_CASE("a stage whose when does not hold is left out, and --set can bring it in", "[app]") {
  const Case made(with(small_pipeline, "  - mpm.advect\n", "  - ./damping.comp: {when: {kernel: cubic}}\n  - mpm.advect\n"),
                  damping);
  const int without = std::stoi(stages_in(run_firn({"check", made.pipeline})));
  CHECK(std::stoi(stages_in(run_firn({"check", made.pipeline, "--set", "kernel=cubic"}))) == without + 1);
}

TEST_CASE("a stage from a file runs, and its mistakes are told inside the file", "[app]") {
  const std::string pipeline = with(small_pipeline, "  - mpm.advect\n", "  - ./damping.comp: {rate: 2}\n  - mpm.advect\n");
  const Case good(pipeline, damping);
  const Outcome outcome = run_firn({"run", good.pipeline, "--steps", "3", "--out", good.folder / "out"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);

  const Case spoilt(pipeline, with(with(damping, "vec3", "vec5"), "default: 1", "default: 11"));
  const Outcome refused = run_firn({"check", spoilt.pipeline});
  CHECK(refused.status == 2);
  CHECK(refused.err.find("damping.comp:6:20: error: type cannot be 'vec5'") != std::string::npos);
  CHECK(refused.err.find("damping.comp:8:19: error: default must be between 0 and 10, not 11") != std::string::npos);

  const Case broken(pipeline, with(damping, "exp(-rate", "expp(-rate"));
  const Outcome failed = run_firn({"run", broken.pipeline, "--steps", "1", "--out", broken.folder / "out"});
  CHECK(failed.status == 2);
  CHECK(failed.err.find("damping.comp:12: error:") != std::string::npos);
}

}  // namespace
}  // namespace firn::test
