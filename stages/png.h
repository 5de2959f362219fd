#pragma once

// PNG files: pictures of 8-bit RGB, and 16-bit grey for numbers.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace firn::stages {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from top to bottom
};

// From the texels of an rgba8 image, whose row 0 is the lowest.
Picture picture_of(std::span<const std::byte> rgba, int width, int height);

// `compression`: 0 (fast) to 9 (small). Written beside `file` and renamed, so that `file` is whole or as it was.
// Throws std::runtime_error naming the file.
void write_png(const std::filesystem::path& file, const Picture& picture, int compression);

// Numbers as shades of grey, 16 bits each, rows from top to bottom.
struct Shades {
  int width = 0, height = 0;
  std::vector<std::uint16_t> values;
};
// The bytes of a PNG file, with texts in it: name and what it says. Throws std::runtime_error.
std::string png_of(const Shades& shades, const std::vector<std::pair<std::string, std::string>>& texts);

}  // namespace firn::stages
