#include "scene/image.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "scene/npy.h"

namespace firn::scene {

namespace {

constexpr double most_pixels = 1 << 28;  // 16,384 x 16,384: a broken header must not take all memory

[[noreturn]] void fail(const std::string& name, const std::string& text) {
  throw std::runtime_error(fmt::format("{}: {}", name, text));
}

// What libpng calls and keeps during one picture. libpng is C: nothing may be thrown through it.
struct Reading {
  std::string_view bytes;
  std::size_t at = 0;
  char complaint[200] = {};

  png_uint_32 width = 0, height = 0;
  int channels = 0, depth = 0;
  std::size_t row_bytes = 0;

  static void read(png_structp png, png_bytep data, std::size_t count) {
    auto& self = *static_cast<Reading*>(png_get_io_ptr(png));
    if (count > self.bytes.size() - self.at) png_error(png, "the file is cut off");
    std::memcpy(data, self.bytes.data() + self.at, count);
    self.at += count;
  }
  [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
    auto& self = *static_cast<Reading*>(png_get_error_ptr(png));
    std::strncpy(self.complaint, text, sizeof(self.complaint) - 1);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
};

// The two halves of decoding, so that no C++ object lives across a jump. False where it failed.
bool decode_header(Reading& reading, png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &reading, Reading::read);
  png_read_info(png, info);
  reading.width = png_get_image_width(png, info);
  reading.height = png_get_image_height(png, info);
  png_set_expand(png);  // palettes to colours, fewer than 8 bits to 8, transparent colours to alpha
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  reading.channels = png_get_channels(png, info);
  reading.depth = png_get_bit_depth(png, info);
  reading.row_bytes = png_get_rowbytes(png, info);
  return true;
}
bool decode_rows(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

// Frees libpng's memory however the reading ends.
struct Decoder {
  png_structp png;
  png_infop info;
  explicit Decoder(Reading& reading)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &reading, Reading::on_error, Reading::on_warning)),
        info(png != nullptr ? png_create_info_struct(png) : nullptr) {}
  ~Decoder() { png_destroy_read_struct(&png, &info, nullptr); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
};

// One pixel of 1 to 4 channels: grey, grey and alpha, colour, colour and alpha.
double grey_of(const double* channels, int count) {
  const bool colour = count >= 3;
  // From green, so that equal channels give exactly their value.
  const double grey =
      colour ? channels[1] + 0.2126 * (channels[0] - channels[1]) + 0.0722 * (channels[2] - channels[1]) : channels[0];
  return count % 2 == 0 ? grey * channels[count - 1] : grey;
}

std::string read_bytes(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, "cannot be opened for reading");
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) fail(file, "cannot be read to its end");
  return bytes;
}

GreyImage read_array(const std::string& file) {
  const NpyHeader header = read_npy_header(file);
  if (header.shape.size() != 2 || header.count == 0)
    fail(file, fmt::format("an image must be an array of two dimensions [z, x], not of shape {}", to_string(header.shape)));
  if (static_cast<double>(header.count) > most_pixels)
    fail(file, fmt::format("an array of shape {} is too large for an image; at most 2^28 values", to_string(header.shape)));
  NpyArray array = read_npy(file);
  const auto width = static_cast<std::size_t>(array.shape[1]);
  for (std::size_t i = 0; i < array.values.size(); ++i)
    if (!std::isfinite(array.values[i]))
      fail(file, fmt::format("row {}, column {} is {}, but must be a finite number", i / width, i % width, array.values[i]));
  return {static_cast<int>(width), static_cast<int>(array.shape[0]), std::move(array.values)};
}

GreyImage read_floats(const std::string& file, int width, int height) {
  const std::string bytes = read_bytes(file);
  const std::size_t count = bytes.size() / sizeof(float);
  const auto side = static_cast<std::size_t>(std::llround(std::sqrt(static_cast<double>(count))));
  const bool fits = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) == count;
  if (count == 0 || bytes.size() % sizeof(float) != 0 || (!fits && side * side != count))
    fail(file, fmt::format("an .f32 file must hold {} x {} values of 4 bytes, or a square of them, not {} bytes", width, height,
                           bytes.size()));
  if (static_cast<double>(count) > most_pixels) fail(file, fmt::format("{} values are too many for an image; at most 2^28", count));
  GreyImage image{fits ? width : static_cast<int>(side), fits ? height : static_cast<int>(side), {}};
  for (std::size_t i = 0; i < count; ++i) {
    float value;
    std::memcpy(&value, bytes.data() + i * sizeof(value), sizeof(value));
    if (!std::isfinite(value))
      fail(file, fmt::format("value {} (row {}) is {}, but must be a finite number", i, i / static_cast<std::size_t>(image.width),
                             value));
    image.values.push_back(static_cast<double>(value));
  }
  return image;
}

}  // namespace

bool is_array(std::string_view file) { return file.ends_with(".npy") || file.ends_with(".f32"); }

GreyImage parse_png(std::string_view bytes, const std::string& name) {
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0)
    fail(name, "this is no PNG file; images are .png, or .npy of two dimensions");
  Reading reading{.bytes = bytes};
  const Decoder decoder(reading);
  if (decoder.info == nullptr) fail(name, "libpng cannot be used");
  if (!decode_header(reading, decoder.png, decoder.info)) fail(name, fmt::format("this PNG file is broken: {}", reading.complaint));
  if (static_cast<double>(reading.width) * reading.height > most_pixels)
    fail(name, fmt::format("a PNG file of {} x {} pixels is too large; at most 2^28", reading.width, reading.height));

  // Deflate makes 1 byte of at most 1032.
  if (reading.row_bytes * reading.height / 1032 > bytes.size())
    fail(name, fmt::format("this PNG file is cut off: {} x {} pixels do not fit into {} bytes", reading.width, reading.height,
                           bytes.size()));
  std::vector<png_byte> raw(reading.row_bytes * reading.height);
  std::vector<png_bytep> rows(reading.height);
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = raw.data() + row * reading.row_bytes;
  if (!decode_rows(decoder.png, rows.data())) fail(name, fmt::format("this PNG file is broken: {}", reading.complaint));

  GreyImage image{static_cast<int>(reading.width), static_cast<int>(reading.height), {}};
  image.values.reserve(static_cast<std::size_t>(reading.width) * reading.height);
  for (const png_byte* row : rows) {
    for (png_uint_32 column = 0; column < reading.width; ++column) {
      double channels[4] = {};
      for (int c = 0; c < reading.channels; ++c) {
        const std::size_t at = static_cast<std::size_t>(column) * reading.channels + c;
        channels[c] = reading.depth == 16 ? (row[2 * at] * 256 + row[2 * at + 1]) / 65535.0 : row[at] / 255.0;
      }
      image.values.push_back(grey_of(channels, reading.channels));
    }
  }
  return image;
}

GreyImage read_image(const std::string& file, int width, int height) {
  if (file.ends_with(".f32")) return read_floats(file, width, height);
  return is_array(file) ? read_array(file) : parse_png(read_bytes(file), file);
}

GreyImage resample(const GreyImage& image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  // Where a cell's centre lies among the centres of the image's.
  struct Between {
    std::size_t low, high;
    double share;  // of `high`
  };
  const auto between = [](int cell, int cells, int image_cells) -> Between {
    const double at = std::clamp((cell + 0.5) / cells * image_cells - 0.5, 0.0, image_cells - 1.0);
    const auto low = static_cast<std::size_t>(at);
    return {low, std::min(low + 1, static_cast<std::size_t>(image_cells - 1)), at - static_cast<double>(low)};
  };
  std::vector<Between> columns;
  for (int x = 0; x < width; ++x) columns.push_back(between(x, width, image.width));
  GreyImage result{width, height, {}};
  result.values.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int z = 0; z < height; ++z) {
    const Between rows = between(z, height, image.height);
    const double* low = &image.values[rows.low * static_cast<std::size_t>(image.width)];
    const double* high = &image.values[rows.high * static_cast<std::size_t>(image.width)];
    for (const Between& x : columns)
      result.values.push_back(
          std::lerp(std::lerp(low[x.low], low[x.high], x.share), std::lerp(high[x.low], high[x.high], x.share), rows.share));
  }
  return result;
}

}  // namespace firn::scene
