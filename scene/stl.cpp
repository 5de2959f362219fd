#include "scene/stl.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "config/numbers.h"

namespace firn::scene {
namespace {

constexpr std::size_t header_bytes = 80, count_bytes = 4, triangle_bytes = 50;

[[noreturn]] void fail(const std::string& name, const std::string& text) {
  throw std::runtime_error(fmt::format("{}: {}", name, text));
}

bool same(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](unsigned char a, unsigned char b) { return std::tolower(a) == b; });
}

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

// For people: other files than texts may stand there.
std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 40;
  const bool plain = std::all_of(word.begin(), word.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  return plain && word.size() <= longest ? fmt::format("'{}'", word) : "something else";
}

class Text {
 public:
  Text(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  std::vector<StlTriangle> read() {
    std::vector<StlTriangle> triangles;
    do {
      expect("solid");
      pass_over_line();  // its name
      while (one_of("facet", "endsolid") == "facet") triangles.push_back(facet());
      pass_over_line();
    } while (more());
    return triangles;
  }

 private:
  StlTriangle facet() {
    expect("normal");
    for (int axis = 0; axis < 3; ++axis) next("a number");
    expect("outer");
    expect("loop");
    StlTriangle triangle;
    for (Eigen::Vector3f& corner : triangle) {
      expect("vertex");
      for (float& coordinate : corner) coordinate = number();
    }
    expect("endloop");
    expect("endfacet");
    return triangle;
  }

  bool more() {
    for (; at_ < text_.size() && is_space(text_[at_]); ++at_)
      if (text_[at_] == '\n') ++line_;
    return at_ < text_.size();
  }

  void pass_over_line() { at_ = std::min(text_.find_first_of("\r\n", at_), text_.size()); }

  std::string_view next(std::string_view wanted) {
    if (!more()) fail_here(fmt::format("the file ends where {} should follow; is it cut off?", wanted));
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void expect(std::string_view keyword) {
    const std::string wanted = fmt::format("'{}'", keyword);
    if (const std::string_view word = next(wanted); !same(word, keyword))
      fail_here(fmt::format("{} must stand here, not {}", wanted, quoted(word)));
  }

  std::string_view one_of(std::string_view one, std::string_view other) {
    const std::string wanted = fmt::format("'{}' or '{}'", one, other);
    const std::string_view word = next(wanted);
    if (same(word, one)) return one;
    if (!same(word, other)) fail_here(fmt::format("{} must stand here, not {}", wanted, quoted(word)));
    return other;
  }

  float number() {
    const std::string_view word = next("a number");
    const auto value = config::parse_number(word);
    if (!value && !config::means_not_finite(word)) fail_here(fmt::format("a coordinate must be a number, not {}", quoted(word)));
    constexpr double most = std::numeric_limits<float>::max();
    if (!value || std::abs(*value) > most)
      fail_here(fmt::format("a coordinate must be finite, at most {:.3g}, not {}", most, quoted(word)));
    return static_cast<float>(*value);
  }

  [[noreturn]] void fail_here(const std::string& text) const { fail(name_, fmt::format("line {}: {}", line_, text)); }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

std::vector<StlTriangle> read_binary(std::string_view triangles, const std::string& name) {
  std::vector<StlTriangle> read(triangles.size() / triangle_bytes);
  for (std::size_t t = 0; t < read.size(); ++t) {
    constexpr std::size_t normal_bytes = 12;
    const char* from = triangles.data() + t * triangle_bytes + normal_bytes;
    for (Eigen::Vector3f& corner : read[t]) {
      std::memcpy(corner.data(), from, 3 * sizeof(float));
      from += 3 * sizeof(float);
      if (!corner.allFinite())
        fail(name,
             fmt::format("triangle {}: a corner is ({}, {}, {}), but must be finite", t + 1, corner.x(), corner.y(), corner.z()));
    }
  }
  return read;
}

bool begins_as_text(std::string_view bytes) {
  constexpr std::string_view solid = "solid";
  const auto begin = static_cast<std::size_t>(std::find_if_not(bytes.begin(), bytes.end(), is_space) - bytes.begin());
  return same(bytes.substr(begin, solid.size()), solid);
}

}  // namespace

std::vector<StlTriangle> parse_stl(std::string_view bytes, const std::string& name) {
  constexpr std::size_t start = header_bytes + count_bytes;
  std::uint32_t count = 0;
  const bool has_count = bytes.size() >= start;
  if (has_count) std::memcpy(&count, bytes.data() + header_bytes, count_bytes);
  const std::uint64_t length = start + std::uint64_t{count} * triangle_bytes;
  if (has_count && bytes.size() == length) return read_binary(bytes.substr(start), name);
  if (begins_as_text(bytes)) return Text(bytes, name).read();
  if (!has_count)
    fail(name, fmt::format("this .stl file has {} bytes, but a binary one has {} and more, and one of text begins with 'solid'",
                           bytes.size(), start));
  fail(name, fmt::format("this binary .stl file promises {} triangles, {} bytes in all, but has {}", count, length, bytes.size()));
}

std::vector<StlTriangle> read_stl(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(file, "cannot be opened for reading");
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) fail(file, "cannot be read to its end");
  return parse_stl(bytes, file);
}

}  // namespace firn::scene
