#include "scene/npy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace firn::scene {

static_assert(std::endian::native == std::endian::little,
              "values are copied as they lie in memory; big-endian hosts must swap bytes");

namespace {

constexpr std::string_view magic{"\x93NUMPY", 6};
constexpr std::size_t longest_header = 1 << 16;  // what version 1 can hold; NumPy's own limit for reading is smaller still

[[noreturn]] void fail(const std::string& name, const std::string& text) {
  throw std::runtime_error(fmt::format("{}: {}", name, text));
}

struct KindInfo {
  NpyKind kind;
  std::string_view descriptor;  // NumPy's array interface type string, little endian
  std::string_view name;
  std::uint64_t bytes;
};
constexpr KindInfo kinds[] = {{NpyKind::float32, "<f4", "float32", 4},
                              {NpyKind::float64, "<f8", "float64", 8},
                              {NpyKind::int32, "<i4", "int32", 4},
                              {NpyKind::uint32, "<u4", "uint32", 4}};

const KindInfo& info(NpyKind kind) {
  return *std::find_if(std::begin(kinds), std::end(kinds), [&](const KindInfo& each) { return each.kind == kind; });
}

// The header is the text of a Python dictionary: {'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }
class Dictionary {
 public:
  Dictionary(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  NpyHeader read() {
    NpyHeader header;
    bool has_kind = false, has_order = false, has_shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string key = quoted();
      expect(':');
      if (key == "descr" && !has_kind) {
        header.kind = kind();
        has_kind = true;
      } else if (key == "fortran_order" && !has_order) {
        order();
        has_order = true;
      } else if (key == "shape" && !has_shape) {
        header.shape = shape();
        has_shape = true;
      } else {
        fail(name_, fmt::format("the header of this .npy file has the key '{}', unknown or for the second time", key));
      }
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    skip_space();
    if (at_ != text_.size()) fail(name_, "the header of this .npy file goes on after its closing brace");
    if (!has_kind || !has_order || !has_shape)
      fail(name_, "the header of this .npy file must have the keys 'descr', 'fortran_order' and 'shape'");
    return header;
  }

 private:
  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  bool accept(char expected) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != expected) return false;
    ++at_;
    return true;
  }
  void expect(char expected) {
    if (!accept(expected)) fail(name_, fmt::format("the header of this .npy file is broken: '{}' is missing", expected));
  }
  bool accept_word(std::string_view word) {
    skip_space();
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }
  std::string quoted() {
    skip_space();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '\'' && quote != '"') fail(name_, "the header of this .npy file is broken: a quoted word is missing");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail(name_, "the header of this .npy file is broken: a quote is not closed");
    std::string word(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return word;
  }
  NpyKind kind() {
    skip_space();
    if (at_ < text_.size() && text_[at_] == '[')
      fail(name_, "this .npy file holds a structured array; one of plain float32, float64, int32 or uint32 is needed");
    const std::string descriptor = quoted();
    for (const KindInfo& each : kinds)
      if (each.descriptor == descriptor) return each.kind;
    fail(name_, fmt::format("this .npy file holds values of type '{}'; needed is float32, float64, int32 or uint32, little endian "
                            "(in NumPy: array.astype('<f4'))",
                            descriptor));
  }
  void order() {
    if (accept_word("False")) return;
    if (accept_word("True"))
      fail(name_, "this .npy file is in Fortran order; C order is needed (in NumPy: numpy.ascontiguousarray(array))");
    fail(name_, "the header of this .npy file is broken: 'fortran_order' must be True or False");
  }
  NpyShape shape() {
    NpyShape extents;
    expect('(');
    while (!accept(')')) {
      extents.push_back(extent());
      if (!accept(',')) {
        expect(')');
        break;
      }
    }
    return extents;
  }
  std::uint64_t extent() {
    skip_space();
    constexpr std::uint64_t limit = std::numeric_limits<std::int64_t>::max();
    const std::size_t begin = at_;
    std::uint64_t value = 0;
    for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_) {
      const auto digit = static_cast<std::uint64_t>(text_[at_] - '0');
      if (value > (limit - digit) / 10) fail(name_, "the shape of this .npy file has an extent beyond 63 bits");
      value = value * 10 + digit;
    }
    if (at_ == begin) fail(name_, "the header of this .npy file is broken: 'shape' must be a tuple of whole numbers from 0");
    return value;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

std::uint64_t count_of(const NpyShape& shape, const std::string& name) {
  if (std::find(shape.begin(), shape.end(), 0) != shape.end()) return 0;
  std::uint64_t count = 1;
  for (const std::uint64_t extent : shape) {
    // 8 bytes each must still be countable in 63 bits.
    if (count > (std::numeric_limits<std::int64_t>::max() / 8) / extent)
      fail(name, fmt::format("the shape {} has more values than can be counted", to_string(shape)));
    count *= extent;
  }
  return count;
}

// The prelude before the dictionary: magic, version, length of the dictionary (little endian).
struct Prelude {
  std::size_t begin;   // of the dictionary
  std::size_t length;  // of the dictionary
};
Prelude parse_prelude(std::string_view bytes, const std::string& name) {
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at])); };
  if (bytes.substr(0, magic.size()) != magic.substr(0, std::min(magic.size(), bytes.size())) || bytes.empty())
    fail(name, "this is no .npy file: it must begin with the bytes 93 'NUMPY'");
  if (bytes.size() < 8) fail(name, "this .npy file is cut off in its first bytes");
  const std::size_t version = byte(6);
  if (version < 1 || version > 3) fail(name, fmt::format("this .npy file has format version {}; known are 1, 2 and 3", version));
  const std::size_t begin = version == 1 ? 10 : 12;
  if (bytes.size() < begin) fail(name, "this .npy file is cut off in its first bytes");
  std::size_t length = byte(8) + (byte(9) << 8);
  if (version > 1) length += (byte(10) << 16) + (byte(11) << 24);
  if (length > longest_header) fail(name, fmt::format("this .npy file has a header of {} bytes, which cannot be right", length));
  return {begin, length};
}

void check_length(const NpyHeader& header, std::uint64_t file_bytes, const std::string& name) {
  const std::uint64_t needed = header.count * info(header.kind).bytes;
  const std::uint64_t present = file_bytes - header.data_offset;
  if (present == needed) return;
  fail(name,
       fmt::format("this .npy file of shape {} and type {} needs {} bytes of values but has {}: it is {}", to_string(header.shape),
                   to_string(header.kind), needed, present, present < needed ? "cut off" : "followed by something else"));
}

template <typename T>
void convert(std::string_view bytes, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value;
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    values[i] = static_cast<double>(value);
  }
}

// At most `limit` bytes of the file, and its length.
struct Content {
  std::string bytes;
  std::uint64_t length = 0;
};
Content read_bytes(const std::filesystem::path& file, std::optional<std::uint64_t> limit) {
  const std::string name = file.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail(name, "this file does not exist");
  if (!std::filesystem::is_regular_file(status)) fail(name, "this is no file");
  Content content;
  content.length = std::filesystem::file_size(file, error);
  if (error) fail(name, fmt::format("cannot be read: {}", error.message()));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(name, "cannot be opened for reading");
  content.bytes.resize(limit ? std::min(*limit, content.length) : content.length);
  stream.read(content.bytes.data(), static_cast<std::streamsize>(content.bytes.size()));
  if (static_cast<std::size_t>(stream.gcount()) != content.bytes.size()) fail(name, "cannot be read to its end");
  return content;
}

void write_array(const std::filesystem::path& file, const NpyShape& shape, NpyKind kind, const void* values, std::size_t count) {
  const std::string name = file.string();
  if (count_of(shape, name) != count)
    fail(name, fmt::format("an array of shape {} cannot be written from {} values", to_string(shape), count));
  const std::string header = npy_header(kind, shape);
  if (header.size() >= longest_header) fail(name, "an array of this many dimensions cannot be written");

  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream) fail(name, "cannot be opened for writing");
  stream.write(header.data(), static_cast<std::streamsize>(header.size()));
  stream.write(static_cast<const char*>(values), static_cast<std::streamsize>(count * info(kind).bytes));
  stream.close();
  if (stream) return;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) std::filesystem::remove(file, ignored);
  fail(name, "cannot be written to its end; is the disk full?");
}

}  // namespace

std::string to_string(NpyKind kind) { return std::string(info(kind).name); }

std::string to_string(const NpyShape& shape) {
  return shape.size() == 1 ? fmt::format("({},)", shape[0]) : fmt::format("({})", fmt::join(shape, ", "));
}

std::string npy_header(NpyKind kind, const NpyShape& shape) {
  std::string dictionary =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", info(kind).descriptor, to_string(shape));
  // Values start at a multiple of 64 bytes, so that the file can be mapped into memory.
  const std::size_t unpadded = 10 + dictionary.size() + 1;
  dictionary.append((64 - unpadded % 64) % 64, ' ');
  dictionary += '\n';
  const char prelude[] = {1, 0, static_cast<char>(dictionary.size() & 0xff), static_cast<char>(dictionary.size() >> 8)};
  return std::string(magic) + std::string(prelude, sizeof(prelude)) + dictionary;
}

NpyHeader parse_npy_header(std::string_view bytes, const std::string& name) {
  const Prelude prelude = parse_prelude(bytes, name);
  if (bytes.size() < prelude.begin + prelude.length) fail(name, "this .npy file is cut off in its header");
  NpyHeader header = Dictionary(bytes.substr(prelude.begin, prelude.length), name).read();
  header.count = count_of(header.shape, name);
  header.data_offset = prelude.begin + prelude.length;
  return header;
}

NpyArray parse_npy(std::string_view bytes, const std::string& name) {
  const NpyHeader header = parse_npy_header(bytes, name);
  check_length(header, bytes.size(), name);
  NpyArray array{header.kind, header.shape, std::vector<double>(header.count)};
  const std::string_view data = bytes.substr(header.data_offset);
  switch (header.kind) {
    case NpyKind::float32:
      convert<float>(data, array.values);
      break;
    case NpyKind::float64:
      convert<double>(data, array.values);
      break;
    case NpyKind::int32:
      convert<std::int32_t>(data, array.values);
      break;
    case NpyKind::uint32:
      convert<std::uint32_t>(data, array.values);
      break;
  }
  return array;
}

NpyHeader read_npy_header(const std::filesystem::path& file) {
  const Content content = read_bytes(file, 12 + longest_header);
  NpyHeader header = parse_npy_header(content.bytes, file.string());
  check_length(header, content.length, file.string());
  return header;
}

NpyArray read_npy(const std::filesystem::path& file) { return parse_npy(read_bytes(file, std::nullopt).bytes, file.string()); }

void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const float> values) {
  write_array(file, shape, NpyKind::float32, values.data(), values.size());
}
void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const double> values) {
  write_array(file, shape, NpyKind::float64, values.data(), values.size());
}
void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const std::int32_t> values) {
  write_array(file, shape, NpyKind::int32, values.data(), values.size());
}
void write_npy(const std::filesystem::path& file, const NpyShape& shape, std::span<const std::uint32_t> values) {
  write_array(file, shape, NpyKind::uint32, values.data(), values.size());
}

}  // namespace firn::scene
