#pragma once

// Owners of OpenGL objects (RAII, move only). All need a current Device.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace firn::gpu {

enum class TexelFormat { r32f, rg32f, rgba32f, r32i, rg32i, rgba32i, r32ui, rg32ui, rgba32ui, rgba8, depth32f };
int bytes_per_texel(TexelFormat format);

// A buffer object of fixed size, zero-filled. Sizes in bytes; a size of 0 is made 16 so that it can be bound.
// Throws DeviceError where memory runs out.
class Buffer {
 public:
  Buffer() = default;
  Buffer(std::uint64_t bytes, const std::string& label);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  void upload(std::uint64_t offset, std::span<const std::byte> data);
  void download(std::uint64_t offset, std::span<std::byte> data) const;  // waits for the work before it
  void clear();                                                          // all bytes 0

  [[nodiscard]] std::uint32_t id() const { return id_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  std::uint32_t id_ = 0;
  std::uint64_t bytes_ = 0;
};

// The first `bytes` of a buffer seen as a one-dimensional texture (texelFetch): the fast way to read on software renderers. The
// buffer must outlive it. Throws DeviceError where it has more texels than the device reads through a texture.
class BufferTexture {
 public:
  BufferTexture() = default;
  BufferTexture(const Buffer& buffer, TexelFormat format, const std::string& label, std::uint64_t bytes);
  BufferTexture(const Buffer& buffer, TexelFormat format, const std::string& label)
      : BufferTexture(buffer, format, label, buffer.bytes()) {}
  ~BufferTexture();
  BufferTexture(BufferTexture&& other) noexcept;
  BufferTexture& operator=(BufferTexture&& other) noexcept;
  [[nodiscard]] std::uint32_t id() const { return id_; }

 private:
  std::uint32_t id_ = 0;
};

// A 2-D texture without mipmaps, zero-filled. Row 0 of the data is the lowest row (OpenGL's order).
// Throws DeviceError where memory runs out or the size is beyond the device's limit.
class Texture {
 public:
  Texture() = default;
  Texture(int width, int height, TexelFormat format, const std::string& label);
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  void upload(std::span<const std::byte> data);
  [[nodiscard]] std::vector<std::byte> download() const;

  [[nodiscard]] std::uint32_t id() const { return id_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] TexelFormat format() const { return format_; }

 private:
  std::uint32_t id_ = 0;
  int width_ = 0, height_ = 0;
  TexelFormat format_ = TexelFormat::rgba8;
};

// Render targets of one draw. All attachments share one size and must outlive it.
// Throws DeviceError where the device cannot draw to this combination.
class Framebuffer {
 public:
  Framebuffer() = default;
  Framebuffer(std::span<const Texture* const> colors, const Texture* depth, const std::string& label);
  ~Framebuffer();
  Framebuffer(Framebuffer&& other) noexcept;
  Framebuffer& operator=(Framebuffer&& other) noexcept;
  [[nodiscard]] std::uint32_t id() const { return id_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] std::span<const TexelFormat> color_formats() const { return color_formats_; }

 private:
  std::uint32_t id_ = 0;
  int width_ = 0, height_ = 0;
  std::vector<TexelFormat> color_formats_;
};

}  // namespace firn::gpu
