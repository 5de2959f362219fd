#pragma once

// PNG files of any kind, as bytes.

#include <png.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace firn::test {

struct PngKind {
  int color = PNG_COLOR_TYPE_GRAY;
  int depth = 8;
  bool interlaced = false;
};

// `samples` row by row, channel by channel, each at most 2^depth - 1.
inline std::string png_bytes(const PngKind& kind, std::uint32_t width, std::uint32_t height, const std::vector<int>& samples) {
  const auto to_string = [](png_structp png, png_bytep data, std::size_t count) {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(data), count);
  };
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  std::string bytes;
  png_set_write_fn(png, &bytes, to_string, nullptr);
  png_set_IHDR(png, info, width, height, kind.depth, kind.color, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (kind.color == PNG_COLOR_TYPE_PALETTE) {  // index i: grey i * 50
    std::vector<png_color> palette;
    for (int i = 0; i < 5; ++i)
      palette.push_back({static_cast<png_byte>(i * 50), static_cast<png_byte>(i * 50), static_cast<png_byte>(i * 50)});
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  }
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info), per_row = samples.size() / height;
  std::vector<std::vector<png_byte>> rows(height, std::vector<png_byte>(row_bytes));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::vector<png_byte>& row = rows[i / per_row];
    const std::size_t at = i % per_row;
    const auto value = static_cast<unsigned>(samples[i]);
    if (kind.depth == 16) {
      row[2 * at] = static_cast<png_byte>(value >> 8);
      row[2 * at + 1] = static_cast<png_byte>(value & 255);
    } else if (kind.depth == 8) {
      row[at] = static_cast<png_byte>(value);
    } else {
      const std::size_t per_byte = 8 / static_cast<std::size_t>(kind.depth);
      const std::size_t shift = 8 - static_cast<std::size_t>(kind.depth) * (at % per_byte + 1);
      row[at / per_byte] = static_cast<png_byte>(row[at / per_byte] | (value << shift));
    }
  }
  std::vector<png_bytep> pointers;
  for (std::vector<png_byte>& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace firn::test
