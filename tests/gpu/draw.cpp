#include "tests/gpu/support.h"

using namespace firn::gpu;
using namespace firn::test;

namespace {

constexpr int size = 8;
constexpr std::size_t texel_count = 64;

Program draw_program(const Device& device, const std::string& vertex, const std::string& fragment) {
  const std::array shaders = {std::pair{ShaderKind::vertex, with_version(device, vertex)},
                              std::pair{ShaderKind::fragment, with_version(device, fragment)}};
  return Program(shaders, "draw");
}

// Two triangles over the whole target at the depth (0 to 1) and in the colour of `parameters` (binding 0), counter-clockwise.
Program full_screen(const Device& device) {
  return draw_program(device, R"(
    layout(std140, binding = 0) uniform Parameters { vec4 color; float depth; };
    void main() {
      const vec2 corners[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));
      gl_Position = vec4(corners[gl_VertexID], 2.0 * depth - 1.0, 1.0);
    })",
                      R"(
    layout(std140, binding = 0) uniform Parameters { vec4 color; float depth; };
    layout(location = 0) out vec4 result;
    void main() { result = color; })");
}

Buffer parameters(std::array<float, 4> color, float depth) {
  return buffer_of<float>({color[0], color[1], color[2], color[3], depth, 0, 0, 0});
}

std::vector<float> filled(std::array<float, 4> color) {
  std::vector<float> values;
  for (int texel = 0; texel < size * size; ++texel) values.insert(values.end(), color.begin(), color.end());
  return values;
}

struct Target {
  Texture color{size, size, TexelFormat::rgba32f, "colour"};
  Texture depth{size, size, TexelFormat::depth32f, "depth"};
  Framebuffer framebuffer = made();
  Framebuffer made() const {
    const Texture* const colors[] = {&color};
    return Framebuffer(colors, &depth, "target");
  }
};

}  // namespace

TEST_CASE("a triangle covers the lower left half, row 0 at the bottom") {
  const auto device = Device::open();
  const Texture color(size, size, TexelFormat::rgba8, "colour");
  const Texture* const colors[] = {&color};
  const Framebuffer target(colors, nullptr, "target");
  const Program program = draw_program(*device, R"(
    void main() {
      const vec2 corners[3] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(-1, 1));
      gl_Position = vec4(corners[gl_VertexID], 0.0, 1.0);
    })",
                                       R"(
    layout(location = 0) out vec4 result;
    void main() { result = vec4(1.0, 0.0, 1.0, 1.0); })");
  clear_color(target, 0, 0, 1, 0, 1);
  use(program);
  draw(target, {}, 3, 1);
  const std::vector<std::uint32_t> pixels = texels<std::uint32_t>(color);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      CAPTURE(x, y);
      if (x + y < size - 1) CHECK(pixels[y * size + x] == 0xffff00ffu);
      if (x + y > size - 1) CHECK(pixels[y * size + x] == 0xff00ff00u);
    }
  }
}

TEST_CASE("the depth test keeps the nearer colour, whatever the order") {
  const auto device = Device::open();
  const Target target;
  const Program program = full_screen(*device);
  const Buffer near = parameters({1, 0, 0, 1}, 0.25f), far = parameters({0, 1, 0, 1}, 0.75f);
  const bool near_first = GENERATE(true, false);
  const DrawState state{.depth_test = DepthTest::less, .depth_write = true};
  clear_color(target.framebuffer, 0, 0, 0, 0, 0);
  clear_depth(target.framebuffer, 1);
  use(program);
  bind_uniform(0, near_first ? near : far);
  draw(target.framebuffer, state, 6, 1);
  bind_uniform(0, near_first ? far : near);
  draw(target.framebuffer, state, 6, 1);
  CHECK(texels<float>(target.color) == filled({1, 0, 0, 1}));
  CHECK(texels<float>(target.depth)[0] == Approx(0.25));
}

TEST_CASE("without depth write the depth stays, and a clear after it still clears") {
  const auto device = Device::open();
  const Target target;
  clear_depth(target.framebuffer, 1);
  use(full_screen(*device));
  const Program program = full_screen(*device);
  const Buffer drawn = parameters({1, 0, 0, 1}, 0.25f);
  bind_uniform(0, drawn);
  use(program);
  draw(target.framebuffer, {.depth_test = DepthTest::less, .depth_write = false}, 6, 1);
  CHECK(texels<float>(target.depth)[0] == 1);
  clear_depth(target.framebuffer, 0.5f);
  CHECK(texels<float>(target.depth)[0] == 0.5f);
  draw(target.framebuffer, {.depth_test = DepthTest::less, .depth_write = false}, 6, 1);
  CHECK(texels<float>(target.depth)[0] == 0.5f);
}

TEST_CASE("depth tests compare as their names say") {
  const auto device = Device::open();
  const Target target;
  const Program program = full_screen(*device);
  const auto is_drawn = [&](DepthTest test, float depth) {
    clear_color(target.framebuffer, 0, 0, 0, 0, 0);
    clear_depth(target.framebuffer, 0.5f);
    const Buffer drawn = parameters({1, 1, 1, 1}, depth);
    use(program);
    bind_uniform(0, drawn);
    draw(target.framebuffer, {.depth_test = test, .depth_write = true}, 6, 1);
    return texels<float>(target.color)[0] == 1;
  };
  CHECK(is_drawn(DepthTest::off, 0.75f));
  CHECK(is_drawn(DepthTest::always, 0.75f));
  CHECK(is_drawn(DepthTest::less, 0.25f));
  CHECK_FALSE(is_drawn(DepthTest::less, 0.5f));
  CHECK(is_drawn(DepthTest::less_equal, 0.5f));
  CHECK_FALSE(is_drawn(DepthTest::less_equal, 0.75f));
}

TEST_CASE("blending follows its formula") {
  const auto device = Device::open();
  const Target target;
  const Program program = full_screen(*device);
  const auto blended = [&](Blend blend) {
    clear_color(target.framebuffer, 0, 0.5f, 1, 0, 0.5f);
    const Buffer drawn = parameters({1, 0, 0.5f, 0.25f}, 0);
    use(program);
    bind_uniform(0, drawn);
    draw(target.framebuffer, {.blend = blend}, 6, 1);
    return texels<float>(target.color);
  };
  CHECK(blended(Blend::off) == filled({1, 0, 0.5f, 0.25f}));
  CHECK(blended(Blend::alpha) == filled({0.625f, 0.75f, 0.125f, 0.625f}));
  CHECK(blended(Blend::additive) == filled({1.5f, 1, 0.5f, 0.75f}));
  CHECK(blended(Blend::minimum) == filled({0.5f, 0, 0, 0.25f}));
  CHECK(blended(Blend::maximum) == filled({1, 1, 0.5f, 0.5f}));
}

TEST_CASE("back faces are culled on demand, and a wireframe leaves the inside") {
  const auto device = Device::open();
  const Target target;
  const std::string fragment = "layout(location = 0) out vec4 result; void main() { result = vec4(1.0); }";
  const Program clockwise = draw_program(*device, R"(
    void main() {
      const vec2 corners[3] = vec2[](vec2(-3, -3), vec2(0, 6), vec2(3, -3));
      gl_Position = vec4(corners[gl_VertexID], 0.0, 1.0);
    })",
                                         fragment);
  const auto center = [&](const DrawState& state) {
    clear_color(target.framebuffer, 0, 0, 0, 0, 0);
    use(clockwise);
    draw(target.framebuffer, state, 3, 1);
    return texels<float>(target.color)[4 * (texel_count / 2 + size / 2)];
  };
  CHECK(center({}) == 1);
  CHECK(center({.cull_back = true}) == 0);
  CHECK(center({.wireframe = true}) == 0);
  CHECK(center({}) == 1);
}

TEST_CASE("instances, points of a given size, and patches are drawn") {
  const auto device = Device::open();
  const Target target;
  clear_color(target.framebuffer, 0, 0, 0, 0, 0);

  SECTION("one point of one texel per instance, on the diagonal") {
    const Program program = draw_program(*device, R"(
      void main() {
        gl_Position = vec4(vec2(gl_InstanceID * 2 + 1) / 8.0 - 1.0, 0.0, 1.0);
        gl_PointSize = gl_InstanceID == 4 ? 3.0 : 1.0;
      })",
                                         "layout(location = 0) out vec4 result; void main() { result = vec4(1.0); }");
    use(program);
    draw(target.framebuffer, {.topology = Topology::points}, 1, size);
    const std::vector<float> values = texels<float>(target.color);
    const auto at = [&](int x, int y) { return values[4 * static_cast<std::size_t>(y * size + x)]; };
    CHECK(at(0, 0) == 1);
    CHECK(at(7, 7) == 1);
    CHECK(at(0, 1) == 0);
    CHECK(at(5, 3) == 1);
    CHECK(at(6, 1) == 0);
  }
  SECTION("a patch of two vertices becomes a square") {
    const std::array shaders = {std::pair{ShaderKind::vertex, with_version(*device, "void main() { gl_Position = vec4(0.0); }")},
                                std::pair{ShaderKind::tessellation_control, with_version(*device, R"(
      layout(vertices = 2) out;
      void main() {
        gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
        gl_TessLevelOuter = float[4](2.0, 2.0, 2.0, 2.0);
        gl_TessLevelInner = float[2](2.0, 2.0);
      })")},
                                std::pair{ShaderKind::tessellation_evaluation, with_version(*device, R"(
      layout(quads) in;
      void main() { gl_Position = vec4(2.0 * gl_TessCoord.xy - 1.0, 0.0, 1.0); })")},
                                std::pair{ShaderKind::fragment, with_version(*device, R"(
      layout(location = 0) out vec4 result;
      void main() { result = vec4(1.0, 0.0, 0.0, 1.0); })")}};
    const Program program(shaders, "patches");
    use(program);
    draw(target.framebuffer, {.topology = Topology::patches, .patch_vertices = 2}, 2, 1);
    CHECK(texels<float>(target.color) == filled({1, 0, 0, 1}));
  }
}

TEST_CASE("an integer attachment is drawn beside a colour and cleared to an integer") {
  const auto device = Device::open();
  const Texture color(size, size, TexelFormat::rgba32f, "colour"), body(size, size, TexelFormat::r32ui, "body");
  const Texture marker(size, size, TexelFormat::r32i, "marker");
  const Texture* const colors[] = {&color, &body, &marker};
  const Framebuffer target(colors, nullptr, "target");
  clear_color(target, 1, 7, 0, 0, 0);
  clear_color(target, 2, -3, 0, 0, 0);
  CHECK(texels<std::uint32_t>(body) == std::vector<std::uint32_t>(texel_count, 7));
  CHECK(texels<std::int32_t>(marker) == std::vector<std::int32_t>(texel_count, -3));
  const Program program = draw_program(*device, R"(
    void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); })",
                                       R"(
    layout(location = 0) out vec4 color;
    layout(location = 1) out uint body;
    layout(location = 2) out int marker;
    void main() { color = vec4(0.5); body = 42u; marker = -42; })");
  use(program);
  draw(target, {}, 3, 1);
  CHECK(texels<std::uint32_t>(body) == std::vector<std::uint32_t>(texel_count, 42));
  CHECK(texels<std::int32_t>(marker) == std::vector<std::int32_t>(texel_count, -42));
  CHECK(texels<float>(color) == filled({0.5f, 0.5f, 0.5f, 0.5f}));
  CHECK_THROWS_AS(clear_color(target, 3, 0, 0, 0, 0), std::invalid_argument);
}

TEST_CASE("attachments of different sizes and framebuffers without any are errors") {
  const auto device = Device::open();
  const Texture color(8, 8, TexelFormat::rgba8, "colour"), depth(8, 4, TexelFormat::depth32f, "depth");
  const Texture* const colors[] = {&color};
  contains(message_of<std::invalid_argument>([&] { Framebuffer(colors, &depth, "picture"); }), "'picture'");
  CHECK_THROWS_AS(Framebuffer({}, nullptr, "empty"), std::invalid_argument);
}
