#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/app/inputs.h"
#include "tests/catch.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::run_firn;
using firn::test::Words;

namespace {

// What bash offers for the last of `words`, with the program's completion loaded from `script`.
std::string offered(const std::string& script, const Words& words) {
  std::string line =
      "bash -c 'source \"$1\"; shift; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _firn; echo \"${COMPREPLY[*]}\"' -- ";
  line += script;
  for (const std::string& word : words) line += " '" + word + "'";
  FILE* pipe = popen(line.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string answer;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) answer += static_cast<char>(c);
  CHECK(pclose(pipe) == 0);
  return answer.substr(0, answer.find('\n'));
}

}  // namespace

TEST_CASE("inspect tells everything a stage's spec says, as text and as JSON", "[app]") {
  const Outcome plain = run_firn({"inspect", "heightfield.contour"}), json = run_firn({"inspect", "heightfield.contour", "--json"});
  REQUIRE(plain.status == 0);
  REQUIRE(json.status == 0);
  for (const char* fragment :
       {"Equation: [H 3.12-3.24] (docs/references.md says of which works)", "overlap", "cells", "m/s", "only where cells is active",
        "thesis or appendix", "from 1", "heightfield/contour.comp over cells, in groups of 64", "Used by: heightfield_contour"}) {
    INFO("expected: " << fragment);
    CHECK(plain.out.find(fragment) != std::string::npos);
  }
  const nlohmann::json spec = nlohmann::json::parse(json.out);
  const auto named = [](const nlohmann::json& list, const std::string& name) {
    const auto found = std::ranges::find_if(list, [&](const nlohmann::json& one) { return one.at("name") == name; });
    REQUIRE(found != list.end());
    return *found;
  };
  CHECK(spec.at("equation") == "[H 3.12-3.24]");
  const nlohmann::json velocity = named(spec.at("ports"), "body_velocity");
  CHECK(velocity.at("type") == "vec3");
  CHECK(velocity.at("domain") == "bodies");
  CHECK(velocity.at("access") == "read");
  CHECK(velocity.at("usage") == "storage");
  CHECK(velocity.at("unit") == "m/s");
  CHECK(velocity.at("optional") == false);
  CHECK(named(spec.at("ports"), "active_tiles").at("when").at("cells") == "active");
  CHECK(named(spec.at("parameters"), "k").at("default") == 8.0);
  CHECK(named(spec.at("parameters"), "k").at("min") == 1.0);
  CHECK(named(spec.at("parameters"), "direction").at("choices") == nlohmann::json({"thesis", "appendix"}));
  CHECK(spec.at("work").size() == 2);
  CHECK(spec.at("work")[0].at("dispatch") == "heightfield/contour.comp");
  const auto users = spec.at("used_by").get<Words>();
  CHECK(std::ranges::find(users, "heightfield_contour") != users.end());
  CHECK(std::ranges::find(users, "mpm_snow") == users.end());
}

TEST_CASE("inspect tells units of constants, faults, and who sets the time step", "[app]") {
  const nlohmann::json advect = nlohmann::json::parse(run_firn({"inspect", "mpm.advect", "--json"}).out);
  CHECK(advect.at("constants")[1].at("name") == "grid_cell");
  CHECK(advect.at("constants")[1].at("unit") == "m");
  CHECK(advect.at("faults").size() == 2);
  CHECK(advect.at("sets_time_step") == false);
  CHECK(nlohmann::json::parse(run_firn({"inspect", "mpm.time_step", "--json"}).out).at("sets_time_step") == true);
}

TEST_CASE("inspect --glsl prints the whole source of every kernel, includes and declarations as well", "[app]") {
  const Outcome sort = run_firn({"inspect", "mpm.sort", "--glsl"});
  REQUIRE(sort.status == 0);
  for (const char* fragment : {"// mpm/sort_begin.comp: ", "// mpm/sort_order.comp: ", "#version 430 core", "float grid_cell;",
                               "uint element_index()", "ivec3 cell_of(vec3 position)", "particle_rank[particle] = atomicAdd"}) {
    INFO("expected: " << fragment);
    CHECK(sort.out.find(fragment) != std::string::npos);
  }
  const auto scatter = [](const std::string& accumulate) {
    return run_firn({"inspect", "mpm.particles_to_grid", "--glsl", "--set", "accumulate=" + accumulate}).out;
  };
  CHECK(scatter("fixed").find("#define ACCUMULATE_FIXED 1") != std::string::npos);
  CHECK(scatter("float").find("#define ACCUMULATE_FIXED 0") != std::string::npos);
  const nlohmann::json draws = nlohmann::json::parse(run_firn({"inspect", "heightfield.underside", "--glsl", "--json"}).out);
  CHECK(draws.at("glsl").size() == 5);  // two draws of two shaders, and a kernel
}

TEST_CASE("inspect takes a stage that is a file", "[app]") {
  const Outcome melt = run_firn({"inspect", "pipelines/examples/melt.comp"});
  REQUIRE(melt.status == 0);
  CHECK(melt.out.find("kg/m2/K/day") != std::string::npos);
  CHECK(melt.out.find("examples/melt") != std::string::npos);
  CHECK(run_firn({"inspect", "pipelines/examples/melt.comp", "--glsl"}).out.find("lapse * (ground[cell]") != std::string::npos);
}

TEST_CASE("every stage can be inspected, with its source", "[app]") {
  for (const nlohmann::json& stage : nlohmann::json::parse(run_firn({"list", "--json"}).out)) {
    const std::string name = stage.at("name");
    const Outcome outcome = run_firn({"inspect", name, "--json", "--glsl"});
    INFO(name << "\n" << outcome.err);
    REQUIRE(outcome.status == 0);
    const nlohmann::json spec = nlohmann::json::parse(outcome.out);
    CHECK(spec.at("doc") == stage.at("doc"));
    bool on_device = false;
    for (const nlohmann::json& work : spec.at("work")) on_device |= !work.contains("host") && !work.contains("when");
    CHECK((!on_device || !spec.at("glsl").empty()));
  }
}

TEST_CASE("a stage that cannot be inspected is told with the nearest name", "[app]") {
  const Outcome outcome = run_firn({"inspect", "mpm.stres"});
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("there is no stage 'mpm.stres'; did you mean 'mpm.stress'?") != std::string::npos);
  CHECK(run_firn({"inspect", "mpm.sort", "--set", "k=3"}).status == 2);
}

TEST_CASE("bash completes verbs, options, choices, stages, pipelines and scenes", "[app]") {
  const Folder folder;
  const Outcome script = run_firn({"completion", "bash"});
  REQUIRE(script.status == 0);
  const std::string file = folder.write("firn.bash", script.out);
  CHECK(offered(file, {"firn", "insp"}) == "inspect");
  CHECK(offered(file, {"firn", ""}).find("run ") != std::string::npos);
  CHECK(offered(file, {"firn", "run", "mpm_s"}) == "mpm_snow");
  CHECK(offered(file, {"firn", "run", "mpm_snow", "--barr"}) == "--barriers");
  CHECK(offered(file, {"firn", "run", "mpm_snow", "--barriers", ""}) == "derived all");
  CHECK(offered(file, {"firn", "check", "mpm_snow", "--scene", "two_s"}) == "two_snowballs");
  CHECK(offered(file, {"firn", "inspect", "heightfield.conto"}) == "heightfield.contour");
  CHECK(offered(file, {"firn", "try", "mpm.so"}) == "mpm.sort");
  CHECK(offered(file, {"firn", "-q", "completion", ""}) == "bash zsh fish");
  folder.write("mine.yaml", "firn: 1\n");
  CHECK(offered(file, {"firn", "check", folder / "mi"}) == folder / "mine.yaml");
  CHECK(offered(file, {"firn", "nonsense", ""}).empty());
}

TEST_CASE("every verb is completed in every shell", "[app]") {
  const std::string help = run_firn({"--help"}).out;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    CAPTURE(shell);
    const Outcome script = run_firn({"completion", shell});
    CHECK(script.status == 0);
    for (const char* verb : {"run", "check", "list", "inspect", "try", "doctor", "bench", "profile", "completion", "test"}) {
      CAPTURE(verb);
      CHECK(help.find(verb) != std::string::npos);
      const std::string mark = std::string(shell) == "fish" ? std::string("-a ") + verb + " " : std::string("    ") + verb + ")\n";
      CHECK(script.out.find(mark) != std::string::npos);
    }
  }
  CHECK(run_firn({"completion", "bsh"}).err.find("did you mean 'bash'? valid: bash, zsh, fish") != std::string::npos);
}
