#include <fmt/format.h>

#include <utility>

#include "gpu/context.h"
#include "gpu/resources.h"

namespace firn::gpu {

namespace {

void zero(std::uint64_t bytes) {
  if (bytes % 4 == 0) {
    glClearBufferData(edit_point, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  } else {
    glClearBufferData(edit_point, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
  }
}

void delete_buffer(std::uint32_t id) noexcept {
  Context* context = current_or_null();
  if (!id || !context) return;
  context->bindings.forget_buffer(id);
  glDeleteBuffers(1, &id);
}

void delete_texture(std::uint32_t id) noexcept {
  Context* context = current_or_null();
  if (!id || !context) return;
  context->bindings.forget_texture(id);
  glDeleteTextures(1, &id);
}

}  // namespace

Buffer::Buffer(std::uint64_t bytes, const std::string& label) : bytes_(bytes ? bytes : 16) {
  Context& context = current();
  context.check();
  glGenBuffers(1, &id_);
  try {
    bind_edited(context, id_);
    glBufferData(edit_point, static_cast<GLsizeiptr>(bytes_), nullptr, GL_DYNAMIC_COPY);
    check_allocation(context, "buffer", label, bytes_);
    zero(bytes_);
    name_object(GL_BUFFER, id_, label);
    check_allocation(context, "buffer", label, bytes_);
  } catch (...) {
    delete_buffer(id_);
    throw;
  }
}

Buffer::~Buffer() { delete_buffer(id_); }
Buffer::Buffer(Buffer&& other) noexcept : id_(std::exchange(other.id_, 0)), bytes_(std::exchange(other.bytes_, 0)) {}
Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void Buffer::upload(std::uint64_t offset, std::span<const std::byte> data) {
  if (data.empty()) return;
  Context& context = current();
  bind_edited(context, id_);
  glBufferSubData(edit_point, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()), data.data());
  context.check_quickly();
}

void Buffer::download(std::uint64_t offset, std::span<std::byte> data) const {
  if (data.empty()) return;
  Context& context = current();
  bind_edited(context, id_);
  glGetBufferSubData(edit_point, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()), data.data());
  context.check();
}

void Buffer::clear() {
  Context& context = current();
  bind_edited(context, id_);
  zero(bytes_);
  context.check();
}

BufferTexture::BufferTexture(const Buffer& buffer, TexelFormat format, const std::string& label, std::uint64_t bytes) {
  Context& context = current();
  context.check();
  const std::uint64_t texels = bytes / bytes_per_texel(format);
  const std::uint64_t most = context.info.limits.texture_buffer_texels;
  if (texels > most) {
    // OpenGL itself would hide the rest in silence.
    throw DeviceError(
        fmt::format("buffer texture '{}' has {} texels; {} reads {} at most", label, texels, context.info.name, most));
  }
  glGenTextures(1, &id_);
  try {
    glActiveTexture(context.edit_unit);
    glBindTexture(GL_TEXTURE_BUFFER, id_);
    if (bytes == buffer.bytes() || bytes == 0)
      glTexBuffer(GL_TEXTURE_BUFFER, gl_format(format).internal, buffer.id());
    else
      glTexBufferRange(GL_TEXTURE_BUFFER, gl_format(format).internal, buffer.id(), 0, static_cast<GLsizeiptr>(bytes));
    name_object(GL_TEXTURE, id_, label);
    context.check();
  } catch (...) {
    delete_texture(id_);
    throw;
  }
}

BufferTexture::~BufferTexture() { delete_texture(id_); }
BufferTexture::BufferTexture(BufferTexture&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
BufferTexture& BufferTexture::operator=(BufferTexture&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

}  // namespace firn::gpu
