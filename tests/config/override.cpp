#include <string>
#include <vector>

#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;

namespace {

using Path = std::vector<std::string>;

std::vector<std::string> errors_of_override(const std::string& words) {
  Diagnostics diagnostics;
  parse_override(words, diagnostics);
  return texts(diagnostics);
}

struct Overridden {
  Node root;
  std::vector<std::string> errors;
};

Overridden overridden(const std::string& yaml, const std::string& words) {
  Overridden result{parse_good(yaml), {}};
  Diagnostics diagnostics;
  const Override override = parse_override(words, diagnostics);
  REQUIRE_FALSE(diagnostics.has_errors());
  apply_override(result.root, override.path, override.value, override.place, diagnostics);
  result.errors = texts(diagnostics);
  return result;
}

const std::string yaml = "scene:\n  gravity: [0, -9.81, 0]\n  bodies:\n    - density: 400\n    - density: 300\nparameters:\n";

}  // namespace

TEST_CASE("the option --set splits its path at dots and reads its value as YAML") {
  Diagnostics diagnostics;
  const Override override = parse_override("scene.gravity=[0,-1.62,0]", diagnostics);
  CHECK(diagnostics.all().empty());
  CHECK(override.path == Path{"scene", "gravity"});
  REQUIRE(override.value.items.size() == 3);
  CHECK(override.value.items[1].scalar == "-1.62");
  CHECK(parse_override("k=true", diagnostics).value.scalar == "true");
  CHECK(parse_override("k={a: 1}", diagnostics).value.find("a")->scalar == "1");
  CHECK(parse_override("k='4'", diagnostics).value.quoted);
  CHECK(parse_override("k=null", diagnostics).value.kind == Node::Kind::null);
  CHECK(parse_override("file=a=b", diagnostics).value.scalar == "a=b");
  CHECK(diagnostics.all().empty());
}

TEST_CASE("everything of an override points at the word of the command line") {
  Diagnostics diagnostics;
  const Override override = parse_override("k={a: [1]}", diagnostics);
  CHECK(to_string(override.place) == "--set k={a: [1]}");
  CHECK(to_string(override.value.place) == "--set k={a: [1]}");
  CHECK(to_string(override.value.entries[0].place) == "--set k={a: [1]}");
  CHECK(to_string(override.value.find("a")->items[0].place) == "--set k={a: [1]}");
}

TEST_CASE("a --set that cannot be read is an error that shows the form") {
  const auto missing = errors_of_override("k 4");
  REQUIRE(missing.size() == 1);
  CHECK(missing[0].starts_with("--set k 4: error: '=' is missing; the form is path=value"));
  for (const char* words : {"=4", ".k=4", "k.=4", "a..b=4"}) {
    const auto errors = errors_of_override(words);
    REQUIRE(errors.size() == 1);
    CHECK(contains(errors[0], "path=value"));
  }
  CHECK(contains(errors_of_override("k=").at(0), "the value after '=' is missing"));
  CHECK(errors_of_override("k=[1, 2") ==
        std::vector<std::string>{"--set k=[1, 2: error: the value '[1, 2' is no YAML: ',' or ']' expected: the '[' of line 1, "
                                 "column 1 is still open"});
  CHECK(errors_of_override("k=#4").size() == 1);
}

TEST_CASE("an override replaces the value of a key, with its own place") {
  const Overridden applied = overridden(yaml, "scene.gravity=[0,-1.62,0]");
  CHECK(applied.errors.empty());
  const Node& gravity = *applied.root.find("scene")->find("gravity");
  CHECK(gravity.items[1].scalar == "-1.62");
  CHECK(to_string(gravity.items[1].place) == "--set scene.gravity=[0,-1.62,0]");
  CHECK(applied.root.find("scene")->entries.size() == 2);
}

TEST_CASE("an override finds list items by number, from 0") {
  const Overridden applied = overridden(yaml, "scene.bodies.1.density=250");
  CHECK(applied.errors.empty());
  CHECK(applied.root.find("scene")->find("bodies")->items[0].find("density")->scalar == "400");
  CHECK(applied.root.find("scene")->find("bodies")->items[1].find("density")->scalar == "250");
}

TEST_CASE("a missing last key is added, below nothing too, with the place of the override") {
  const Overridden applied = overridden(yaml, "scene.wind=3");
  CHECK(applied.errors.empty());
  CHECK(applied.root.find("scene")->find("wind")->scalar == "3");
  CHECK(to_string(applied.root.find("scene")->entries.back().place) == "--set scene.wind=3");
  const Overridden below_nothing = overridden(yaml, "parameters.k=4");
  CHECK(below_nothing.errors.empty());
  REQUIRE(below_nothing.root.find("parameters")->kind == Node::Kind::map);
  CHECK(below_nothing.root.find("parameters")->find("k")->scalar == "4");
}

TEST_CASE("any other missing step is an error with the nearest name") {
  CHECK(overridden(yaml, "scenes.gravity=1").errors ==
        std::vector<std::string>{"--set scenes.gravity=1: error: the file has no key 'scenes'; did you mean 'scene'?"});
  CHECK(overridden(yaml, "scene.bodys.0.density=1").errors ==
        std::vector<std::string>{"--set scene.bodys.0.density=1: error: 'scene' has no key 'bodys'; did you mean 'bodies'?"});
  CHECK(contains(overridden(yaml, "scene.x.y=1").errors.at(0), "'scene' has no key 'x'; valid: gravity, bodies"));
  CHECK(contains(overridden(yaml, "scene.bodies.2.density=1").errors.at(0),
                 "'scene.bodies' is a list and has no item '2'; a number from 0 to 1 is needed"));
  CHECK(contains(overridden(yaml, "scene.bodies.x.density=1").errors.at(0), "has no item 'x'"));
  CHECK(contains(overridden(yaml, "scene.bodies.-1=1").errors.at(0), "has no item '-1'"));
  CHECK(contains(overridden("a: []", "a.0=1").errors.at(0), "it is empty"));
  CHECK(contains(overridden(yaml, "scene.bodies.0.density.x=1").errors.at(0),
                 "'scene.bodies.0.density' is '400' and has nothing below it, so no 'x'"));
}

TEST_CASE("an override that fails leaves the tree as it was") {
  CHECK(same(overridden(yaml, "scene.bodys.0=1").root, parse_good(yaml)));
  CHECK(same(overridden(yaml, "parameters.a.b=1").root, parse_good(yaml)));
}

TEST_CASE("the value put in takes over the place given") {
  Node root = parse_good("a: 1");
  Diagnostics diagnostics;
  apply_override(root, {"a"}, parse_good("[1]"), {"sweep.yaml", 3, 4}, diagnostics);
  CHECK(diagnostics.all().empty());
  CHECK(to_string(root.find("a")->items.at(0).place) == "sweep.yaml:3:4");
}

TEST_CASE("an empty path is an error") {
  Node root = parse_good("a: 1");
  Diagnostics diagnostics;
  apply_override(root, {}, Node{}, {"--set", 0, 0}, diagnostics);
  CHECK(diagnostics.has_errors());
}
