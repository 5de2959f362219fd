#pragma once

// A small world of stages for tests of pipelines and plans: a grid of 6 cells (3 x 2), 10 points, no snow.

#include <string>
#include <utility>
#include <vector>

#include "graph/compile.h"
#include "graph/pipeline.h"
#include "tests/graph/folder.h"

namespace firn::test {

inline graph::Port port(std::string name, graph::Access access, graph::DomainText domain = "points",
                        graph::ElementType type = graph::ElementType::float1, graph::Usage usage = graph::Usage::storage) {
  return {.name = std::move(name),
          .type = type,
          .domain = std::move(domain),
          .access = access,
          .usage = usage,
          .unit = "m",
          .doc = "a port"};
}

// A stage with one kernel over the points that uses all ports.
inline graph::StageSpec stage(const std::string& name, std::vector<graph::Port> ports) {
  graph::StageSpec spec;
  spec.name = name;
  spec.doc = "a stage";
  spec.ports = std::move(ports);
  spec.work = {graph::Dispatch{.kernel = name + ".comp", .over = "points"}};
  return spec;
}

// Every kind of parameter.
inline std::vector<graph::ParameterSpec> parameters_of_all_kinds() {
  using enum graph::ParameterKind;
  return {
      {.name = "speed", .kind = number, .initial = 1.5, .min = 0, .max = 10, .unit = "m/s", .doc = "a number"},
      {.name = "turns", .kind = integer, .initial = std::int64_t{2}, .min = 1, .max = 8, .doc = "a whole number"},
      {.name = "wrap", .kind = boolean, .initial = false, .doc = "a boolean"},
      {.name = "kernel", .kind = choice, .initial = std::string("linear"), .choices = {"linear", "cubic"}, .doc = "a choice"},
      {.name = "push", .kind = vector3, .initial = graph::Vector3{0, -1, 0}, .min = -5, .max = 5, .unit = "m", .doc = "a vector"},
      {.name = "file", .kind = path, .initial = std::string("out.npy"), .doc = "a path"}};
}

inline graph::Registry made_up_registry() {
  using enum graph::Access;
  using graph::ElementType;
  using graph::Usage;
  graph::Registry registry;
  registry.add(stage("demo.fill", {port("x", write)}));
  registry.add(stage("demo.move", {port("x", read_write)}));
  registry.add(stage("demo.look", {port("x", read)}));
  registry.add(stage("demo.copy", {port("x", read), port("y", write)}));
  registry.add(stage("demo.show", {port("y", read, "points", ElementType::float1, Usage::vertex)}));
  registry.add(stage("demo.measure", {port("x", read), port("rest", write, "1")}));
  registry.add(stage("demo.grid", {port("height", write, "cells")}));
  registry.add(stage("demo.bodies", {port("pose", write, "bodies", ElementType::vec4), port("spin", write, "bodies")}));

  graph::StageSpec tuned = stage("demo.tuned", {port("x", read_write)});
  tuned.parameters = parameters_of_all_kinds();
  registry.add(tuned);

  graph::StageSpec chooser = stage("demo.choose", {port("x", read), port("fine", write), port("coarse", write, "points/4")});
  chooser.ports[1].when = {"quality", "fine"};
  chooser.ports[2].when = {"quality", "coarse"};
  chooser.parameters = {{.name = "quality",
                         .kind = graph::ParameterKind::choice,
                         .initial = std::string("fine"),
                         .choices = {"fine", "coarse"},
                         .doc = "how"}};
  chooser.work = {graph::Dispatch{.kernel = "fine.comp", .over = "points", .when = {"quality", "fine"}},
                  graph::Dispatch{.kernel = "coarse.comp", .over = "points", .when = {"quality", "coarse"}},
                  graph::Dispatch{.kernel = "timed.comp", .over = "points", .uses = {{"x", read}}, .when = {"time_step", "auto"}}};
  registry.add(chooser);

  graph::StageSpec extra = stage("demo.extra", {port("x", read_write), port("wind", read)});
  extra.ports[1].optional = true;
  registry.add(extra);
  registry.add(stage("demo.blow", {port("wind", write)}));
  graph::StageSpec needy = stage("demo.needy", {port("x", read_write)});
  needy.constants = {"gravity", "density"};
  registry.add(needy);
  return registry;
}

inline graph::Environment made_up_environment() {
  graph::Environment environment;
  environment.domains = {{"points", {10, 0, 0}}, {"cells", {6, 3, 2}}};
  environment.missing = {{"bodies", "the scene has no bodies"}, {"density", "the scene has no field"}};
  environment.constants = {{"gravity", graph::ElementType::vec3, graph::Vector3{0, -9.81, 0}, "m/s^2", "gravity"}};
  environment.choices = {{"time_step", "fixed"}};
  return environment;
}

struct Compiled {
  graph::Plan plan;
  Lines messages;  // of reading and of compiling; the file is called p.yaml
};

inline Compiled compiled(const std::string& yaml, const graph::Edits& edits = {},
                         const graph::Registry& registry = made_up_registry(),
                         const graph::Environment& environment = made_up_environment()) {
  const Folder folder;
  config::Diagnostics diagnostics;
  const graph::PipelineSpec pipeline = graph::load_pipeline(folder.write("p.yaml", yaml), edits, diagnostics);
  graph::Plan plan = graph::compile(pipeline, registry, environment, diagnostics);
  return {std::move(plan), folder.texts(diagnostics)};
}

inline Lines messages(const std::string& yaml, const graph::Edits& edits = {}) { return compiled(yaml, edits).messages; }

}  // namespace firn::test
