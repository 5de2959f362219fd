#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gpu/context.h"
#include "gpu/resources.h"

namespace firn::gpu {

namespace {

void delete_texture(std::uint32_t id) noexcept {
  Context* context = current_or_null();
  if (!id || !context) return;
  context->bindings.forget_texture(id);
  glDeleteTextures(1, &id);
}

void delete_framebuffer(std::uint32_t id) noexcept {
  Context* context = current_or_null();
  if (!id || !context) return;
  context->bindings.forget_framebuffer(id);
  glDeleteFramebuffers(1, &id);
}

void bind_for_edit(const Context& context, std::uint32_t id) {
  glActiveTexture(context.edit_unit);
  glBindTexture(GL_TEXTURE_2D, id);
}

// Storage comes undefined; a run must not depend on what was there. In bands of rows, to need little memory on the host.
void zero(int width, int height, TexelFormat format) {
  const GlFormat gl = gl_format(format);
  const std::size_t row_bytes = static_cast<std::size_t>(width) * bytes_per_texel(format);
  constexpr std::size_t band_bytes = 1 << 22;
  const int band = std::clamp(static_cast<int>(band_bytes / row_bytes), 1, height);
  const std::vector<std::byte> nothing(row_bytes * band);
  for (int row = 0; row < height; row += band) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, row, width, std::min(band, height - row), gl.format, gl.type, nothing.data());
  }
}

const char* incomplete_reason(GLenum status) {
  switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
      return "an attachment cannot be drawn to (its format, or no storage)";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
      return "it has no attachment";
    case GL_FRAMEBUFFER_UNSUPPORTED:
      return "the driver does not support this combination of formats";
    default:
      return "the driver refuses its attachments";
  }
}

}  // namespace

int bytes_per_texel(TexelFormat format) {
  switch (format) {
    case TexelFormat::r32f:
    case TexelFormat::r32i:
    case TexelFormat::r32ui:
    case TexelFormat::rgba8:
    case TexelFormat::depth32f:
      return 4;
    case TexelFormat::rg32f:
    case TexelFormat::rg32i:
    case TexelFormat::rg32ui:
      return 8;
    case TexelFormat::rgba32f:
    case TexelFormat::rgba32i:
    case TexelFormat::rgba32ui:
      return 16;
  }
  throw std::logic_error("unknown texel format");
}

GlFormat gl_format(TexelFormat format) {
  switch (format) {
    case TexelFormat::r32f:
      return {GL_R32F, GL_RED, GL_FLOAT};
    case TexelFormat::rg32f:
      return {GL_RG32F, GL_RG, GL_FLOAT};
    case TexelFormat::rgba32f:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case TexelFormat::r32i:
      return {GL_R32I, GL_RED_INTEGER, GL_INT};
    case TexelFormat::rg32i:
      return {GL_RG32I, GL_RG_INTEGER, GL_INT};
    case TexelFormat::rgba32i:
      return {GL_RGBA32I, GL_RGBA_INTEGER, GL_INT};
    case TexelFormat::r32ui:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case TexelFormat::rg32ui:
      return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT};
    case TexelFormat::rgba32ui:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
    case TexelFormat::rgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case TexelFormat::depth32f:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
  }
  throw std::logic_error("unknown texel format");
}

Texture::Texture(int width, int height, TexelFormat format, const std::string& label)
    : width_(width), height_(height), format_(format) {
  Context& context = current();
  context.check();
  if (width < 1 || height < 1)
    throw std::invalid_argument(fmt::format("texture '{}' of {} x {} texels: at least 1 x 1", label, width, height));
  const int largest = context.info.limits.texture_size;
  if (width > largest || height > largest) {
    throw DeviceError(fmt::format("texture '{}' of {} x {} texels: {} has {} x {} at most", label, width, height, context.info.name,
                                  largest, largest));
  }
  const std::uint64_t bytes = static_cast<std::uint64_t>(width) * height * bytes_per_texel(format);
  glGenTextures(1, &id_);
  try {
    bind_for_edit(context, id_);
    glTexStorage2D(GL_TEXTURE_2D, 1, gl_format(format).internal, width, height);
    check_allocation(context, "texture", label, bytes);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) glTexParameteri(GL_TEXTURE_2D, axis, GL_CLAMP_TO_EDGE);
    zero(width, height, format);
    name_object(GL_TEXTURE, id_, label);
    check_allocation(context, "texture", label, bytes);
  } catch (...) {
    delete_texture(id_);
    throw;
  }
}

Texture::~Texture() { delete_texture(id_); }
Texture::Texture(Texture&& other) noexcept
    : id_(std::exchange(other.id_, 0)),
      width_(std::exchange(other.width_, 0)),
      height_(std::exchange(other.height_, 0)),
      format_(other.format_) {}
Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(format_, other.format_);
  return *this;
}

void Texture::upload(std::span<const std::byte> data) {
  const std::size_t bytes = static_cast<std::size_t>(width_) * height_ * bytes_per_texel(format_);
  if (data.size() != bytes) {
    throw std::invalid_argument(
        fmt::format("{} bytes given to a texture of {} x {} texels, which takes {}", data.size(), width_, height_, bytes));
  }
  Context& context = current();
  bind_for_edit(context, id_);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, gl_format(format_).format, gl_format(format_).type, data.data());
  context.check();
}

std::vector<std::byte> Texture::download() const {
  std::vector<std::byte> data(static_cast<std::size_t>(width_) * height_ * bytes_per_texel(format_));
  Context& context = current();
  bind_for_edit(context, id_);
  glGetTexImage(GL_TEXTURE_2D, 0, gl_format(format_).format, gl_format(format_).type, data.data());
  context.check();
  return data;
}

Framebuffer::Framebuffer(std::span<const Texture* const> colors, const Texture* depth, const std::string& label) {
  Context& context = current();
  context.check();
  const Texture* first = colors.empty() ? depth : colors.front();
  if (!first) throw std::invalid_argument(fmt::format("framebuffer '{}' has no attachment", label));
  width_ = first->width();
  height_ = first->height();
  const auto expect_size = [&](const Texture& texture) {
    if (texture.width() == width_ && texture.height() == height_) return;
    throw std::invalid_argument(fmt::format("framebuffer '{}': attachments of {} x {} and {} x {} texels; all must be of one size",
                                            label, width_, height_, texture.width(), texture.height()));
  };
  for (const Texture* color : colors) {
    expect_size(*color);
    color_formats_.push_back(color->format());
  }
  if (depth) expect_size(*depth);

  glGenFramebuffers(1, &id_);
  try {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id_);
    context.bindings.framebuffer = id_;
    std::vector<GLenum> targets;
    for (const Texture* color : colors) {
      targets.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size()));
      glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, targets.back(), GL_TEXTURE_2D, color->id(), 0);
    }
    if (depth) glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth->id(), 0);
    glDrawBuffers(static_cast<GLsizei>(targets.size()), targets.data());
    name_object(GL_FRAMEBUFFER, id_, label);
    context.check();
    const GLenum status = glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
      throw DeviceError(
          fmt::format("framebuffer '{}' cannot be drawn to: {} (status {:#06x})", label, incomplete_reason(status), status));
    }
  } catch (...) {
    delete_framebuffer(id_);
    throw;
  }
}

Framebuffer::~Framebuffer() { delete_framebuffer(id_); }
Framebuffer::Framebuffer(Framebuffer&& other) noexcept
    : id_(std::exchange(other.id_, 0)),
      width_(std::exchange(other.width_, 0)),
      height_(std::exchange(other.height_, 0)),
      color_formats_(std::move(other.color_formats_)) {}
Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(color_formats_, other.color_formats_);
  return *this;
}

}  // namespace firn::gpu
