#include "graph/glsl.h"

#include <string>
#include <vector>

#include "tests/catch.h"
#include "tests/graph/made_up.h"

// What stands before a kernel's own text.

namespace firn::test {
namespace {

using namespace graph;
using enum Access;

// A plan of one stage, each port on a buffer of its own.
Plan plan_of(StageSpec spec) {
  Plan plan;
  plan.environment = made_up_environment();
  PlannedStage planned;
  for (const Port& port : spec.ports) {
    planned.buffers.push_back(port.optional ? -1 : static_cast<int>(plan.buffers.size()));
    if (port.optional) continue;
    PlannedBuffer& buffer = plan.buffers.emplace_back();
    buffer.name = port.name;
    buffer.type = port.type;
    buffer.count = element_count(port.domain, plan.environment).value();
    buffer.texture = is_texel(port.type) || port.usage == Usage::image || port.usage == Usage::framebuffer;
  }
  for (const ParameterSpec& parameter : spec.parameters) planned.parameters[parameter.name] = parameter.initial;
  planned.spec = std::move(spec);
  plan.stages.push_back(planned);
  return plan;
}

// The declaration of one port: the lines that name it.
std::string declared(const Port& port, const DeviceTraits& traits = {}) {
  const std::string text = kernel_interface(plan_of(stage("demo.one", {port})), 0, 0, traits).declarations;
  const std::size_t at = text.find("layout", text.find("clock_block"));
  return at == std::string::npos ? "" : text.substr(at, text.size() - at - 1);
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("storage ports are arrays, qualified by what is done to them") {
  for (const std::string& type : element_type_names()) {
    if (type == "rgba8" || type == "depth") continue;
    CAPTURE(type);
    const auto with = [&](Access access) { return declared(port("x", access, "points", element_type(type).value())); };
    CHECK(with(read) == "layout(std430, binding = 0) readonly buffer x_block { " + type + " x[]; };");
    CHECK(with(write) == "layout(std430, binding = 0) writeonly buffer x_block { " + type + " x[]; };");
    CHECK(with(read_write) == "layout(std430, binding = 0) buffer x_block { " + type + " x[]; };");
  }
}

TEST_CASE("accumulated ports are arrays of their scalars, as the device can add them") {
  const auto with = [](ElementType type, bool float_atomics) {
    return declared(port("x", accumulate, "points", type), {.float_atomics = float_atomics});
  };
  const std::string start = "layout(std430, binding = 0) coherent buffer x_block { ";
  for (const ElementType type : {ElementType::float1, ElementType::vec3, ElementType::mat3}) {
    CHECK(with(type, true) == start + "float x[]; };");
    CHECK(with(type, false) == start + "uint x[]; };");
  }
  CHECK(with(ElementType::ivec2, true) == start + "int x[]; };");
  CHECK(with(ElementType::uint1, true) == start + "uint x[]; };");
}

TEST_CASE("uniform ports are values, or arrays where there are several") {
  const auto with = [](ElementType type, const std::string& domain) {
    return declared(port("x", read, domain, type, Usage::uniform));
  };
  CHECK(with(ElementType::float1, "1") == "layout(std140, binding = 2) uniform x_block { float x; };");
  CHECK(with(ElementType::mat3, "1") == "layout(std140, binding = 2) uniform x_block { mat3 x; };");
  CHECK(with(ElementType::vec4, "points") == "layout(std140, binding = 2) uniform x_block { vec4 x[10]; };");
}

TEST_CASE("sampled buffers are read element by element through texels") {
  const auto with = [](ElementType type) { return declared(port("x", read, "points", type, Usage::sampled)); };
  const auto expected = [](const std::string& prefix, const std::string& type, const std::string& swizzle) {
    return "layout(binding = 0) uniform " + prefix + "samplerBuffer x_texels;\n" + type +
           " x_at(int index) { return texelFetch(x_texels, index)." + swizzle + "; }";
  };
  CHECK(with(ElementType::float1) == expected("", "float", "x"));
  CHECK(with(ElementType::vec2) == expected("", "vec2", "xy"));
  CHECK(with(ElementType::vec3) == expected("", "vec3", "xyz"));
  CHECK(with(ElementType::vec4) == expected("", "vec4", "xyzw"));
  CHECK(with(ElementType::ivec3) == expected("i", "ivec3", "xyz"));
  CHECK(with(ElementType::uint1) == expected("u", "uint", "x"));
  const std::string matrix = with(ElementType::mat3);
  for (const char* part : {"mat3 x_at(int index)", "3 * index)", "3 * index + 1)", "3 * index + 2)"}) CHECK(contains(matrix, part));
}

TEST_CASE("sampled textures are samplers") {
  CHECK(declared(port("x", read, "cells", ElementType::rgba8, Usage::sampled)) == "layout(binding = 0) uniform sampler2D x;");
  CHECK(declared(port("x", read, "cells", ElementType::depth, Usage::sampled)) == "layout(binding = 0) uniform sampler2D x;");
  Plan plan = plan_of(stage("demo.one", {port("x", read, "cells", ElementType::uint1, Usage::sampled)}));
  plan.buffers[0].texture = true;
  CHECK(contains(kernel_interface(plan, 0, 0, {}).declarations, "layout(binding = 0) uniform usampler2D x;\n"));
}

TEST_CASE("images have the format of their texture") {
  const auto with = [](ElementType type, Access access) { return declared(port("x", access, "cells", type, Usage::image)); };
  CHECK(with(ElementType::rgba8, write) == "layout(rgba8, binding = 0) writeonly uniform image2D x;");
  CHECK(with(ElementType::float1, read) == "layout(r32f, binding = 0) readonly uniform image2D x;");
  CHECK(with(ElementType::vec2, read) == "layout(rg32f, binding = 0) readonly uniform image2D x;");
  CHECK(with(ElementType::vec3, read_write) == "layout(rgba32f, binding = 0) uniform image2D x;");
  CHECK(with(ElementType::vec4, read_write) == "layout(rgba32f, binding = 0) uniform image2D x;");
  CHECK(with(ElementType::int1, write) == "layout(r32i, binding = 0) writeonly uniform iimage2D x;");
  CHECK(with(ElementType::uint1, accumulate) == "layout(r32ui, binding = 0) uniform uimage2D x;");
}

TEST_CASE("ports that shaders do not see are not declared") {
  for (const Usage usage : {Usage::vertex, Usage::indirect, Usage::transfer, Usage::host})
    CHECK(declared(port("x", read, "points", ElementType::uint1, usage)).empty());
}

TEST_CASE("each kind of binding counts for itself") {
  const Plan plan = plan_of(stage(
      "demo.many",
      {port("a", read), port("u", read, "1", ElementType::float1, Usage::uniform), port("b", write),
       port("s", read, "points", ElementType::float1, Usage::sampled), port("i", write, "cells", ElementType::vec4, Usage::image),
       port("v", read, "1", ElementType::float1, Usage::uniform), port("t", read, "points", ElementType::float1, Usage::sampled)}));
  const KernelInterface interface = kernel_interface(plan, 0, 0, {});
  std::vector<int> bindings;
  for (const PortBinding& binding : interface.ports) bindings.push_back(binding.binding);
  CHECK(bindings == std::vector<int>{0, 2, 1, 0, 0, 3, 1});
  CHECK(interface.storage_blocks == 2);
  CHECK(interface.fault_binding == -1);
  CHECK(interface.ports[4].texture);
  CHECK_FALSE(interface.ports[3].texture);
}

TEST_CASE("faults have a storage block after the others, with slots of their own for each stage") {
  StageSpec spec = stage("demo.faulty", {port("x", read)});
  spec.faults = {Fault::overflow};
  Plan plan = plan_of(spec);
  plan.stages.insert(plan.stages.begin(), plan.stages[0]);
  const KernelInterface interface = kernel_interface(plan, 1, 0, {});
  CHECK(interface.fault_binding == 1);
  CHECK(interface.storage_blocks == 2);
  CHECK(contains(interface.declarations, "binding = 1) coherent buffer fault_block"));
  CHECK(contains(interface.declarations, "2u * (3u + kind)"));
  CHECK_FALSE(contains(kernel_interface(plan_of(stage("demo.sound", {port("x", read)})), 0, 0, {}).declarations, "fault"));
}

TEST_CASE("choices, booleans and optional ports are known when kernels are compiled") {
  StageSpec spec = stage("demo.tuned", {port("x", read), port("wind", read, "bodies")});
  spec.ports[1].optional = true;
  spec.parameters = parameters_of_all_kinds();
  Plan plan = plan_of(spec);
  plan.stages[0].parameters["kernel"] = std::string("cubic");
  const std::string text = kernel_interface(plan, 0, 0, {}).declarations;
  CHECK(contains(text, "#define KERNEL_LINEAR 0\n#define KERNEL_CUBIC 1\n"));
  CHECK(contains(text, "const bool wrap = false;\n"));
  CHECK(contains(text, "#define HAS_WIND 0\n"));
  CHECK_FALSE(contains(text, "bodies_count"));
  CHECK_FALSE(contains(text, "HAS_X"));

  plan.environment.domains["bodies"] = {2, 0, 0};
  plan.buffers.emplace_back().name = "wind";
  plan.stages[0].buffers[1] = 1;
  CHECK(contains(kernel_interface(plan, 0, 0, {}).declarations, "#define HAS_WIND 1\n"));
}

TEST_CASE("colors of a draw have the place that the draw gives them, in fragment shaders only") {
  const auto target = [](const std::string& name, ElementType type) {
    return port(name, write, "cells", type, Usage::framebuffer);
  };
  StageSpec spec = stage("demo.draw", {target("normal", ElementType::vec4), target("color", ElementType::rgba8),
                                       target("depth", ElementType::depth), target("other", ElementType::rgba8)});
  spec.work = {Draw{.name = "d", .vertex = "v", .fragment = "f", .colors = {"color", "normal"}, .depth = "depth"}};
  const Plan plan = plan_of(spec);
  const std::string text = draw_prelude(plan, 0, 0, true, {});
  CHECK(contains(text, "#ifdef FIRN_FRAGMENT\nlayout(location = 0) out vec4 color;\n#endif\n"));
  CHECK(contains(text, "#ifdef FIRN_FRAGMENT\nlayout(location = 1) out vec4 normal;\n#endif\n"));
  CHECK_FALSE(contains(text, "out vec4 depth"));
  CHECK_FALSE(contains(text, "out vec4 other"));
  CHECK(text.starts_with("#version 430 core\n#define FIRN_FLOAT_ATOMICS 0\n#define FIRN_FRAGMENT 1\n"));
  CHECK_FALSE(contains(draw_prelude(plan, 0, 0, false, {}), "#define FIRN_FRAGMENT"));
}

TEST_CASE("a compute kernel begins with version, extensions and its group") {
  StageSpec spec = stage("demo.one", {port("x", read)});
  std::get<Dispatch>(spec.work[0]).group = 128;
  const Plan plan = plan_of(spec);
  CHECK(compute_prelude(plan, 0, 0, {})
            .starts_with("#version 430 core\n#define FIRN_FLOAT_ATOMICS 0\nlayout(local_size_x = 128) in;\n"));
  CHECK(compute_prelude(plan, 0, 0, {"#version 460", true})
            .starts_with("#version 460\n#extension GL_NV_shader_atomic_float : require\n#define FIRN_FLOAT_ATOMICS 1\n"));
  CHECK(contains(compute_prelude(plan, 0, 0, {}), "uint element_index()"));
}

TEST_CASE("work uses the ports it names as it says, or all ports as they are") {
  StageSpec spec = stage("demo.one", {port("a", read_write), port("b", read, "3", ElementType::uint1), port("c", write)});
  spec.work = {Dispatch{.kernel = "all", .over = "points"},
               Dispatch{.kernel = "some", .over = "points", .uses = {{"c", read}, {"a", write, Usage::sampled}}},
               Dispatch{.kernel = "counted", .over = "", .indirect = "b", .uses = {{"a", read}}},
               Dispatch{.kernel = "both", .over = "", .indirect = "b", .uses = {{"b", read}}}};
  const Plan plan = plan_of(spec);
  const auto used = [&](int work) {
    std::string text;
    for (const UsedPort& port : used_ports(plan.stages[0], plan.stages[0].spec.work[static_cast<std::size_t>(work)]))
      text += spec.ports[static_cast<std::size_t>(port.port)].name + ":" + std::string(name(port.access)) + ":" +
              std::string(name(port.usage)) + " ";
    return text;
  };
  CHECK(used(0) == "a:read_write:storage b:read:storage c:write:storage ");
  CHECK(used(1) == "c:read:storage a:write:sampled ");
  CHECK(used(2) == "a:read:storage b:read:indirect ");
  CHECK(used(3) == "b:read:storage b:read:indirect ");
}

TEST_CASE("an unbound port is used by nobody") {
  StageSpec spec = stage("demo.one", {port("a", read), port("wind", read)});
  spec.ports[1].optional = true;
  const Plan plan = plan_of(spec);
  CHECK(used_ports(plan.stages[0], plan.stages[0].spec.work[0]).size() == 1);
}

}  // namespace
}  // namespace firn::test
