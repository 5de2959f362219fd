#include "stages/png.h"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "stages/series.h"

namespace firn::stages {
namespace {

namespace fs = std::filesystem;

// What libpng calls and keeps during one picture. libpng is C: nothing may be thrown through it.
struct Writing {
  std::FILE* file = nullptr;
  int error = 0;  // errno of a write that failed
  std::string complaint;

  static void write(png_structp png, png_bytep data, std::size_t bytes) {
    auto& self = *static_cast<Writing*>(png_get_io_ptr(png));
    if (std::fwrite(data, 1, bytes, self.file) == bytes) return;
    self.error = errno;
    png_error(png, "write");
  }
  static void flush(png_structp) {}
  [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
    static_cast<Writing*>(png_get_error_ptr(png))->complaint = text;
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
};

// False where it failed; `writing` tells why. No C++ object lives across the jump.
bool encode(Writing& writing, png_structp png, png_infop info, const Picture& picture, int compression) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &writing, Writing::write, Writing::flush);
  png_set_compression_level(png, compression);
  // One filter that suits rendered pictures: trying all of them costs more time than it saves bytes.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, compression > 0 ? PNG_FILTER_SUB : PNG_FILTER_NONE);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  for (int row = 0; row < picture.height; ++row)
    png_write_row(png, picture.rgb.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) * 3);
  png_write_end(png, info);
  return true;
}

}  // namespace

Picture picture_of(std::span<const std::byte> rgba, int width, int height) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  if (rgba.size() != w * h * 4)
    throw std::logic_error(fmt::format("{} bytes are no {} x {} RGBA image", rgba.size(), width, height));
  Picture picture{width, height, std::vector<std::uint8_t>(w * h * 3)};
  std::uint8_t* to = picture.rgb.data();
  for (std::size_t row = h; row-- > 0;) {
    const std::byte* from = rgba.data() + row * w * 4;
    for (std::size_t x = 0; x < w; ++x, from += 4, to += 3)
      for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>(from[c]);
  }
  return picture;
}

void write_png(const fs::path& file, const Picture& picture, int compression) {
  write_stream_beside(file, [&](std::FILE* stream) {
    Writing writing{stream, 0, {}};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writing, Writing::on_error, Writing::on_warning);
    if (png == nullptr) fail_to_write(file, "libpng cannot be used");
    png_infop info = png_create_info_struct(png);
    const bool written = info != nullptr && encode(writing, png, info, picture, compression);
    png_destroy_write_struct(&png, info != nullptr ? &info : nullptr);
    if (!written) fail_to_write(file, writing.error != 0 ? std::strerror(writing.error) : writing.complaint);
  });
}

}  // namespace firn::stages
