#include "config/reader.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;

TEST_CASE("a reader gives the values of a map") {
  const Node node = parse_good("d: 400\nn: 3\nb: true\nt: snow\nv: [1, 2, 3]\nc: wet\n");
  Diagnostics diagnostics;
  Reader reader(node, "a material", diagnostics);
  CHECK(reader.number("d", 1) == 400);
  CHECK(reader.required_number("d") == 400);
  CHECK(reader.integer("n", 1) == 3);
  CHECK(reader.boolean("b", false));
  CHECK(reader.text("t", "") == "snow");
  CHECK(reader.required_text("t") == "snow");
  CHECK(reader.vector3("v", {}) == Vector3{1, 2, 3});
  CHECK(reader.required_vector3("v") == Vector3{1, 2, 3});
  CHECK(reader.choice("c", {"wet", "dry"}, "dry") == "wet");
  CHECK(reader.has("d"));
  CHECK_FALSE(reader.has("x"));
  CHECK(&reader.node() == &node);
  reader.finish();
  CHECK(diagnostics.all().empty());
}

TEST_CASE("a missing key leaves the fallback, without an error") {
  const Node node = parse_good("{}");
  Diagnostics diagnostics;
  Reader reader(node, "a material", diagnostics);
  CHECK(reader.number("d", 1.5) == 1.5);
  CHECK(reader.number("d", -1, {0}) == -1);
  CHECK(reader.integer("n", 7) == 7);
  CHECK(reader.boolean("b", true));
  CHECK(reader.text("t", "snow") == "snow");
  CHECK(reader.vector3("v", {1, 2, 3}) == Vector3{1, 2, 3});
  CHECK(reader.choice("c", {"wet", "dry"}, "dry") == "dry");
  CHECK(reader.find("x") == nullptr);
  reader.finish();
  CHECK(diagnostics.all().empty());
}

TEST_CASE("a wrong value is reported and leaves the fallback") {
  const Node node = parse_good("d: x\nn: 1.5\nb: 1\nt: []\nv: 1\nc: wet\n");
  Diagnostics diagnostics;
  Reader reader(node, "a material", diagnostics);
  CHECK(reader.number("d", 1.5) == 1.5);
  CHECK(std::isnan(reader.required_number("d")));
  CHECK(reader.integer("n", 7) == 7);
  CHECK(reader.boolean("b", true));
  CHECK(reader.text("t", "snow") == "snow");
  CHECK(reader.required_text("t").empty());
  CHECK(reader.vector3("v", {1, 2, 3}) == Vector3{1, 2, 3});
  CHECK_FALSE(reader.required_vector3("v").has_value());
  CHECK(reader.choice("c", {"dry"}, "dry") == "dry");
  CHECK(diagnostics.all().size() == 9);
  reader.finish();
  CHECK(diagnostics.all().size() == 9);
}

TEST_CASE("a missing required key is an error at the map") {
  const Node node = parse_good("materials:\n  - {young: 1}\n");
  Diagnostics diagnostics;
  Reader reader(node.find("materials")->items[0], "a material", diagnostics);
  CHECK(std::isnan(reader.required_number("density")));
  CHECK(reader.required_text("name").empty());
  CHECK_FALSE(reader.required_vector3("size").has_value());
  CHECK(reader.require("shape") == nullptr);
  CHECK(texts(diagnostics) == std::vector<std::string>{"a.yaml:2:5: error: a material needs the key 'density'",
                                                       "a.yaml:2:5: error: a material needs the key 'name'",
                                                       "a.yaml:2:5: error: a material needs the key 'size'",
                                                       "a.yaml:2:5: error: a material needs the key 'shape'"});
}

TEST_CASE("the key of a value that is out of range stands in the error") {
  const Node node = parse_good("density: -4\n");
  Diagnostics diagnostics;
  Reader(node, "a material", diagnostics).number("density", 1, {0, std::numeric_limits<double>::infinity(), true});
  CHECK(texts(diagnostics) == std::vector<std::string>{"a.yaml:1:10: error: density must be greater than 0, not -4"});
}

TEST_CASE("finish reports every key that nobody asked for, with the nearest of those asked for") {
  const Node node = parse_good("density: 4\nyuong: 1\ncolour: red\n");
  Diagnostics diagnostics;
  Reader reader(node, "a material", diagnostics);
  reader.number("density", 1);
  reader.number("density", 1);
  reader.number("young", 1);
  reader.finish();
  CHECK(texts(diagnostics) == std::vector<std::string>{"a.yaml:2:1: error: a material has no key 'yuong'; did you mean 'young'?",
                                                       "a.yaml:3:1: error: a material has no key 'colour'; valid: density, young"});
}

TEST_CASE("what is no map is reported once and then reads as empty") {
  for (const char* text : {"[1]", "5", "null", "a:1"}) {
    const Node node = parse_good(text);
    Diagnostics diagnostics;
    Reader reader(node, "a material", diagnostics);
    CHECK(std::isnan(reader.required_number("density")));
    CHECK(reader.number("young", 5) == 5);
    CHECK_FALSE(reader.has("density"));
    reader.finish();
    REQUIRE(diagnostics.all().size() == 1);
    CHECK(diagnostics.all()[0].text.starts_with("a material must be a map of 'key: value', not "));
  }
  const Node node = parse_good("a:1");
  Diagnostics diagnostics;
  const Reader reader(node, "a material", diagnostics);
  CHECK(contains(diagnostics.all()[0].text, "is a space missing after ':'?"));
}
