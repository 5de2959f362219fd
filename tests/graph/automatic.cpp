// Choices that a pipeline leaves to the environment.

#include "graph/glsl.h"
#include "graph/single_use.h"
#include "tests/catch.h"
#include "tests/graph/made_up.h"

namespace firn::test {
namespace {

// Copies x to y in one of two ways, or as the environment says.
graph::Registry registry() {
  using enum graph::Access;
  graph::Registry made = made_up_registry();
  graph::StageSpec spec = stage("demo.either", {port("x", read), port("y", write)});
  spec.parameters = {{.name = "form",
                      .kind = graph::ParameterKind::choice,
                      .initial = std::string("auto"),
                      .choices = {"auto", "small", "subgroup"},
                      .doc = "which way"}};
  spec.work = {graph::Dispatch{.kernel = "small.comp", .over = "points", .when = {"form", "small"}},
               graph::Dispatch{.kernel = "large.comp", .over = "points", .when = {"form", "subgroup"}}};
  made.add(spec);
  return made;
}

struct Outcome {
  graph::Plan plan;
  std::vector<graph::AutomaticChoice> choices;
  std::string errors;
};

Outcome outcome_of(const std::string& options, const std::string& chosen) {
  const Folder folder;
  config::Diagnostics diagnostics;
  const graph::PipelineSpec pipeline = graph::load_pipeline(
      folder.write("p.yaml", "firn: 1\nstep: [demo.fill, {demo.either: " + options + "}, demo.show]\n"), {}, diagnostics);
  graph::Environment environment = made_up_environment();
  if (!chosen.empty()) environment.choices["form"] = chosen;
  Outcome result{graph::compile(pipeline, registry(), environment, diagnostics), {}, ""};
  result.choices = graph::automatic_choices(pipeline, registry(), environment);
  for (const config::Diagnostic& diagnostic : diagnostics.all())
    if (diagnostic.text.find("nothing here chooses") != std::string::npos) result.errors += diagnostic.text;
  return result;
}

// The kernels of demo.either.
std::string kernels(const graph::Plan& plan) {
  std::string names;
  for (const graph::PlannedStage& stage : plan.stages)
    if (stage.spec.name == "demo.either")
      for (const graph::Work& work : stage.spec.work) names += std::get<graph::Dispatch>(work).kernel;
  return names;
}

}  // namespace

TEST_CASE("auto becomes what the environment has chosen, and what the pipeline says stays") {
  const Outcome chosen = outcome_of("{}", "subgroup");
  CHECK(kernels(chosen.plan) == "large.comp");
  REQUIRE(chosen.choices.size() == 1);
  CHECK((chosen.choices[0].stage == "demo.either" && chosen.choices[0].parameter == "form"));
  CHECK((chosen.choices[0].value == "subgroup" && chosen.choices[0].chosen));
  const Outcome told = outcome_of("{form: small}", "subgroup");
  CHECK(kernels(told.plan) == "small.comp");
  REQUIRE(told.choices.size() == 1);
  CHECK((told.choices[0].value == "small" && !told.choices[0].chosen));
  CHECK(kernels(outcome_of("{form: auto}", "small").plan) == "small.comp");
}

TEST_CASE("auto that nothing chooses for is an error, not a stage without work") {
  for (const std::string chosen : {"", "middling"}) {
    CAPTURE(chosen);
    CHECK(outcome_of("{}", chosen).errors == "demo.either: 'form' is auto, but nothing here chooses for it; say what it is to be");
    CHECK(outcome_of("{form: small}", chosen).errors.empty());
  }
}

TEST_CASE("a stage in the form for subgroups, and no other, asks for their extension") {
  const auto prelude = [](const std::string& form, int size) {
    const graph::Plan plan = outcome_of("{form: " + form + "}", "").plan;
    return graph::compute_prelude(plan, 1, 0, {.subgroup_size = size});
  };
  const std::string asks = "#extension GL_KHR_shader_subgroup_basic : require\n#define FIRN_SUBGROUPS 1\n";
  CHECK(prelude("subgroup", 32).find(asks) != std::string::npos);
  CHECK(prelude("subgroup", 16).find(asks) != std::string::npos);
  CHECK(prelude("subgroup", 8).find("subgroup_basic") == std::string::npos);
  CHECK(prelude("small", 32).find("subgroup_basic") == std::string::npos);
}

}  // namespace firn::test
