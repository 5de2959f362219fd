#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "gpu/commands.h"
#include "gpu/context.h"

namespace firn::gpu {

namespace {

GLenum primitive(Topology topology) {
  switch (topology) {
    case Topology::points:
      return GL_POINTS;
    case Topology::lines:
      return GL_LINES;
    case Topology::triangles:
      return GL_TRIANGLES;
    case Topology::triangle_strip:
      return GL_TRIANGLE_STRIP;
    case Topology::patches:
      return GL_PATCHES;
  }
  throw std::logic_error("unknown topology");
}

void enable(GLenum capability, bool on) { on ? glEnable(capability) : glDisable(capability); }

void set_depth(DepthTest test, bool write) {
  enable(GL_DEPTH_TEST, test != DepthTest::off);
  glDepthMask(write ? GL_TRUE : GL_FALSE);
  if (test == DepthTest::less) glDepthFunc(GL_LESS);
  if (test == DepthTest::less_equal) glDepthFunc(GL_LEQUAL);
  if (test == DepthTest::always) glDepthFunc(GL_ALWAYS);
}

void set_blend(Blend blend) {
  enable(GL_BLEND, blend != Blend::off);
  switch (blend) {
    case Blend::off:
      return;
    case Blend::alpha:
      glBlendEquation(GL_FUNC_ADD);
      glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
      return;
    case Blend::additive:
      glBlendEquation(GL_FUNC_ADD);
      glBlendFunc(GL_ONE, GL_ONE);
      return;
    case Blend::minimum:
      glBlendEquation(GL_MIN);
      return;
    case Blend::maximum:
      glBlendEquation(GL_MAX);
      return;
  }
}

constexpr std::uint64_t depth_write_bit = 1;

// Everything of the state that set_state() hands to OpenGL, as one number.
std::uint64_t packed(const DrawState& state) {
  const std::uint64_t flags =
      (state.depth_write ? depth_write_bit : 0u) | (state.wireframe ? 2u : 0u) | (state.cull_back ? 4u : 0u);
  return flags | static_cast<std::uint64_t>(state.depth_test) << 8 | static_cast<std::uint64_t>(state.blend) << 16;
}

void set_state(Context& context, const DrawState& state) {
  const std::uint64_t wanted = packed(state);
  if (context.bindings.draw_state_known && context.bindings.draw_state == wanted) return;
  set_depth(state.depth_test, state.depth_write);
  set_blend(state.blend);
  glPolygonMode(GL_FRONT_AND_BACK, state.wireframe ? GL_LINE : GL_FILL);
  enable(GL_CULL_FACE, state.cull_back);
  glCullFace(GL_BACK);
  context.bindings.draw_state = wanted;
  context.bindings.draw_state_known = true;
}

void set_viewport(Bindings& known, int width, int height) {
  if (known.viewport_width == width && known.viewport_height == height) return;
  glViewport(0, 0, width, height);
  known.viewport_width = width;
  known.viewport_height = height;
}

void set_patch(Bindings& known, int vertices) {
  if (known.patch_vertices == vertices) return;
  glPatchParameteri(GL_PATCH_VERTICES, vertices);
  known.patch_vertices = vertices;
}

void bind_target(Context& context, const Framebuffer& target) {
  if (context.bindings.framebuffer == target.id() && target.id()) return;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.id());
  context.bindings.framebuffer = target.id();
}

bool is_signed_integer(TexelFormat format) {
  return format == TexelFormat::r32i || format == TexelFormat::rg32i || format == TexelFormat::rgba32i;
}
bool is_unsigned_integer(TexelFormat format) {
  return format == TexelFormat::r32ui || format == TexelFormat::rg32ui || format == TexelFormat::rgba32ui;
}

// Clamped, as a conversion out of range is undefined; the largest floats below 2^31 and 2^32.
std::array<GLint, 4> as_signed(const std::array<float, 4>& value) {
  std::array<GLint, 4> result;
  std::transform(value.begin(), value.end(), result.begin(),
                 [](float v) { return static_cast<GLint>(std::clamp(v, -2147483648.0f, 2147483520.0f)); });
  return result;
}
std::array<GLuint, 4> as_unsigned(const std::array<float, 4>& value) {
  std::array<GLuint, 4> result;
  std::transform(value.begin(), value.end(), result.begin(),
                 [](float v) { return static_cast<GLuint>(std::clamp(v, 0.0f, 4294967040.0f)); });
  return result;
}

}  // namespace

void draw(const Framebuffer& target, const DrawState& state, std::uint32_t vertices, std::uint32_t instances) {
  if (!vertices || !instances) return;
  Context& context = current();
  bind_target(context, target);
  set_viewport(context.bindings, target.width(), target.height());
  set_state(context, state);
  if (state.topology == Topology::patches) set_patch(context.bindings, state.patch_vertices);
  glDrawArraysInstanced(primitive(state.topology), 0, static_cast<GLsizei>(vertices), static_cast<GLsizei>(instances));
  context.check_quickly();
}

void rehearse_draw(const Framebuffer& target, const DrawState& state) {
  const auto vertices = state.topology == Topology::patches ? static_cast<std::uint32_t>(state.patch_vertices) : 3u;
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 0, 0);
  draw(target, state, vertices, 1);
  glDisable(GL_SCISSOR_TEST);
}

void clear_color(const Framebuffer& target, int attachment, float r, float g, float b, float a) {
  const std::span<const TexelFormat> formats = target.color_formats();
  if (attachment < 0 || attachment >= static_cast<int>(formats.size())) {
    throw std::invalid_argument(fmt::format("colour attachment {} of a framebuffer with {}", attachment, formats.size()));
  }
  Context& context = current();
  bind_target(context, target);
  if (is_unsigned_integer(formats[attachment])) {
    glClearBufferuiv(GL_COLOR, attachment, as_unsigned({r, g, b, a}).data());
  } else if (is_signed_integer(formats[attachment])) {
    glClearBufferiv(GL_COLOR, attachment, as_signed({r, g, b, a}).data());
  } else {
    glClearBufferfv(GL_COLOR, attachment, std::array{r, g, b, a}.data());
  }
  context.check_quickly();
}

void clear_depth(const Framebuffer& target, float depth) {
  Context& context = current();
  bind_target(context, target);
  // The mask of the draws holds for clears too.
  if (!context.bindings.draw_state_known || !(context.bindings.draw_state & depth_write_bit)) glDepthMask(GL_TRUE);
  context.bindings.draw_state |= depth_write_bit;
  glClearBufferfv(GL_DEPTH, 0, &depth);
  context.check_quickly();
}

}  // namespace firn::gpu
