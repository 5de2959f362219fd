#include <string>

#include "tests/catch.h"
#include "tests/graph/loaded.h"

// Every way of writing a pipeline that is right.

namespace firn::test {
namespace {

std::string step_of(const std::string& yaml, const graph::Edits& edits = {}) {
  const Loaded result = loaded(yaml, edits);
  CHECK(result.messages == Lines{});
  return text_of(result.pipeline.step);
}

TEST_CASE("a pipeline has a name, a doc, a scene, parameters and three phases") {
  const Folder folder;
  folder.write("pipelines/snow.yaml",
               "firn: 1\nname: height_field\nscene: scenes/ball.yaml\ndoc: Height-field snow\nparameters: {k: 8}\n"
               "setup: [a.init]\nstep: [a.move, a.look]\nframe: [a.draw]\n");
  const auto [pipeline, lines] = loaded(folder, "pipelines/snow.yaml");
  CHECK(lines == Lines{});
  CHECK(pipeline.name == "height_field");
  CHECK(pipeline.doc == "Height-field snow");
  CHECK(folder.shortened(pipeline.scene) == "pipelines/scenes/ball.yaml");
  CHECK(folder.shortened(to_string(pipeline.scene_place)) == "pipelines/snow.yaml:3:8");
  CHECK(folder.shortened(pipeline.file) == "pipelines/snow.yaml");
  CHECK(flow(pipeline.parameters) == "{k: 8}");
  CHECK(text_of(pipeline.setup) == "a.init");
  CHECK(text_of(pipeline.step) == "a.move a.look");
  CHECK(text_of(pipeline.frame) == "a.draw");
}

TEST_CASE("without a name a pipeline is called like its file") {
  const Folder folder;
  folder.write("two_balls.yaml", "firn: 1\nstep: [a]\n");
  CHECK(loaded(folder, "two_balls.yaml").pipeline.name == "two_balls");
  CHECK(loaded(folder, "two_balls.yaml").pipeline.scene.empty());
}

TEST_CASE("a stage is a name, a name with options, or a map with the key stage") {
  CHECK(step_of("firn: 1\nstep:\n  - a.move\n  - a.move: {speed: 3, mode: fast}\n  - a.move:\n  - a.move:\n      speed: 4\n") ==
        "a.move a.move#2(stage=a.move speed=3 mode=fast) a.move#3(stage=a.move) a.move#4(stage=a.move speed=4)");
  CHECK(step_of("firn: 1\nstep:\n  - {stage: a.move, speed: 3}\n  - stage: a.look\n    every: 2\n") ==
        "a.move(speed=3) a.look(every=2)");
}

TEST_CASE("options: bind, every, enable, as") {
  CHECK(step_of("firn: 1\nstep:\n  - a.move: {bind: {x: y, z: w}, every: 4, enable: false, as: slow, speed: 1}\n") ==
        "slow(stage=a.move speed=1 x>y z>w every=4 off)");
  CHECK(step_of("firn: 1\nstep:\n  - a.move: {enable: true}\n") == "a.move");
}

TEST_CASE("labels are unique through all phases") {
  const auto [pipeline, lines] =
      loaded("firn: 1\nsetup: [a.move, a.look]\nstep: [a.move, {repeat: 2, stages: [a.move, a.look]}]\nframe: [a.move]\n");
  CHECK(lines == Lines{});
  CHECK(text_of(pipeline.setup) == "a.move a.look");
  CHECK(text_of(pipeline.step) == "a.move#2(stage=a.move) repeat 2 [a.move#3(stage=a.move) a.look#2(stage=a.look)]");
  CHECK(text_of(pipeline.frame) == "a.move#4(stage=a.move)");
}

TEST_CASE("a label that as gives is never given again") {
  CHECK(step_of("firn: 1\nstep: [a, {b: {as: \"a#2\"}}, a]\n") == "a a#2(stage=b) a#3(stage=a)");
  CHECK(step_of("firn: 1\nstep: [{b: {as: a}}, a]\n") == "a(stage=b) a#2(stage=a)");
  CHECK(step_of("firn: 1\nstep: [a, a, {b: {as: \"a#3\"}}, a]\n") == "a a#2(stage=a) a#3(stage=b) a#4(stage=a)");
}

TEST_CASE("a repeat has a number of turns, or at most so many until a value is small") {
  CHECK(step_of("firn: 1\nstep:\n  - repeat: 4\n    stages: [a, b]\n") == "repeat 4 [a b]");
  CHECK(
      step_of(
          "firn: 1\nstep:\n  - repeat: {max: 64, until: {buffer: moved, below: 1.0e-6}}\n    stages:\n      - a: {slope: 0.6}\n") ==
      "repeat 64 until moved<1e-06 [a(slope=0.6)]");
  CHECK(step_of("firn: 1\nstep:\n  - repeat: {max: 3}\n    stages:\n      - a\n      - repeat: 2\n        stages: [b]\n") ==
        "repeat 3 [a repeat 2 [b]]");
}

TEST_CASE("a group is its stages") {
  CHECK(step_of("firn: 1\nstep:\n  - a\n  - group: displace\n    stages: [b, {c: {k: 1}}]\n  - d\n") == "a b c(k=1) d");
  CHECK(step_of("firn: 1\nstep:\n  - repeat: 2\n    stages: [{group: inner, stages: [a]}]\n") == "repeat 2 [a]");
}

TEST_CASE("replace puts other stages into a group, wherever it stands") {
  CHECK(step_of("firn: 1\nreplace: {inner: [x, y]}\nstep:\n  - {group: outer, stages: [a, {group: inner, stages: [b, c]}]}\n") ==
        "a x y");
  CHECK(step_of("firn: 1\nreplace: {inner: []}\nstep:\n  - a\n  - {repeat: 2, stages: [d, {group: inner, stages: [b]}]}\n") ==
        "a repeat 2 [d]");
}

TEST_CASE("parameters stand for values, whole or inside texts") {
  CHECK(step_of("firn: 1\nparameters: {k: 4, v: [1, 2, 3], name: fine}\nstep:\n"
                "  - a: {k: \"${k}\", v: \"${v}\", file: \"out/${name}_${k}.npy\"}\n") == "a(k=4 v=[1, 2, 3] file=out/fine_4.npy)");
  CHECK(step_of("firn: 1\nparameters: {n: 7, limit: 0.5, which: b, port: x}\nstep:\n"
                "  - repeat: {max: \"${n}\", until: {buffer: \"${port}\", below: \"${limit}\"}}\n    stages: [\"${which}\"]\n") ==
        "repeat 7 until x<0.5 [b]");
}

TEST_CASE("phases may be left out or empty") {
  CHECK(step_of("firn: 1\nsetup:\nstep: [a]\nframe: []\n") == "a");
  CHECK(loaded("firn: 1\nsetup: [a]\n").messages == Lines{});
}

TEST_CASE("stages keep the places of their names, options and values") {
  const auto [pipeline, lines] = loaded("firn: 1\nstep:\n  - a\n  - b: {k: 3, bind: {x: y}}\n");
  const auto& first = std::get<graph::StageUse>(pipeline.step.at(0).what);
  const auto& second = std::get<graph::StageUse>(pipeline.step.at(1).what);
  CHECK((first.place.line == 3 && first.place.column == 5));
  CHECK((second.place.line == 4 && second.place.column == 5));
  CHECK((second.parameters.at(0).place.column == 9 && second.parameters.at(0).value.place.column == 12));
  CHECK(second.bindings.at(0).place.column == 22);
}

TEST_CASE("when: a stage, a group or a repeat takes part only where a parameter of the pipeline has that value") {
  const std::string yaml =
      "firn: 1\nparameters: {kernel: cubic, passes: 4, mode: fast}\nstep:\n  - a: {when: {kernel: cubic}}\n"
      "  - b: {when: {kernel: linear}}\n  - c: {when: {kernel: [linear, cubic], passes: 4.0}}\n"
      "  - d: {when: {kernel: cubic, mode: slow}}\n  - {group: g, when: {passes: 3}, stages: [e, f]}\n"
      "  - {repeat: 2, when: {mode: fast}, stages: [h, {i: {when: {passes: [1, 2]}}}]}\n";
  CHECK(step_of(yaml) == "a b(off) c d(off) e(off) f(off) repeat 2 [h i(off)]");
  CHECK(text_of(loaded(yaml, set({"kernel=linear", "passes=3", "mode=slow"})).pipeline.step) ==
        "a(off) b c(off) d(off) e f repeat 2 [h(off) i(off)]");
}

TEST_CASE("a stage whose when does not hold cannot be enabled, and one that holds can be disabled") {
  const std::string yaml =
      "firn: 1\nparameters: {k: 1}\nstep:\n  - a: {when: {k: 2}, enable: true}\n  - b: {enable: false, when: {k: 1}}\n";
  CHECK(step_of(yaml) == "a(off) b(off)");
  CHECK(text_of(loaded(yaml, set({"a.enable=true", "b.enable=true"})).pipeline.step) == "a(off) b");
}

}  // namespace
}  // namespace firn::test
