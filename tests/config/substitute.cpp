#include <string>
#include <vector>

#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;

namespace {

struct Substituted {
  Node root;
  std::vector<std::string> errors;
};

Substituted substituted(const std::string& yaml, const std::string& parameters) {
  Substituted result{parse_good(yaml), {}};
  Diagnostics diagnostics;
  substitute(result.root, parse_good(parameters), diagnostics);
  result.errors = texts(diagnostics);
  return result;
}

}  // namespace

TEST_CASE("a scalar that is one parameter takes over its whole value and kind, but keeps its place") {
  const Substituted result =
      substituted("a: ${k}\nb: \"${list}\"\nc: [\"${text}\"]\nd: ${none}\n", "{k: 8, list: [1, {x: 2}], text: '8', none: null}");
  CHECK(result.errors.empty());
  CHECK(result.root.find("a")->scalar == "8");
  CHECK_FALSE(result.root.find("a")->quoted);
  CHECK(to_string(result.root.find("a")->place) == "a.yaml:1:4");
  const Node& list = *result.root.find("b");
  REQUIRE(list.kind == Node::Kind::sequence);
  CHECK(to_string(list.place) == "a.yaml:2:4");
  CHECK(to_string(list.items[1].find("x")->place) == "a.yaml:2:4");
  CHECK(result.root.find("c")->items[0].quoted);
  CHECK(result.root.find("d")->kind == Node::Kind::null);
}

TEST_CASE("inside of a text the text of a parameter is put in") {
  const Substituted result = substituted("a: out/${name}_${k}.png\nb: \"${k}${k}\"\nc: 0.${k}\n", "{k: 8, name: snow}");
  CHECK(result.errors.empty());
  CHECK(result.root.find("a")->scalar == "out/snow_8.png");
  CHECK(result.root.find("b")->scalar == "88");
  CHECK(result.root.find("b")->quoted);
  CHECK(result.root.find("c")->scalar == "0.8");
  CHECK_FALSE(result.root.find("c")->quoted);
}

TEST_CASE("$${ stands for ${, and other dollars for themselves") {
  const Substituted result = substituted("a: $${k}\nb: x$${k}${k}\nc: $5 $ $$ {}\nd: $$${k}\n", "{k: 8}");
  CHECK(result.errors.empty());
  CHECK(result.root.find("a")->scalar == "${k}");
  CHECK(result.root.find("b")->scalar == "x${k}8");
  CHECK(result.root.find("c")->scalar == "$5 $ $$ {}");
  CHECK(result.root.find("d")->scalar == "$${k}");
}

TEST_CASE("keys stay as they are") { CHECK(substituted("{\"${k}\": 1}", "{k: 8}").root.find("${k}") != nullptr); }

TEST_CASE("an unknown parameter is an error with the nearest name") {
  CHECK(substituted("a: ${densty}", "{density: 8}").errors ==
        std::vector<std::string>{"a.yaml:1:4: error: unknown parameter 'densty'; did you mean 'density'?"});
  CHECK(substituted("a: x${b}", "{density: 8, k: 1}").errors.at(0) ==
        "a.yaml:1:4: error: unknown parameter 'b'; valid: density, k");
  CHECK(substituted("a: ${b}", "null").errors.at(0) == "a.yaml:1:4: error: unknown parameter 'b'; there are no parameters");
  CHECK(substituted("a: ${}", "{k: 1}").errors.size() == 1);
  CHECK(substituted("[\"${b}\", \"${c}\"]", "{k: 1}").errors.size() == 2);
}

TEST_CASE("a ${ without } is an error") {
  const auto errors = substituted("a: x${k", "{k: 8}").errors;
  REQUIRE(errors.size() == 1);
  CHECK(contains(errors[0], "'}' is missing after '${' in 'x${k'"));
  CHECK(substituted("a: ${", "{k: 8}").errors.size() == 1);
}

TEST_CASE("a list, a map or nothing cannot be part of a text") {
  CHECK(contains(substituted("a: x${k}", "{k: [1]}").errors.at(0), "parameter 'k' is a list, so it cannot be part of a text"));
  CHECK(contains(substituted("a: x${k}", "{k: {a: 1}}").errors.at(0), "is a map"));
  CHECK(contains(substituted("a: x${k}", "{k: null}").errors.at(0), "is nothing"));
}

TEST_CASE("a parameter made of other parameters is an error") {
  CHECK(contains(substituted("a: ${k}", "{k: '${j}', j: 1}").errors.at(0), "a parameter cannot be made of others"));
  CHECK(contains(substituted("a: ${k}", "{k: ['${k}']}").errors.at(0), "a parameter cannot be made of others"));
}

TEST_CASE("many uses of a large parameter are stopped, with one error") {
  std::string large = "{k: [";
  for (int i = 0; i < 10'000; ++i) large += "1,";
  std::string uses = "[";
  for (int i = 0; i < 1'000; ++i) uses += "'${k}',";
  const auto errors = substituted(uses + "]", large + "]}").errors;
  REQUIRE(errors.size() == 1);
  CHECK(contains(errors[0], "more than 200000 values"));
}

TEST_CASE("the parameters may be part of the tree") {
  Node root = parse_good("parameters: {k: 8}\na: ${k}\n");
  Diagnostics diagnostics;
  substitute(root, *root.find("parameters"), diagnostics);
  CHECK(diagnostics.all().empty());
  CHECK(root.find("a")->scalar == "8");
}
