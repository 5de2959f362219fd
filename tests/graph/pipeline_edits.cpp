#include <string>

#include "tests/catch.h"
#include "tests/graph/loaded.h"

// What the command line changes.

namespace firn::test {
namespace {

constexpr const char* text =
    "firn: 1\nparameters: {k: 8, mode: fast}\nsetup: [a.init]\nstep:\n  - a.move: {k: \"${k}\", mode: \"${mode}\", speed: 1}\n"
    "  - {group: displace, stages: [b.push]}\n  - {repeat: 3, stages: [{c: {as: solver, slope: 2}}, a.move]}\n";

std::string step_of(const graph::Edits& edits) {
  const Loaded result = loaded(text, edits);
  CHECK(result.messages == Lines{});
  return text_of(result.pipeline.step);
}

graph::Edits disable(const std::string& name) { return {.set = {}, .disable = {name}, .replace = {}}; }

graph::Edits replace(const std::string& group, const std::string& stages) {
  config::Diagnostics diagnostics;
  graph::Edits edits;
  edits.replace.emplace_back(group, config::parse(stages, "--replace " + group, diagnostics));
  config::throw_if_errors(diagnostics);
  return edits;
}

TEST_CASE("the option --set changes a parameter of the pipeline everywhere") {
  CHECK(step_of(set({"k=4"})) == "a.move(k=4 mode=fast speed=1) b.push repeat 3 [solver(stage=c slope=2) a.move#2(stage=a.move)]");
  CHECK(step_of(set({"k=[1, 2]", "mode=slow"})).starts_with("a.move(k=[1, 2] mode=slow speed=1)"));
  CHECK(flow(loaded(text, set({"k=4"})).pipeline.parameters) == "{k: 4, mode: fast}");
}

TEST_CASE("the option --set changes or adds a parameter of one stage, by its label") {
  CHECK(step_of(set({"solver.slope=5"})).ends_with("repeat 3 [solver(stage=c slope=5) a.move#2(stage=a.move)]"));
  CHECK(step_of(set({"b.push.force=5"})).find("b.push(force=5)") != std::string::npos);
  CHECK(step_of(set({"a.move#2.speed=7"})) ==
        "a.move(k=8 mode=fast speed=1) b.push repeat 3 [solver(stage=c slope=2) a.move#2(stage=a.move speed=7)]");
}

TEST_CASE("the option --set by a stage's name changes all its uses") {
  CHECK(step_of(set({"a.move.speed=7"})) ==
        "a.move(k=8 mode=fast speed=7) b.push repeat 3 [solver(stage=c slope=2) a.move#2(stage=a.move speed=7)]");
  CHECK(step_of(set({"c.slope=9"})).find("solver(stage=c slope=9)") != std::string::npos);
}

TEST_CASE("the option --set changes every and enable as well") {
  CHECK(step_of(set({"solver.every=5", "b.push.enable=false"})) ==
        "a.move(k=8 mode=fast speed=1) b.push(off) repeat 3 [solver(stage=c slope=2 every=5) a.move#2(stage=a.move)]");
  CHECK(load_messages(text, set({"solver.every=0"})) ==
        Lines{"--set solver.every=0: error: every must be between 1 and 1000000000, not 0"});
}

TEST_CASE("the last --set of a value counts, and it keeps its own place") {
  const graph::PipelineSpec pipeline = loaded(text, set({"b.push.force=1", "b.push.force=2"})).pipeline;
  const auto& use = std::get<graph::StageUse>(pipeline.step.at(1).what);
  REQUIRE(use.parameters.size() == 1);
  CHECK(use.parameters[0].value.scalar == "2");
  CHECK(to_string(use.parameters[0].place) == "--set b.push.force=2");
}

TEST_CASE("what --set says of the scene is for others") {
  CHECK(step_of(set({"scene.gravity=[0, 0, 0]", "scene=other.yaml"})) == step_of({}));
}

TEST_CASE("an unknown name of --set is an error with the nearest one") {
  CHECK(load_messages(text, set({"mod=slow"})) ==
        Lines{"--set mod=slow: error: no parameter 'mod' in this pipeline; did you mean 'mode'?"});
  CHECK(load_messages(text, set({"sover.slope=3"})) ==
        Lines{"--set sover.slope=3: error: no stage 'sover' in this pipeline; did you mean 'solver'?"});
  CHECK(load_messages(text, set({"a.mvoe.speed=3"})) ==
        Lines{"--set a.mvoe.speed=3: error: no stage 'a.mvoe' in this pipeline; did you mean 'a.move'?"});
  CHECK(load_messages(text, set({"a.move.bind.x=y"})) == Lines{"--set a.move.bind.x=y: error: write a.move.<parameter>=<value>"});
  CHECK(
      load_messages("firn: 1\nstep: [a]\n", set({"k=3"})) ==
      Lines{"--set k=3: error: no parameter 'k': this pipeline has no parameters of its own; write <stage>.<parameter>=<value> or "
            "scene.<key>=<value>"});
}

TEST_CASE("the option --disable turns off a label or all uses of a stage") {
  CHECK(step_of(disable("solver")).find("solver(stage=c slope=2 off) a.move#2(stage=a.move)]") != std::string::npos);
  CHECK(step_of(disable("a.move")) ==
        "a.move(k=8 mode=fast speed=1 off) b.push repeat 3 [solver(stage=c slope=2) a.move#2(stage=a.move off)]");
  CHECK(load_messages(text, disable("solvr")) ==
        Lines{"--disable solvr: error: no stage 'solvr' in this pipeline; did you mean 'solver'?"});
}

TEST_CASE("the option --replace puts other stages into a group") {
  CHECK(step_of(replace("displace", "[d.one, {d.two: {k: \"${k}\"}}]"))
            .starts_with("a.move(k=8 mode=fast speed=1) d.one d.two(k=8) repeat"));
  CHECK(load_messages(text, replace("displcae", "[d]")) ==
        Lines{"--replace displcae:1:1: error: no group 'displcae' to replace; did you mean 'displace'?"});
  CHECK(load_messages("firn: 1\nstep: [a]\n", replace("displace", "[d]")) ==
        Lines{"--replace displace:1:1: error: no group 'displace' to replace: the pipeline has no groups"});
  CHECK(load_messages(text, replace("displace", "d")) ==
        Lines{"--replace displace:1:1: error: stages must be a list of stages, not 'd'"});
}

}  // namespace
}  // namespace firn::test
