#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "graph/glsl.h"
#include "tests/catch.h"
#include "tests/graph/made_up.h"

// The bytes of a stage's parameters lie where std140 puts the members that its kernels declare (OpenGL 4.3, 7.6.2.2): a scalar at
// multiples of 4 bytes, a vector of three at multiples of 16, filling 12.

namespace firn::test {
namespace {

using namespace graph;

template <typename T>
T at(const std::vector<std::byte>& bytes, std::size_t offset) {
  T value{};
  REQUIRE(offset + sizeof(T) <= bytes.size());
  std::memcpy(&value, &bytes[offset], sizeof(T));
  return value;
}

ParameterSpec number(const std::string& name, double value) { return {.name = name, .initial = value, .doc = "a number"}; }
ParameterSpec integer(const std::string& name, std::int64_t value) {
  return {.name = name, .kind = ParameterKind::integer, .initial = value, .doc = "a whole number"};
}
ParameterSpec vector(const std::string& name, const Vector3& value) {
  return {.name = name, .kind = ParameterKind::vector3, .initial = value, .doc = "a vector"};
}

Plan plan_with(std::vector<ParameterSpec> parameters, std::vector<std::string> constants, std::vector<Port> ports) {
  Plan plan;
  plan.environment = made_up_environment();
  plan.environment.constants.push_back({"cells_per_side", ElementType::ivec3, Vector3{3, 2, 1}, "1", "a count"});
  plan.environment.constants.push_back({"spacing", ElementType::float1, 0.25, "m", "a length"});
  plan.environment.constants.push_back({"seed", ElementType::uint1, std::int64_t{4000000000}, "1", "a seed"});
  PlannedStage& planned = plan.stages.emplace_back();
  for (const ParameterSpec& parameter : parameters) planned.parameters[parameter.name] = parameter.initial;
  planned.spec = stage("demo.one", std::move(ports));
  planned.spec.parameters = std::move(parameters);
  planned.spec.constants = std::move(constants);
  planned.buffers.assign(planned.spec.ports.size(), -1);
  return plan;
}

TEST_CASE("a vector begins at 16 bytes, and a number after it fills its gap") {
  const Plan plan = plan_with({number("a", 1.5), vector("v", {2, 3, 4}), number("b", 5.5), vector("w", {6, 7, 8}),
                               vector("u", {9, 10, 11}), integer("n", -12), number("c", 13.5)},
                              {}, {});
  const std::vector<std::byte> block = parameter_block(plan, 0);
  CHECK(at<float>(block, 0) == 1.5f);
  CHECK(at<float>(block, 16) == 2);
  CHECK(at<float>(block, 20) == 3);
  CHECK(at<float>(block, 24) == 4);
  CHECK(at<float>(block, 28) == 5.5f);
  CHECK(at<float>(block, 32) == 6);
  CHECK(at<float>(block, 48) == 9);
  CHECK(at<float>(block, 56) == 11);
  CHECK(at<std::int32_t>(block, 60) == -12);
  CHECK(at<float>(block, 64) == 13.5f);
  CHECK(block.size() == 80);
}

TEST_CASE("constants and sizes of domains follow the parameters") {
  const Plan plan = plan_with({number("a", 1.5)}, {"gravity", "cells_per_side", "spacing", "seed"},
                              {port("x", Access::read), port("h", Access::read, "cells*2"), port("k", Access::read, "4")});
  const std::vector<std::byte> block = parameter_block(plan, 0);
  CHECK(at<float>(block, 0) == 1.5f);
  CHECK(at<float>(block, 20) == -9.81f);
  CHECK(at<std::int32_t>(block, 32) == 3);
  CHECK(at<std::int32_t>(block, 40) == 1);
  CHECK(at<float>(block, 44) == 0.25f);
  CHECK(at<std::uint32_t>(block, 48) == 4000000000u);
  CHECK(at<std::uint32_t>(block, 52) == 6);   // cells_count
  CHECK(at<std::int32_t>(block, 56) == 3);    // cells_width
  CHECK(at<std::int32_t>(block, 60) == 2);    // cells_height
  CHECK(at<std::uint32_t>(block, 64) == 10);  // points_count
  CHECK(kernel_interface(plan, 0, 0, {})
            .declarations.find("layout(std140, binding = 0) uniform stage_parameters_block {\n"
                               "  float a;\n  vec3 gravity;\n  ivec3 cells_per_side;\n  float spacing;\n"
                               "  uint seed;\n  uint cells_count;\n  int cells_width;\n  int cells_height;\n"
                               "  uint points_count;\n};\n") != std::string::npos);
}

TEST_CASE("booleans, choices and paths are no members, and a stage without members has no block") {
  std::vector<ParameterSpec> parameters = parameters_of_all_kinds();
  std::erase_if(parameters, [](const ParameterSpec& p) {
    return p.kind != ParameterKind::boolean && p.kind != ParameterKind::choice && p.kind != ParameterKind::path;
  });
  const Plan plan = plan_with(parameters, {}, {});
  CHECK(parameter_block(plan, 0).empty());
  CHECK(kernel_interface(plan, 0, 0, {}).declarations.find("stage_parameters_block") == std::string::npos);
}

struct Member {
  std::string type, name;
  std::size_t offset;
};

// Offsets of the declared members by the rules of std140, read from the text that the kernel gets.
std::vector<Member> members_of(const std::string& declarations) {
  std::vector<Member> members;
  std::istringstream lines(declarations.substr(declarations.find("stage_parameters_block")));
  std::string line;
  std::getline(lines, line);
  std::size_t end = 0;
  while (std::getline(lines, line) && line != "};") {
    std::istringstream words(line);
    Member member;
    words >> member.type >> member.name;
    member.name.pop_back();  // ;
    const bool triple = member.type == "vec3" || member.type == "ivec3";
    const std::size_t alignment = triple ? 16 : 4;
    member.offset = (end + alignment - 1) / alignment * alignment;
    end = member.offset + (triple ? 12 : 4);
    members.push_back(member);
  }
  return members;
}

TEST_CASE("random parameters lie where their declarations put them") {
  const std::uint64_t first = seed();
  INFO("seed " << first);
  std::mt19937_64 random(first);
  for (int turn = 0; turn < 200; ++turn) {
    std::vector<ParameterSpec> parameters;
    const int count = 1 + static_cast<int>(random() % 12);
    for (int i = 0; i < count; ++i) {
      const std::string name = "p" + std::to_string(i);
      const double value = static_cast<double>(random() % 1000);
      const auto kind = random() % 3;
      parameters.push_back(kind == 0   ? number(name, value)
                           : kind == 1 ? integer(name, static_cast<std::int64_t>(value))
                                       : vector(name, {value, value + 1, value + 2}));
    }
    const Plan plan = plan_with(parameters, {}, {});
    const std::vector<std::byte> block = parameter_block(plan, 0);
    const std::vector<Member> members = members_of(kernel_interface(plan, 0, 0, {}).declarations);
    REQUIRE(members.size() == parameters.size());
    CHECK(block.size() % 16 == 0);
    for (std::size_t i = 0; i < members.size(); ++i) {
      CAPTURE(turn, members[i].name, members[i].offset);
      CHECK(members[i].name == parameters[i].name);
      const Value& value = parameters[i].initial;
      if (const auto* real = std::get_if<double>(&value)) CHECK(at<float>(block, members[i].offset) == static_cast<float>(*real));
      if (const auto* whole = std::get_if<std::int64_t>(&value)) CHECK(at<std::int32_t>(block, members[i].offset) == *whole);
      if (const auto* triple = std::get_if<Vector3>(&value))
        for (std::size_t c = 0; c < 3; ++c) CHECK(at<float>(block, members[i].offset + 4 * c) == static_cast<float>((*triple)[c]));
    }
  }
}

}  // namespace
}  // namespace firn::test
