#include "graph/types.h"

#include <set>

#include "graph/environment.h"
#include "graph/registry.h"
#include "tests/catch.h"
#include "tests/graph/made_up.h"

namespace firn::test {
namespace {

using namespace graph;
using enum ElementType;

TEST_CASE("element types have GLSL's names, and lie in memory as std430 says") {
  struct Row {
    ElementType type;
    const char* name;
    int components;
    std::uint64_t stride;
    Scalar scalar;
  };
  const std::vector<Row> rows{{float1, "float", 1, 4, Scalar::real},    {vec2, "vec2", 2, 8, Scalar::real},
                              {vec3, "vec3", 3, 16, Scalar::real},      {vec4, "vec4", 4, 16, Scalar::real},
                              {int1, "int", 1, 4, Scalar::integer},     {ivec2, "ivec2", 2, 8, Scalar::integer},
                              {ivec3, "ivec3", 3, 16, Scalar::integer}, {ivec4, "ivec4", 4, 16, Scalar::integer},
                              {uint1, "uint", 1, 4, Scalar::natural},   {uvec2, "uvec2", 2, 8, Scalar::natural},
                              {uvec3, "uvec3", 3, 16, Scalar::natural}, {uvec4, "uvec4", 4, 16, Scalar::natural},
                              {mat3, "mat3", 9, 48, Scalar::real},      {ElementType::rgba8, "rgba8", 4, 4, Scalar::byte},
                              {depth, "depth", 1, 4, Scalar::real}};
  CHECK(element_type_names().size() == rows.size());
  for (const Row& row : rows) {
    CAPTURE(row.name);
    CHECK(name(row.type) == row.name);
    CHECK(element_type(row.name) == row.type);
    CHECK(components(row.type) == row.components);
    CHECK(stride(row.type) == row.stride);
    CHECK(scalar(row.type) == row.scalar);
    CHECK(is_texel(row.type) == (row.type == rgba8 || row.type == depth));
  }
  CHECK_FALSE(element_type("vec5").has_value());
}

TEST_CASE("accesses and usages have names") {
  for (const std::string text : {"read", "write", "read_write", "accumulate"}) CHECK(name(access(text).value()) == text);
  for (const std::string text : {"storage", "uniform", "sampled", "image", "vertex", "indirect", "transfer", "host", "framebuffer"})
    CHECK(name(usage(text).value()) == text);
  CHECK_FALSE(access("readwrite").has_value());
  CHECK_FALSE(usage("").has_value());
}

TEST_CASE("what an access does to the content") {
  CHECK((reads(Access::read) && !writes(Access::read)));
  CHECK((!reads(Access::write) && writes(Access::write)));
  CHECK((reads(Access::read_write) && writes(Access::read_write)));
  CHECK((reads(Access::accumulate) && writes(Access::accumulate)));
}

TEST_CASE("values as texts") {
  CHECK(to_string(Value(0.25)) == "0.25");
  CHECK(to_string(Value(std::int64_t{-3})) == "-3");
  CHECK(to_string(Value(true)) == "true");
  CHECK(to_string(Value(std::string("cubic"))) == "cubic");
  CHECK(to_string(Value(Vector3{0, -9.81, 1e6})) == "[0, -9.81, 1e+06]");
}

TEST_CASE("the number of elements of a domain") {
  const Environment environment = made_up_environment();
  CHECK(element_count("points", environment) == 10);
  CHECK(element_count("4", environment) == 4);
  CHECK(element_count("0", environment) == 0);
  CHECK(element_count("points*3", environment) == 30);
  CHECK(element_count("12*3", environment) == 36);
  CHECK_FALSE(element_count("bodies", environment).has_value());
  CHECK_FALSE(element_count("bodies*2", environment).has_value());
  for (const char* wrong : {"", "points*", "points/0", "points*x", "points*2*2", "*2", "-1", "points -1", "1.5"}) {
    CAPTURE(wrong);
    CHECK_FALSE(element_count(wrong, environment).has_value());
  }
}

TEST_CASE("a divided domain is rounded up") {
  const Environment environment = made_up_environment();
  CHECK(element_count("points/10", environment) == 1);
  CHECK(element_count("points/9", environment) == 2);
  CHECK(element_count("points/256", environment) == 1);
  CHECK(element_count("0/256", environment) == 0);
}

TEST_CASE("a count above 2^53 is none") {
  Environment environment;
  environment.domains["many"] = {std::uint64_t{1} << 50, 0, 0};
  CHECK(element_count("many*8", environment) == std::uint64_t{1} << 53);
  CHECK_FALSE(element_count("many*9", environment).has_value());
  CHECK_FALSE(element_count("many*99999999999999999999", environment).has_value());
  CHECK_FALSE(element_count("18446744073709551615", environment).has_value());
  CHECK_FALSE(element_count("99999999999999999999", environment).has_value());
}

TEST_CASE("the base of a domain is its name") {
  CHECK(base_domain("points") == "points");
  CHECK(base_domain("points*64") == "points");
  CHECK(base_domain("points/256") == "points");
  CHECK(base_domain("12").empty());
  CHECK(base_domain("12*3").empty());
}

TEST_CASE("constants are found by name") {
  const Environment environment = made_up_environment();
  REQUIRE(environment.constant("gravity") != nullptr);
  CHECK(environment.constant("gravity")->type == vec3);
  CHECK(environment.constant("density") == nullptr);
}

TEST_CASE("a registry finds stages by name and refuses what is wrong") {
  Registry registry = made_up_registry();
  REQUIRE(registry.find("demo.fill") != nullptr);
  CHECK(registry.find("demo.fill")->spec.ports.at(0).name == "x");
  CHECK(registry.find("demo.nothing") == nullptr);
  const std::vector<std::string> names = registry.names();
  CHECK(std::ranges::is_sorted(names));
  CHECK(names.size() == registry.all().size());

  CHECK_THROWS_WITH(registry.add(stage("demo.fill", {port("x", Access::read)})), "stage demo.fill: is registered twice");
  StageSpec wrong = stage("demo.wrong", {port("x", Access::read)});
  wrong.doc = "";
  wrong.work = {HostWork{}};
  CHECK_THROWS_WITH(registry.add(wrong), "stage demo.wrong: has no doc; has host work, but no host stage");
  CHECK(registry.find("demo.wrong") == nullptr);
}

}  // namespace
}  // namespace firn::test
