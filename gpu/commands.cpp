#include "gpu/commands.h"

#include "gpu/context.h"

namespace firn::gpu {

namespace {

// OpenGL's bits leave gaps, those of BarrierBit do not.
constexpr struct {
  BarrierBit bit;
  GLbitfield gl;
} barrier_bits[] = {
    {BarrierBit::vertex_attrib_array, GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT},
    {BarrierBit::element_array, GL_ELEMENT_ARRAY_BARRIER_BIT},
    {BarrierBit::uniform, GL_UNIFORM_BARRIER_BIT},
    {BarrierBit::texture_fetch, GL_TEXTURE_FETCH_BARRIER_BIT},
    {BarrierBit::shader_image_access, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT},
    {BarrierBit::command, GL_COMMAND_BARRIER_BIT},
    {BarrierBit::pixel_buffer, GL_PIXEL_BUFFER_BARRIER_BIT},
    {BarrierBit::texture_update, GL_TEXTURE_UPDATE_BARRIER_BIT},
    {BarrierBit::buffer_update, GL_BUFFER_UPDATE_BARRIER_BIT},
    {BarrierBit::framebuffer, GL_FRAMEBUFFER_BARRIER_BIT},
    {BarrierBit::shader_storage, GL_SHADER_STORAGE_BARRIER_BIT},
};

void bind_texture_unit(Context& context, std::vector<std::uint32_t>& points, std::uint32_t unit, GLenum target, std::uint32_t id) {
  if (is_bound(points, unit, id)) return;
  if (GLAD_GL_VERSION_4_5) {
    glBindTextureUnit(unit, id);
  } else {
    glActiveTexture(GL_TEXTURE0 + unit);
    context.check_told();  // else a unit too high would change the unit before
    glBindTexture(target, id);
  }
  context.check_told();
  note_bound(points, unit, id);
}

void bind_buffer(Context& context, std::vector<std::uint32_t>& points, std::uint32_t binding, GLenum target, std::uint32_t id) {
  if (is_bound(points, binding, id)) return;
  glBindBufferBase(target, binding, id);
  context.check_told();
  note_bound(points, binding, id);
}

}  // namespace

void memory_barrier(std::uint32_t bits) {
  GLbitfield gl = 0;
  for (const auto& [bit, gl_bit] : barrier_bits) {
    if (bits & static_cast<std::uint32_t>(bit)) gl |= gl_bit;
  }
  if (!gl) return;
  Context& context = current();
  glMemoryBarrier(gl);
  context.check_told();
}

void memory_barrier_all() {
  Context& context = current();
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  context.check_told();
}

void use(const Program& program) {
  Context& context = current();
  if (context.bindings.program == program.id() && program.id()) return;
  context.bindings.program = 0;
  glUseProgram(program.id());
  context.check_told();
  context.bindings.program = program.id();
}

void bind_storage(std::uint32_t binding, const Buffer& buffer) {
  Context& context = current();
  bind_buffer(context, context.bindings.storage, binding, GL_SHADER_STORAGE_BUFFER, buffer.id());
}

void bind_uniform(std::uint32_t binding, const Buffer& buffer) {
  Context& context = current();
  bind_buffer(context, context.bindings.uniform, binding, GL_UNIFORM_BUFFER, buffer.id());
}

void bind_texture(std::uint32_t unit, const BufferTexture& texture) {
  Context& context = current();
  bind_texture_unit(context, context.bindings.textures_buffer, unit, GL_TEXTURE_BUFFER, texture.id());
}

void bind_texture(std::uint32_t unit, const Texture& texture) {
  Context& context = current();
  bind_texture_unit(context, context.bindings.textures_2d, unit, GL_TEXTURE_2D, texture.id());
}

void bind_image(std::uint32_t unit, const Texture& texture) {
  Context& context = current();
  if (is_bound(context.bindings.images, unit, texture.id())) return;
  glBindImageTexture(unit, texture.id(), 0, GL_FALSE, 0, GL_READ_WRITE, gl_format(texture.format()).internal);
  context.check_told();
  note_bound(context.bindings.images, unit, texture.id());
}

void bind_indirect(const Buffer& buffer) {
  Context& context = current();
  if (context.bindings.indirect == buffer.id() && buffer.id()) return;
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer.id());
  context.check_told();
  context.bindings.indirect = buffer.id();
}

void forget_bindings() {
  Context& context = current();
  context.bindings = {};
  glBindVertexArray(context.vertex_array);
}

void dispatch(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  Context& context = current();
  glDispatchCompute(x, y, z);
  context.check_told();
}

void dispatch_indirect(std::uint64_t offset) {
  Context& context = current();
  glDispatchComputeIndirect(static_cast<GLintptr>(offset));
  context.check_told();
}

void copy(const Buffer& from, const Buffer& to, std::uint64_t bytes) {
  Context& context = current();
  glBindBuffer(GL_COPY_READ_BUFFER, from.id());
  bind_edited(context, to.id());
  glCopyBufferSubData(GL_COPY_READ_BUFFER, edit_point, 0, 0, static_cast<GLsizeiptr>(bytes));
  context.check_told();
}

}  // namespace firn::gpu
