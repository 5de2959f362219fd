#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <stdexcept>

#include "stages/png.h"

namespace firn::stages {
namespace {

// What libpng calls and keeps. libpng is C: nothing may be thrown through it.
struct Writing {
  std::string bytes, complaint;
  bool no_memory = false;

  static void write(png_structp png, png_bytep data, std::size_t count) {
    auto& self = *static_cast<Writing*>(png_get_io_ptr(png));
    try {
      self.bytes.append(reinterpret_cast<const char*>(data), count);
    } catch (const std::exception&) {
      self.no_memory = true;
    }
    if (self.no_memory) png_error(png, "no memory is left");
  }
  static void flush(png_structp) {}
  [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
    static_cast<Writing*>(png_get_error_ptr(png))->complaint = text;
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
};

// False where it failed. No C++ object lives across the jump.
bool encode(Writing& writing, png_structp png, png_infop info, const Shades& shades, std::vector<png_text>& texts,
            png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &writing, Writing::write, Writing::flush);
  png_set_compression_level(png, 3);
  png_set_IHDR(png, info, static_cast<png_uint_32>(shades.width), static_cast<png_uint_32>(shades.height), 16, PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

}  // namespace

std::string png_of(const Shades& shades, const std::vector<std::pair<std::string, std::string>>& texts) {
  const auto width = static_cast<std::size_t>(shades.width), height = static_cast<std::size_t>(shades.height);
  std::vector<png_byte> big_endian;
  big_endian.reserve(shades.values.size() * 2);
  for (const std::uint16_t value : shades.values) {
    big_endian.push_back(static_cast<png_byte>(value >> 8));
    big_endian.push_back(static_cast<png_byte>(value & 255));
  }
  std::vector<png_bytep> rows(height);
  for (std::size_t row = 0; row < height; ++row) rows[row] = big_endian.data() + row * width * 2;
  std::vector<std::pair<std::string, std::string>> own = texts;  // libpng wants them writable
  std::vector<png_text> chunks;
  for (auto& [name, text] : own) {
    png_text chunk{};
    chunk.compression = PNG_TEXT_COMPRESSION_NONE;
    chunk.key = name.data();
    chunk.text = text.data();
    chunk.text_length = text.size();
    chunks.push_back(chunk);
  }
  Writing writing;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writing, Writing::on_error, Writing::on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  const bool written = info != nullptr && encode(writing, png, info, shades, chunks, rows.data());
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::runtime_error(fmt::format("libpng cannot make the picture: {}", writing.complaint));
  return std::move(writing.bytes);
}

}  // namespace firn::stages
