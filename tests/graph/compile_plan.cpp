#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/graph/made_up.h"
#include "tests/graph/plans.h"

// What a pipeline without errors becomes.

namespace firn::test {
namespace {

using graph::Value;

const graph::PlannedStage& stage_of(const graph::Plan& plan, const std::string& label) {
  const auto found = std::ranges::find(plan.stages, label, &graph::PlannedStage::label);
  REQUIRE(found != plan.stages.end());
  return *found;
}

const graph::PlannedBuffer& buffer_of(const graph::Plan& plan, const std::string& name) {
  REQUIRE(plan.buffer(name) >= 0);
  return plan.buffers[static_cast<std::size_t>(plan.buffer(name))];
}

TEST_CASE("stages run in the order of the file, with barriers where they are needed") {
  const auto [plan, lines] =
      compiled("firn: 1\nname: order\nsetup: [demo.fill]\nstep: [demo.move, demo.copy]\nframe: [demo.show]\n");
  CHECK(lines == Lines{});
  CHECK(plan.pipeline == "order");
  CHECK(text_of(plan, true) ==
        "setup demo.fill x:write:storage; step [shader_storage] demo.move x:read_write:storage; [shader_storage] demo.copy "
        "x:read:storage "
        "y:write:storage; frame [vertex_attrib_array] demo.show y:read:vertex;");
}

TEST_CASE("a plan with errors has no barriers and is not laid out") {
  const auto [plan, lines] = compiled("firn: 1\nsetup: [demo.fill, demo.move]\nstep: [nothing]\n");
  CHECK(lines.size() == 1);
  CHECK(plan.bytes == 0);
  CHECK(text_of(plan) == "setup demo.fill demo.move");
}

TEST_CASE("a port binds to the buffer of its own name, or to the one that bind names") {
  const auto [plan, lines] = compiled(
      "firn: 1\nsetup: [demo.fill, {demo.fill: {bind: {x: z}}}]\nstep: [demo.look, {demo.copy: {bind: {x: z, y: w}}}]\n"
      "frame: [{demo.show: {bind: {y: w}}}]\n");
  CHECK(lines == Lines{});
  CHECK(text_of(plan, true).find("demo.copy z:read:storage w:write:storage;") != std::string::npos);
  CHECK(plan.buffers.size() == 3);
}

TEST_CASE("buffers take type, domain, unit and size from their first port") {
  const auto [plan, lines] = compiled("firn: 1\nsetup: [demo.grid]\nstep:\n  - demo.fill\n  - demo.look\n");
  const graph::PlannedBuffer& height = buffer_of(plan, "height");
  CHECK(height.type == graph::ElementType::float1);
  CHECK(height.domain == "cells");
  CHECK(height.unit == "m");
  CHECK(height.count == 6);
  CHECK(height.bytes == 24);
  CHECK((height.width == 3 && height.height == 2));
  CHECK_FALSE(height.texture);
  CHECK(to_string(height.place).ends_with("p.yaml:2:9"));
  CHECK(buffer_of(plan, "x").bytes == 40);
  CHECK(plan.bytes == 64);
  CHECK(lines == Lines{"p.yaml:2:9: warning: demo.grid writes 'height', which no stage reads"});
}

TEST_CASE("parameters have their defaults, or the values given, of the kind declared") {
  const auto [plan, lines] = compiled(
      "firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.tuned\n"
      "  - demo.tuned: {speed: 3, turns: 8, wrap: true, kernel: cubic, push: [1, 2.5, -5], file: \"a b.npy\", as: other}\n");
  CHECK(lines == Lines{});
  CHECK(stage_of(plan, "demo.tuned").parameters == graph::ParameterValues{{"speed", 1.5},
                                                                          {"turns", std::int64_t{2}},
                                                                          {"wrap", false},
                                                                          {"kernel", std::string("linear")},
                                                                          {"push", graph::Vector3{0, -1, 0}},
                                                                          {"file", std::string("out.npy")}});
  CHECK(stage_of(plan, "other").parameters == graph::ParameterValues{{"speed", 3.0},
                                                                     {"turns", std::int64_t{8}},
                                                                     {"wrap", true},
                                                                     {"kernel", std::string("cubic")},
                                                                     {"push", graph::Vector3{1, 2.5, -5}},
                                                                     {"file", std::string("a b.npy")}});
}

TEST_CASE("ports and work whose condition does not hold are not in the plan") {
  const std::string start = "firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.choose";
  const auto fine = compiled(start + "\n");
  CHECK(text_of(fine.plan, true).ends_with("step [shader_storage] demo.choose x:read:storage fine:write:storage;"));
  CHECK(fine.messages == Lines{"p.yaml:4:5: warning: demo.choose writes 'fine', which no stage reads"});

  const auto coarse = compiled(start + ": {quality: coarse}\n");
  CHECK(coarse.plan.buffer("fine") == -1);
  CHECK(buffer_of(coarse.plan, "coarse").count == 3);
  const graph::StageSpec& spec = stage_of(coarse.plan, "demo.choose").spec;
  REQUIRE(spec.work.size() == 1);
  CHECK(std::get<graph::Dispatch>(spec.work[0]).kernel == "coarse.comp");

  CHECK(messages(start + ": {quality: coarse, bind: {fine: other}}\n").front() ==
        "p.yaml:4:43: error: demo.choose has port 'fine' only with other parameters");
}

TEST_CASE("a condition may look at a choice of the environment") {
  graph::Environment environment = made_up_environment();
  environment.choices["time_step"] = "auto";
  const auto [plan, lines] = compiled("firn: 1\nsetup: [demo.fill]\nstep: [demo.choose]\n", {}, made_up_registry(), environment);
  CHECK(stage_of(plan, "demo.choose").spec.work.size() == 2);
  // The second kernel uses x alone.
  CHECK(text_of(plan, true).ends_with("demo.choose x:read:storage fine:write:storage; demo.choose x:read:storage;"));
}

TEST_CASE("an optional port is bound where its buffer is there, or where bind asks for it") {
  const std::string end = "step: [demo.extra]\n";
  const auto alone = compiled("firn: 1\nsetup: [demo.fill]\n" + end);
  CHECK(alone.messages == Lines{});
  CHECK(stage_of(alone.plan, "demo.extra").buffers == std::vector<int>{0, -1});
  const auto windy = compiled("firn: 1\nsetup: [demo.fill, demo.blow]\n" + end);
  CHECK(windy.messages == Lines{});
  CHECK(stage_of(windy.plan, "demo.extra").buffers == std::vector<int>{0, 1});
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.extra: {bind: {wind: gale}}\n") ==
        Lines{"p.yaml:4:25: error: demo.extra reads 'gale', which no stage of this pipeline writes; bind the port to another "
              "buffer, or add "
              "a stage that writes it"});
}

TEST_CASE("an optional input is bound wherever in setup or step its buffer is written") {
  const auto bound = [](const std::string& yaml) {
    const auto [plan, lines] = compiled("firn: 1\n" + yaml);
    INFO(text_of(plan));
    return stage_of(plan, "demo.extra").buffers.at(1) >= 0;
  };
  CHECK(bound("setup: [demo.fill]\nstep: [demo.extra, demo.blow]\n"));
  CHECK(bound("setup: [demo.fill, demo.extra]\nstep: [demo.blow]\n"));
  CHECK(bound("setup: [demo.fill]\nstep: [demo.extra, {demo.fill: {bind: {x: wind}}}]\n"));
  CHECK_FALSE(bound("setup: [demo.fill]\nstep: [demo.extra, {demo.blow: {bind: {wind: gale}}}]\n"));
  CHECK_FALSE(bound("setup: [demo.fill]\nstep: [demo.extra, {demo.blow: {enable: false}}]\n"));
}

TEST_CASE("an input written later in the step waits for the step before") {
  CHECK(text_of(compiled("firn: 1\nsetup: [demo.fill]\nstep: [demo.extra, demo.blow]\n").plan) ==
        "setup demo.fill step [shader_storage] demo.extra [shader_storage] demo.blow");
}

TEST_CASE("an optional output that nobody reads costs neither memory nor a warning") {
  graph::Registry registry = made_up_registry();
  graph::StageSpec spec = stage("demo.tell", {port("x", graph::Access::read_write), port("speed", graph::Access::write)});
  spec.ports[1].optional = true;
  registry.add(spec);
  registry.add(stage("demo.hear", {port("speed", graph::Access::read)}));
  const auto told = [&](const std::string& yaml, const graph::Environment& environment = made_up_environment()) {
    const auto [plan, lines] = compiled("firn: 1\nsetup: [demo.fill]\nstep:\n" + yaml, {}, registry, environment);
    CHECK(lines == Lines{});
    CHECK((stage_of(plan, "demo.tell").buffers.at(1) >= 0) == (plan.buffer("speed") >= 0));
    return plan.buffer("speed") >= 0;
  };
  CHECK_FALSE(told("  - demo.tell\n"));
  CHECK_FALSE(told("  - demo.tell\n  - {demo.hear: {enable: false}}\n"));
  CHECK(told("  - demo.tell\n  - demo.hear\n"));
  CHECK(told("  - demo.tell\nframe: [demo.hear]\n"));
  graph::Environment environment = made_up_environment();
  environment.provided = {"speed"};
  CHECK(told("  - demo.tell\n", environment));
}

TEST_CASE("an optional output that ends a repeat is bound") {
  graph::Registry registry = made_up_registry();
  graph::StageSpec spec = stage("demo.solve", {port("x", graph::Access::read_write), port("rest", graph::Access::write, "1")});
  spec.ports[1].optional = true;
  registry.add(spec);
  const auto [plan, lines] = compiled(
      "firn: 1\nsetup: [demo.fill]\nstep:\n  - repeat: {max: 3, until: {buffer: rest, below: 1}}\n    stages: [demo.solve]\n", {},
      registry);
  CHECK(plan.buffer("rest") >= 0);
}

TEST_CASE("a disabled stage is checked, but not in the plan") {
  const auto [plan, lines] =
      compiled("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.move\n  - demo.tuned: {enable: false, speed: 1}\n");
  CHECK(lines == Lines{});
  CHECK(plan.stages.size() == 2);
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.move\n  - demo.tuned: {enable: false, speed: -1}\n").size() == 1);
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.move\n  - demo.tuned: {enable: false, bind: {q: x}}\n").size() == 1);
}

TEST_CASE("every is kept with the stage") {
  const auto [plan, lines] = compiled("firn: 1\nsetup: [demo.fill]\nstep: [{demo.move: {every: 5}}]\n");
  CHECK(stage_of(plan, "demo.move").every == 5);
  CHECK(stage_of(plan, "demo.fill").every == 1);
}

TEST_CASE("a repeat keeps its turns and watches its buffer") {
  const auto [plan, lines] = compiled(
      "firn: 1\nsetup: [demo.fill]\nstep:\n  - repeat: {max: 64, until: {buffer: rest, below: 1.0e-6}}\n    stages: [demo.move, "
      "demo.measure]\n  - repeat: 3\n    stages: [demo.move]\n");
  CHECK(lines == Lines{});
  CHECK(text_of(plan) ==
        "setup demo.fill step repeat 64 until rest { [shader_storage] demo.move [shader_storage] demo.measure "
        "[buffer_update] } repeat 3 { [shader_storage] demo.move#2 }");
  for (const graph::Op& op : plan.step)
    if (const auto* repeat = std::get_if<graph::Repeat>(&op.what); repeat != nullptr && repeat->until)
      CHECK(repeat->until->below == 1.0e-6);
}

TEST_CASE("until needs a buffer of numbers that the pipeline has, and a limit they can meet") {
  const auto with = [](const std::string& buffer, const std::string& below = "1") {
    graph::Registry registry = made_up_registry();
    registry.add(stage("demo.count", {port("left", graph::Access::write, "points", graph::ElementType::uint1)}));
    registry.add(stage("demo.aim", {port("aim", graph::Access::write, "points", graph::ElementType::vec3)}));
    return compiled("firn: 1\nsetup: [demo.fill, demo.aim]\nstep:\n  - repeat:\n      max: 3\n      until: {buffer: " + buffer +
                        ", below: " + below + "}\n    stages: [demo.move, demo.count]\n",
                    {}, registry)
        .messages;
  };
  const auto first = [](const Lines& lines) { return lines.empty() ? std::string{} : lines.front(); };
  CHECK(first(with("x")).find("error") == std::string::npos);
  CHECK(first(with("left")).find("error") == std::string::npos);
  CHECK(first(with("aim")) == "p.yaml:6:14: error: until needs a buffer of float, int or uint; 'aim' is vec3");
  CHECK(first(with("y")) == "p.yaml:6:14: error: no buffer 'y' to watch; valid: x, aim, left");
  CHECK(first(with("left", "0")) ==
        "p.yaml:6:14: error: no uint is below 0 and another is not; 'below' must lie in what 'left' can hold");
}

TEST_CASE("a repeat without stages that run is left out with its until") {
  const std::string text =
      "firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.move\n  - repeat: {max: 3, until: {buffer: rest, below: 1}}\n    stages: "
      "[demo.measure]\n";
  const auto [plan, lines] = compiled(text, {.set = {}, .disable = {"demo.measure"}, .replace = {}});
  CHECK(lines == Lines{});
  CHECK(plan.step.size() == 2);
}

TEST_CASE("a read before the first write, and a write that nobody reads, are warnings") {
  CHECK(messages("firn: 1\nstep:\n  - demo.look\n  - demo.fill\n") ==
        Lines{"p.yaml:3:5: warning: demo.look reads 'x' before any stage has written it: at first it reads zeros"});
  CHECK(messages("firn: 1\nsetup: [demo.fill]\nstep:\n  - demo.copy\n  - demo.copy\n") ==
        Lines{"p.yaml:4:5: warning: demo.copy writes 'y', which no stage reads"});
}

TEST_CASE("a stage that reads what it left in the step before is no reason for a warning") {
  graph::Registry registry = made_up_registry();
  graph::StageSpec spec = stage("demo.remember", {port("memory", graph::Access::read_write)});
  spec.work = {graph::Dispatch{.kernel = "look.comp", .over = "points", .uses = {{"memory", graph::Access::read}}},
               graph::Dispatch{.kernel = "write.comp", .over = "points", .uses = {{"memory", graph::Access::write}}}};
  registry.add(spec);
  CHECK(compiled("firn: 1\nstep: [demo.remember]\n", {}, registry).messages == Lines{});
}

TEST_CASE("a buffer that comes from or goes elsewhere needs no stage that writes or reads it") {
  graph::Environment environment = made_up_environment();
  environment.provided = {"x", "y"};
  const auto [plan, lines] = compiled("firn: 1\nstep: [demo.copy]\n", {}, made_up_registry(), environment);
  CHECK(lines == Lines{});
  CHECK(buffer_of(plan, "y").lifetime == graph::Lifetime::state);
  environment.provided = {"y"};
  CHECK(compiled("firn: 1\nstep: [demo.copy]\n", {}, made_up_registry(), environment).messages.size() == 1);
}

TEST_CASE("a buffer lives on between steps unless every step writes it first and only steps use it") {
  const auto lifetime = [](const std::string& yaml) { return buffer_of(compiled(yaml).plan, "y").lifetime; };
  const std::string start = "firn: 1\nsetup: [demo.fill]\nstep:\n";
  CHECK(lifetime(start + "  - demo.copy\n  - demo.show\n") == graph::Lifetime::scratch);
  CHECK(lifetime(start + "  - demo.show\n  - demo.copy\n") == graph::Lifetime::state);
  CHECK(lifetime(start + "  - demo.copy\nframe: [demo.show]\n") == graph::Lifetime::state);
  CHECK(lifetime(start + "  - demo.copy: {every: 2}\n  - demo.show\n") == graph::Lifetime::state);
  CHECK(lifetime("firn: 1\nsetup: [demo.fill, demo.copy]\nstep: [demo.show]\n") == graph::Lifetime::state);
}

TEST_CASE("buffers have storage of their own") {
  const graph::Plan plan = compiled("firn: 1\nsetup: [demo.fill]\nstep: [demo.copy]\nframe: [demo.show]\n").plan;
  CHECK(plan.buffers[0].storage != plan.buffers[1].storage);
  CHECK(plan.bytes == 80);
}

}  // namespace
}  // namespace firn::test
