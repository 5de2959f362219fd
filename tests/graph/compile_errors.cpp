#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/graph/made_up.h"

// Every check of a pipeline, with the place that the user is sent to.

namespace firn::test {
namespace {

TEST_CASE("a pipeline that is right has no messages") {
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep: [demo.move]\nframe: [demo.look]\n") == Lines{});
}

TEST_CASE("an unknown stage is an error at its name, with the nearest one") {
  CHECK(messages("firn: 1\nsetup:\n  - demo.fill\n  - demo.lok\nstep: [demo.look]\n") ==
        Lines{"p.yaml:4:5: error: unknown stage 'demo.lok'; did you mean 'demo.look'?"});
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.look\n  - demo.mvoe: {}\n") ==
        Lines{"p.yaml:5:5: error: unknown stage 'demo.mvoe'; did you mean 'demo.move'?"});
  const Lines far = messages("firn: 1\nsetup: [demo.fill]\nstep: [demo.look]\nframe: [xyz]\n");
  REQUIRE(far.size() == 1);
  CHECK(far[0].starts_with("p.yaml:4:9: error: unknown stage 'xyz'; valid: demo.blow, demo.bodies, demo.choose"));
}

TEST_CASE("an unknown port is an error at its binding, with the nearest one") {
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep: [demo.look, demo.move, {demo.copy: {bind: {yy: other}}}]\n") ==
        Lines{"p.yaml:3:50: error: demo.copy has no port 'yy'; did you mean 'y'?"});
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep: [demo.look, demo.move, {demo.measure: {bind: {ret: other}}}]\n") ==
        Lines{"p.yaml:3:53: error: demo.measure has no port 'ret'; did you mean 'rest'?"});
}

TEST_CASE("an unknown parameter is an error at its name, with the nearest one or those there are") {
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.tuned: {spede: 1}\n") ==
        Lines{"p.yaml:4:18: error: demo.tuned has no parameter 'spede'; did you mean 'speed'?"});
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.move:\n      speed: 1\n") ==
        Lines{"p.yaml:5:7: error: demo.move has no parameter 'speed'; valid: bind, every, enable, as, when"});
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.tuned: {evry: 1}\n") ==
        Lines{"p.yaml:4:18: error: demo.tuned has no parameter 'evry'; did you mean 'every'?"});
}

TEST_CASE("values of the wrong kind or out of range are errors at the value") {
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n"
                 "  - demo.tuned: {speed: 11}\n"
                 "  - demo.tuned: {speed: fast}\n"
                 "  - demo.tuned: {turns: 0}\n"
                 "  - demo.tuned: {turns: 2.5}\n"
                 "  - demo.tuned: {wrap: 1}\n"
                 "  - demo.tuned: {kernel: cubik}\n"
                 "  - demo.tuned: {push: [0, 6, 0]}\n"
                 "  - demo.tuned: {push: 3}\n"
                 "  - demo.tuned: {file: [a]}\n") ==
        Lines{"p.yaml:4:25: error: speed must be between 0 and 10, not 11",
              "p.yaml:5:25: error: speed must be a number, not 'fast'", "p.yaml:6:25: error: turns must be between 1 and 8, not 0",
              "p.yaml:7:25: error: turns must be a whole number, not '2.5'",
              "p.yaml:8:24: error: wrap must be true or false, not '1'; write true or false",
              "p.yaml:9:26: error: kernel cannot be 'cubik'; did you mean 'cubic'?",
              "p.yaml:10:28: error: push[1] must be between -5 and 5, not 6",
              "p.yaml:11:24: error: push must be a list of 3 numbers like [0, 1.5, 0], not '3'",
              "p.yaml:12:24: error: file must be a text, not a list"});
}

TEST_CASE("a whole number that kernels cannot hold is an error") {
  graph::Registry registry = made_up_registry();
  graph::StageSpec spec = stage("demo.count", {port("x", graph::Access::read_write)});
  spec.parameters = {{.name = "limit", .kind = graph::ParameterKind::integer, .initial = std::int64_t{1}, .doc = "unbounded"}};
  registry.add(spec);
  const std::string start = "firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.count: {limit: ";
  CHECK(compiled(start + "3000000000}\n", {}, registry).messages ==
        Lines{"p.yaml:4:25: error: limit must be between -2147483648 and 2147483647, not 3000000000"});
  CHECK(compiled(start + "2147483647}\n", {}, registry).messages == Lines{});
}

TEST_CASE("type, domain and unit of a port must be those of its buffer") {
  using enum graph::Access;
  using graph::ElementType;
  graph::Registry registry = made_up_registry();
  registry.add(stage("demo.typed", {port("x", read, "points", ElementType::vec3)}));
  registry.add(stage("demo.placed", {port("x", read, "cells")}));
  graph::StageSpec weighed = stage("demo.weighed", {port("x", read)});
  weighed.ports[0].unit = "kg";
  registry.add(weighed);
  const std::string since = "the buffer is {} (since p.yaml:2:9)";
  CHECK(
      compiled("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.typed\n  - demo.placed\n  - demo.weighed: {}\n", {}, registry)
          .messages ==
      Lines{
          "p.yaml:4:5: error: demo.typed: port 'x' and buffer 'x' differ in type: the buffer is float (since p.yaml:2:9), the port "
          "wants vec3",
          "p.yaml:5:5: error: demo.placed: port 'x' and buffer 'x' differ in domain: the buffer is points (since p.yaml:2:9), the "
          "port "
          "wants cells",
          "p.yaml:6:5: error: demo.weighed: port 'x' and buffer 'x' differ in unit: the buffer is m (since p.yaml:2:9), the port "
          "wants "
          "kg"});
  CHECK(
      compiled("firn: 1\nsetup: [demo.fill]\nstep: [demo.look]\nframe:\n  - demo.typed: {bind: {x: x}}\n", {}, registry).messages ==
      Lines{"p.yaml:5:25: error: demo.typed: port 'x' and buffer 'x' differ in type: the buffer is float (since p.yaml:2:9), the "
            "port "
            "wants vec3"});
}

TEST_CASE("one domain written in two ways is the same") {
  graph::Registry registry = made_up_registry();
  registry.add(stage("demo.block", {port("x", graph::Access::read, "points*1")}));
  registry.add(stage("demo.half", {port("x", graph::Access::read, "points/2")}));
  registry.add(stage("demo.ten", {port("x", graph::Access::read, "10")}));
  CHECK(compiled("firn: 1\nsetup: [demo.fill]\nstep: [demo.block]\n", {}, registry).messages == Lines{});
  CHECK(compiled("firn: 1\nsetup: [demo.fill]\nstep: [demo.half]\n", {}, registry).messages.size() == 1);
  CHECK(compiled("firn: 1\nsetup: [demo.fill]\nstep: [demo.ten]\n", {}, registry).messages.size() == 1);
}

TEST_CASE("a buffer that nobody writes is an error at its first reader, with the stages that would write it") {
  CHECK(messages("firn: 1\nstep:\n  - demo.show\n  - demo.show\n") ==
        Lines{"p.yaml:3:5: error: demo.show reads 'y', which no stage of this pipeline writes; demo.copy would"});
  const Lines several = messages("firn: 1\nstep:\n  - demo.look\n");
  REQUIRE(several.size() == 1);
  CHECK(several[0] ==
        "p.yaml:3:5: error: demo.look reads 'x', which no stage of this pipeline writes; demo.extra or demo.fill or demo.move "
        "or demo.needy or demo.tuned would");
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep: [demo.move, {demo.look: {bind: {x: other}}}]\nframe: [demo.look]\n") ==
        Lines{"p.yaml:3:39: error: demo.look reads 'other', which no stage of this pipeline writes; bind the port to another "
              "buffer, or add "
              "a stage that writes it"});
}

TEST_CASE("a disabled stage writes nothing") {
  CHECK(messages("firn: 1\nsetup:\n  - demo.fill: {enable: false}\nstep: [demo.look]\n").size() == 1);
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep: [demo.look]\n", {.set = {}, .disable = {"demo.fill"}, .replace = {}}).size() ==
        1);
}

TEST_CASE("two ports on one buffer are an error where one of them writes") {
  CHECK(
      messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.look\n  - demo.copy: {bind: {y: x}}\n") ==
      Lines{
          "p.yaml:5:5: error: demo.copy: ports 'x' and 'y' are both bound to buffer 'x', and one of them writes; bind them to two "
          "buffers"});
  graph::Registry registry = made_up_registry();
  registry.add(stage("demo.both", {port("x", graph::Access::read), port("z", graph::Access::read)}));
  CHECK(compiled("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.both: {bind: {z: x}}\n", {}, registry).messages == Lines{});
}

TEST_CASE("an unknown domain is one error per stage, with the environment's reason") {
  CHECK(messages("firn: 1\nstep:\n  - demo.bodies\n") ==
        Lines{"p.yaml:3:5: error: demo.bodies works on 'bodies', which is not known here: the scene has no bodies"});
  graph::Registry registry = made_up_registry();
  registry.add(stage("demo.odd", {port("x", graph::Access::read_write, "edges")}));
  CHECK(compiled("firn: 1\nstep: [demo.odd]\n", {}, registry).messages ==
        Lines{"p.yaml:2:8: error: demo.odd works on 'edges', which is not known here; valid: cells, points"});
}

TEST_CASE("a kernel over an unknown domain is an error too") {
  graph::Registry registry = made_up_registry();
  graph::StageSpec spec = stage("demo.odd", {port("x", graph::Access::read_write)});
  spec.work = {graph::Dispatch{.kernel = "odd.comp", .over = "bodies*2"}};
  registry.add(spec);
  CHECK(compiled("firn: 1\nstep: [demo.odd]\n", {}, registry).messages ==
        Lines{"p.yaml:2:8: error: demo.odd works on 'bodies', which is not known here: the scene has no bodies"});
}

TEST_CASE("a kernel that needs elements of an unknown domain is an error too") {
  graph::Registry registry = made_up_registry();
  graph::StageSpec spec = stage("demo.odd", {port("x", graph::Access::read_write)});
  spec.work = {graph::Dispatch{.kernel = "odd.comp", .over = "1", .needs = "bodies"}};
  registry.add(spec);
  CHECK(compiled("firn: 1\nstep: [demo.odd]\n", {}, registry).messages ==
        Lines{"p.yaml:2:8: error: demo.odd works on 'bodies', which is not known here: the scene has no bodies"});
}

TEST_CASE("a constant without a value is an error with the environment's reason") {
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.needy\n") ==
        Lines{"p.yaml:4:5: error: demo.needy needs 'density', which is not known here: the scene has no field"});
}

TEST_CASE("a scene of the wrong kind is one error that tells who needs what") {
  graph::Registry registry = made_up_registry();
  for (const char* name : {"demo.a", "demo.b", "demo.c", "demo.d"})
    registry.add(stage(name, {port("x", graph::Access::read_write, "points"), port("pull", graph::Access::write, "bodies")}));
  graph::Environment environment = made_up_environment();
  for (const char* name : {"edges", "corners", "density", "weight"}) environment.missing[name] = "the scene has no bodies";
  graph::StageSpec needy = stage("demo.e", {port("x", graph::Access::read_write, "points")});
  needy.constants = {"edges", "corners", "density", "weight"};
  registry.add(needy);
  const auto told = [&](const std::string& stages) {
    return compiled("firn: 1\nsetup: [demo.fill]\nstep: [" + stages + "]\n", {}, registry, environment).messages;
  };
  CHECK(
      told("demo.a, demo.b, demo.c, demo.d, demo.e, demo.e") ==
      Lines{"p.yaml:3:8: error: 5 stages (demo.a, demo.b, demo.c, demo.d and 1 more) need 'bodies', 'edges', 'corners', 'density' "
            "and 1 more, which are not known here: the scene has no bodies"});
  CHECK(told("demo.a, demo.b") ==
        Lines{"p.yaml:3:8: error: 2 stages (demo.a, demo.b) need 'bodies', which is not known here: the scene has no bodies"});
  CHECK(told("demo.e").at(0).starts_with("p.yaml:3:8: error: demo.e needs 'edges', 'corners', 'density', 'weight', which are"));
}

TEST_CASE("everything wrong is said at once") {
  const Lines all = messages(
      "firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.lok\n  - demo.tuned: {speed: -1, sped: 2}\n  - demo.show\n"
      "frame:\n  - demo.copy: {bind: {z: x}}\n  - {repeat: {max: 3, until: {buffer: rset, below: 1}}, stages: "
      "[demo.measure]}\n");
  CHECK(all == Lines{"p.yaml:4:5: error: unknown stage 'demo.lok'; did you mean 'demo.look'?",
                     "p.yaml:5:25: error: speed must be between 0 and 10, not -1",
                     "p.yaml:5:29: error: demo.tuned has no parameter 'sped'; did you mean 'speed'?",
                     "p.yaml:8:24: error: demo.copy has no port 'z'; valid: x, y",
                     "p.yaml:9:30: error: no buffer 'rset' to watch; did you mean 'rest'?",
                     "p.yaml:6:5: error: demo.show reads 'y', which no stage of this pipeline writes; demo.copy would",
                     "p.yaml:9:66: warning: demo.measure writes 'rest', which no stage reads"});
}

}  // namespace
}  // namespace firn::test
