#include <algorithm>
#include <limits>
#include <random>
#include <string>

#include "graph/stage_file.h"
#include "tests/catch.h"
#include "tests/graph/loaded.h"
#include "tests/graph/made_up.h"
#include "tests/graph/plans.h"

// Stages whose spec stands at the head of their shader.

namespace firn::test {
namespace {

const std::string blur = R"(// A licence may stand here.
/*
firn: 1
name: my_blur
doc: Smooths
equation: x' = x
ports:
  x: {type: float, domain: points, access: read_write, unit: m, doc: a port}
  wind: {type: vec3, domain: points, access: read, usage: sampled, unit: m/s, doc: another, optional: true}
parameters:
  radius: {default: 1.5, min: 0, max: 10, unit: m, doc: how far}
  turns: {kind: integer, default: 2, doc: how often}
  wrap: {kind: boolean, default: false, doc: whether}
  mode: {kind: choice, choices: [fine, coarse], default: fine, doc: which}
  push: {kind: vector3, default: [0, 1, 0], unit: m, doc: where to}
constants: [gravity]
faults: [not_a_number]
over: points
group: 128
*/
void main() {}
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = blur;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

Lines errors_of(const std::string& text) {
  const Folder folder;
  config::Diagnostics diagnostics;
  const auto spec = graph::read_stage_file(folder.write("b.comp", text), diagnostics);
  CHECK(spec.has_value() == !diagnostics.has_errors());
  return folder.texts(diagnostics);
}

TEST_CASE("the head of a shader is a whole spec") {
  const Folder folder;
  config::Diagnostics diagnostics;
  const std::filesystem::path file = folder.write("b.comp", blur);
  const auto spec = graph::read_stage_file(file, diagnostics);
  REQUIRE(folder.texts(diagnostics) == Lines{});
  REQUIRE(spec.has_value());
  CHECK(spec->name == "my_blur");
  CHECK(spec->doc == "Smooths");
  CHECK(spec->equation == "x' = x");
  REQUIRE(spec->ports.size() == 2);
  CHECK(spec->ports[0].access == graph::Access::read_write);
  CHECK(spec->ports[0].usage == graph::Usage::storage);
  CHECK(spec->ports[1].type == graph::ElementType::vec3);
  CHECK(spec->ports[1].usage == graph::Usage::sampled);
  CHECK(spec->ports[1].unit == "m/s");
  CHECK(spec->ports[1].optional);
  REQUIRE(spec->parameters.size() == 5);
  CHECK(graph::to_string(spec->parameters[0].initial) == "1.5");
  CHECK(spec->parameters[0].max == 10);
  CHECK(std::get<std::int64_t>(spec->parameters[1].initial) == 2);
  CHECK(spec->parameters[1].min == -std::numeric_limits<double>::infinity());
  CHECK(std::get<bool>(spec->parameters[2].initial) == false);
  CHECK(std::get<std::string>(spec->parameters[3].initial) == "fine");
  CHECK(std::get<graph::Vector3>(spec->parameters[4].initial) == graph::Vector3{0, 1, 0});
  CHECK(spec->constants == Lines{"gravity"});
  CHECK(spec->faults == std::vector{graph::Fault::not_a_number});
  REQUIRE(spec->work.size() == 1);
  const auto& dispatch = std::get<graph::Dispatch>(spec->work[0]);
  CHECK(dispatch.kernel == std::filesystem::absolute(file).string());
  CHECK(dispatch.over == "points");
  CHECK(dispatch.group == 128);
}

TEST_CASE("errors of a head have their places in the shader's file") {
  CHECK(errors_of(with("doc: Smooths", "dok: Smooths")) ==
        Lines{"b.comp:3:1: error: the head of a stage needs the key 'doc'",
              "b.comp:5:1: error: the head of a stage has no key 'dok'; did you mean 'doc'?"});
  CHECK(errors_of(with("firn: 1\n", "")) ==
        Lines{"b.comp:3:1: error: missing key 'firn': a stage's head begins with 'firn: 1', the version of its format"});
  CHECK(errors_of(with("type: vec3", "type: vec5")).front().starts_with("b.comp:9:16: error: type cannot be 'vec5'"));
  CHECK(errors_of(with("access: read,", "acess: read,")) ==
        Lines{"b.comp:9:9: error: port wind needs the key 'access'",
              "b.comp:9:38: error: port wind has no key 'acess'; did you mean 'access'?"});
  CHECK(errors_of(with("usage: sampled", "usage: framebuffer")).front().starts_with("b.comp:9:59: error: usage cannot be"));
  CHECK(errors_of(with("default: 1.5", "default: 15")) == Lines{"b.comp:11:21: error: default must be between 0 and 10, not 15"});
  CHECK(errors_of(with("default: fine", "default: fin")) ==
        Lines{"b.comp:14:58: error: default cannot be 'fin'; did you mean 'fine'?"});
  CHECK(errors_of(with("kind: boolean", "kind: bolean")).front() ==
        "b.comp:13:16: error: kind cannot be 'bolean'; did you mean 'boolean'?");
  CHECK(errors_of(with("[not_a_number]", "[nan]")).front().starts_with("b.comp:17:10: error: a fault cannot be 'nan'"));
  CHECK(errors_of(with("group: 128", "group: 4096")) == Lines{"b.comp:19:8: error: group must be between 1 and 1024, not 4096"});
  CHECK(errors_of(with("[gravity]", "gravity")) == Lines{"b.comp:16:12: error: constants must be a list of names, not 'gravity'"});
  CHECK(errors_of(with("name: my_blur", "name: [")).size() == 1);
}

TEST_CASE("what is wrong with a head as a spec is told at the port or parameter") {
  CHECK(errors_of(with("radius:", "dt:")) == Lines{"b.comp:11:3: error: parameter dt: its name is reserved"});
  CHECK(errors_of(with("wind:", "Wind:")) == Lines{"b.comp:9:3: error: port Wind: its name may hold a-z, 0-9 and _"});
  CHECK(errors_of(with("radius:", "x:")) == Lines{"b.comp:11:3: error: parameter x: the name is taken"});
}

// Of the places of errors, sorted: "9:16".
Lines places_of(const std::string& text) {
  Lines places;
  for (const std::string& line : errors_of(text)) {
    REQUIRE(line.starts_with("b.comp:"));
    places.push_back(line.substr(7, line.find(": error") - 7));
  }
  std::ranges::sort(
      places, {}, [](const std::string& place) { return std::stod(place) * 1000 + std::stod(place.substr(place.find(':') + 1)); });
  return places;
}

std::string with_all(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = blur;
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST_CASE("all errors of a head are found in one pass") {
  CHECK(places_of(with_all({{"type: vec3", "type: vec5"}, {"default: 1.5", "default: up"}, {"over: points", "ovr: points"}})) ==
        Lines{"3:1", "9:16", "11:21", "18:1"});
}

TEST_CASE("what is wrong with values and what is wrong with the spec that they make is told at once") {
  const std::string text = with_all({{"doc: Smooths", "doc: ''"},
                                     {"wind:", "Wind:"},
                                     {"type: vec3", "type: vec5"},
                                     {"domain: points, access: read,", "domain: points*x, access: rid,"},
                                     {"radius:", "dt:"},
                                     {"turns: {kind: integer, default: 2", "x: {kind: integer, default: two"},
                                     {"[gravity]", "[gravity, gravity, wrap]"},
                                     {"group: 128", "group: 4096"}});
  CHECK(places_of(text) == Lines{"5:6", "9:3", "9:16", "9:30", "9:48", "11:3", "12:3", "12:31", "16:22", "16:31", "19:8"});
}

TEST_CASE("a mistake of a head brings no error that only follows from it") {
  CHECK(errors_of(with("usage: sampled", "usage: smpled")).size() == 1);
  CHECK(errors_of(with_all({{"type: vec3", "type: rgba8"}, {"usage: sampled", "usage: imge"}})).size() == 1);
  CHECK(errors_of(with_all({{"type: vec3", "type: rgba8"}, {"usage: sampled", "usage: storage"}})) ==
        Lines{"b.comp:9:16: error: port wind: rgba8 is only in textures"});
  CHECK(errors_of(with("kind: boolean", "kind: bolean")).size() == 1);
  CHECK(errors_of(with("{kind: boolean, default: false, doc: whether}", "false")) ==
        Lines{"b.comp:13:9: error: parameter wrap must be a map of 'key: value', not 'false'"});
  CHECK(errors_of(with("{type: float, domain: points, access: read_write, unit: m, doc: a port}", "[float]")).size() == 1);
  CHECK(errors_of("/*\n- firn: 1\n*/\n").size() == 1);
  CHECK(errors_of(with("choices: [fine, coarse], ", "")) == Lines{"b.comp:14:9: error: parameter mode needs the key 'choices'"});
  CHECK(places_of(with_all({{"default: 1.5, min: 0", "default: up, min: low"}, {"max: 10", "max: high"}})) ==
        Lines{"11:21", "11:30", "11:40"});
  CHECK(errors_of(with("max: 10", "max: -10")) == Lines{"b.comp:11:31: error: min must be at most max, which is -10, not 0"});
  CHECK(errors_of(with("domain: points, access: read_write, unit: m, doc: a port", "access: read_write, unit: m, doc: a port")) ==
        Lines{"b.comp:8:6: error: port x needs the key 'domain'"});
}

TEST_CASE("where a head stops to be YAML, what stands before it is still read") {
  const Lines lines = errors_of(with_all({{"type: vec3", "type: vec5"}, {"doc: how often}", "doc: how: often}"}}));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].starts_with("b.comp:12:"));
  CHECK(lines[1].starts_with("b.comp:9:16: error: type cannot be 'vec5'"));
  CHECK(errors_of(with_all({{"doc: Smooths", "doc: Smooths\ndoc: Blurs"}, {"type: vec3", "type: vec5"}})).size() == 2);
}

TEST_CASE("a spoilt head is a spec or an error, whatever is wrong with it") {
  const std::uint64_t first = seed();
  INFO("seed " << first);
  std::mt19937_64 random(first);
  const auto below = [&](std::size_t limit) { return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random); };
  for (int i = 0; i < 1000; ++i) {
    std::string text = blur;
    for (std::size_t times = 1 + below(4); times > 0; --times) {
      const std::size_t at = below(text.size()), length = below(12);
      switch (below(3)) {
        case 0:
          text.erase(at, length);
          break;
        case 1:
          text[at] = static_cast<char>(below(256));
          break;
        default:
          text.insert(at, text.substr(below(text.size()), length));
          break;
      }
    }
    CAPTURE(text);
    errors_of(text);
  }
}

TEST_CASE("a shader without a head is an error that shows what one is") {
  const Lines lines = errors_of("void main() {}\n");
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].starts_with("b.comp: error: a stage's file begins with a comment that is its spec"));
  CHECK(errors_of("/* never closed").size() == 1);
  CHECK(errors_of("/**/").size() == 1);
}

TEST_CASE("a stage's file is looked for beside the pipeline, and goes by the name in its head") {
  const Folder folder;
  folder.write("deep/blur.comp", blur);
  folder.write("lib/blur.comp", with("my_blur", "other_blur"));
  folder.write("deep/p.yaml",
               "firn: 1\nstep:\n  - stage: ./blur.comp\n  - stage: ../lib/blur.comp\n    radius: 2\n  - ./blur.comp: {turns: 3}\n"
               "  - blur.comp\n");
  const auto [pipeline, lines] = loaded(folder, "deep/p.yaml", set({"my_blur#2.turns=4"}));
  CHECK(lines == Lines{});
  CHECK(text_of(pipeline.step) == "my_blur other_blur(radius=2) my_blur#2(stage=my_blur turns=4) my_blur#3(stage=my_blur)");
  CHECK(pipeline.stage_files.size() == 2);
}

TEST_CASE("a missing stage file and two files of one name are errors") {
  const Folder folder;
  folder.write("blur.comp", blur);
  folder.write("copy.comp", blur);
  folder.write("p.yaml", "firn: 1\nstep:\n  - stage: ./blr.comp\n");
  folder.write("q.yaml", "firn: 1\nstep:\n  - ./blur.comp\n  - ./copy.comp\n");
  CHECK(folder.shortened(loaded(folder, "p.yaml").messages.at(0)) == "p.yaml:3:12: error: no such stage file: 'blr.comp'");
  CHECK(loaded(folder, "q.yaml").messages ==
        Lines{"q.yaml:4:5: error: 'blur.comp' and 'copy.comp' both call their stage 'my_blur'"});
}

Lines compile_messages(const Folder& folder, const std::string& yaml) {
  config::Diagnostics diagnostics;
  const graph::PipelineSpec pipeline = graph::load_pipeline(folder.write("p.yaml", yaml), {}, diagnostics);
  const graph::Plan plan = graph::compile(pipeline, made_up_registry(), made_up_environment(), diagnostics);
  return folder.texts(diagnostics);
}

TEST_CASE("a stage from a file is planned and checked like any other") {
  const Folder folder;
  folder.write("blur.comp", blur);
  CHECK(compile_messages(folder, "firn: 1\nsetup: [demo.fill]\nstep:\n  - ./blur.comp: {radius: 3}\n") == Lines{});
  CHECK(compile_messages(folder, "firn: 1\nsetup: [demo.fill]\nstep:\n  - ./blur.comp: {radus: 3}\n")
            .at(0)
            .starts_with("p.yaml:4:19: error: my_blur has no parameter 'radus'; did you mean 'radius'?"));
  CHECK(compile_messages(folder, "firn: 1\nstep:\n  - ./blur.comp: {radius: 11, bind: {x: y}}\n") ==
        Lines{"p.yaml:3:27: error: radius must be between 0 and 10, not 11"});
  config::Diagnostics diagnostics;
  const graph::PipelineSpec pipeline = graph::load_pipeline(
      folder.write("p.yaml", "firn: 1\nsetup: [demo.fill]\nstep: [./blur.comp, demo.look]\n"), {}, diagnostics);
  CHECK(text_of(graph::compile(pipeline, made_up_registry(), made_up_environment(), diagnostics)) ==
        "setup demo.fill step [shader_storage] my_blur [shader_storage] demo.look");
}

TEST_CASE("a domain or constant that a head misspells is told where it stands, with the nearest one") {
  const Folder folder;
  folder.write("blur.comp", with("over: points", "over: pionts"));
  const std::string yaml = "firn: 1\nsetup: [demo.fill]\nstep: [./blur.comp]\n";
  CHECK(compile_messages(folder, yaml) ==
        Lines{"blur.comp:18:7: error: my_blur works on 'pionts', which is not known here; did you mean 'points'?"});
  folder.write("blur.comp", with("[gravity]", "[gravty]"));
  CHECK(compile_messages(folder, yaml) ==
        Lines{"blur.comp:16:13: error: my_blur needs 'gravty', which is not known here; did you mean 'gravity'?"});
  folder.write("blur.comp",
               with_all({{"[gravity]", "[gravty]"}, {"domain: points", "domain: pionts"}, {"over: points", "over: pionts/2"}}));
  CHECK(compile_messages(folder, "firn: 1\nsetup: [demo.fill]\nstep: [./blur.comp, ./blur.comp]\n") ==
        Lines{"blur.comp:16:13: error: my_blur needs 'gravty', which is not known here; did you mean 'gravity'?",
              "blur.comp:8:28: error: my_blur works on 'pionts', which is not known here; did you mean 'points'?",
              "blur.comp:18:7: error: my_blur works on 'pionts', which is not known here; did you mean 'points'?",
              "p.yaml:2:9: warning: demo.fill writes 'x', which no stage reads"});
}

TEST_CASE("a domain that the scene lacks is told where a stage's file is used, not in the file") {
  const Folder folder;
  folder.write("blur.comp", with("over: points", "over: bodies"));
  CHECK(compile_messages(folder, "firn: 1\nsetup: [demo.fill]\nstep: [./blur.comp]\n") ==
        Lines{"p.yaml:3:8: error: my_blur works on 'bodies', which is not known here: the scene has no bodies"});
}

TEST_CASE("a file may not call its stage as one of Firn's own is called") {
  const Folder folder;
  folder.write("blur.comp", with("my_blur", "demo.move"));
  CHECK(compile_messages(folder, "firn: 1\nsetup: [demo.fill]\nstep: [./blur.comp]\n") ==
        Lines{"p.yaml:3:8: error: the file of this stage calls it 'demo.move', as one of Firn's own is called"});
}

TEST_CASE("a stage whose head is wrong brings no error beside those of its head") {
  const Folder folder;
  folder.write("blur.comp", with("type: vec3", "type: vec5"));
  CHECK(compile_messages(folder, "firn: 1\nsetup: [demo.fill]\nstep: [./blur.comp, demo.look]\n").size() == 1);
}

}  // namespace
}  // namespace firn::test
