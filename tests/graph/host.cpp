#include "graph/host.h"

#include <cstring>
#include <map>
#include <random>
#include <vector>

#include "tests/catch.h"

namespace firn::test {
namespace {

using namespace graph;

template <typename T>
std::vector<std::byte> bytes_of(const std::vector<T>& values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::vector<float> floats_of(const std::vector<std::byte>& bytes) {
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

std::vector<ElementType> all_types() {
  std::vector<ElementType> types;
  for (const std::string& name : element_type_names()) types.push_back(element_type(name).value());
  return types;
}

TEST_CASE("packed values come back from the device's layout as they were") {
  const std::uint64_t first = seed();
  INFO("seed " << first);
  std::mt19937_64 random(first);
  for (const ElementType type : all_types())
    for (const std::size_t count : {0, 1, 2, 7}) {
      CAPTURE(name(type), count);
      const std::size_t scalars = is_texel(type) ? 1 : static_cast<std::size_t>(components(type));
      std::vector<std::uint32_t> words(count * scalars);
      for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random());
      const std::vector<std::byte> device = padded(type, bytes_of(words));
      CHECK(device.size() == count * stride(type));
      CHECK(unpadded(type, device) == bytes_of(words));
    }
}

TEST_CASE("three components are followed by four bytes of zeros") {
  CHECK(floats_of(padded(ElementType::vec3, bytes_of<float>({1, 2, 3, 4, 5, 6}))) == std::vector<float>{1, 2, 3, 0, 4, 5, 6, 0});
}

TEST_CASE("types without padding stay as they are") {
  for (const ElementType type : all_types()) {
    const bool gaps = stride(type) != static_cast<std::uint64_t>(components(type)) * 4 && !is_texel(type);
    if (gaps) continue;
    CAPTURE(name(type));
    const std::vector<std::byte> words = bytes_of<std::uint32_t>({1, 2, 3, 4, 5, 6, 7, 8});
    CHECK(padded(type, words) == words);
    CHECK(unpadded(type, words) == words);
  }
}

TEST_CASE("a matrix is row by row when packed, and in padded columns on the device") {
  // [1 2 3; 4 5 6; 7 8 9]
  const std::vector<float> rows{1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::vector<float> columns{1, 4, 7, 0, 2, 5, 8, 0, 3, 6, 9, 0};
  CHECK(floats_of(padded(ElementType::mat3, bytes_of(rows))) == columns);
  CHECK(floats_of(unpadded(ElementType::mat3, bytes_of(columns))) == rows);
}

TEST_CASE("what lies in the gaps on the device does not matter") {
  CHECK(floats_of(unpadded(ElementType::vec3, bytes_of<float>({1, 2, 3, 99, 4, 5, 6, -99}))) ==
        std::vector<float>{1, 2, 3, 4, 5, 6});
}

// Buffers in memory.
class MemoryContext final : public HostContext {
 public:
  std::map<std::string, PortView, std::less<>> views;
  std::map<std::string, std::vector<std::byte>, std::less<>> data;

  [[nodiscard]] PortView view(std::string_view port) const override { return views.find(port)->second; }
  [[nodiscard]] bool bound(std::string_view port) const override { return views.find(port) != views.end(); }
  std::vector<std::byte> read(std::string_view port) override { return data[std::string(port)]; }
  void read_into(std::string_view port, std::span<std::byte> bytes) override { std::ranges::copy(read(port), bytes.begin()); }
  void write(std::string_view port, std::span<const std::byte> bytes) override {
    data[std::string(port)].assign(bytes.begin(), bytes.end());
  }
  [[nodiscard]] const Clock& clock() const override { return clock_; }
  void set_time_step(double dt) override { clock_.dt = dt; }
  void keep(std::span<const std::uint32_t>) override { throw std::logic_error("nothing here comes or goes"); }
  void append(std::uint64_t) override { throw std::logic_error("nothing here comes or goes"); }
  void write_from(std::string_view port, std::uint64_t first, std::span<const std::byte> bytes) override {
    const PortView there = view(port);
    std::ranges::copy(bytes, data[std::string(port)].begin() + static_cast<std::ptrdiff_t>(first * stride(there.type)));
  }

 private:
  Clock clock_;
};

TEST_CASE("host stages read and write packed numbers") {
  MemoryContext context;
  context.views = {{"v", {ElementType::vec3, 2, 0, 0}}, {"n", {ElementType::ivec3, 1, 0, 0}}, {"f", {ElementType::mat3, 1, 0, 0}}};
  context.write_floats("v", std::vector<float>{1, 2, 3, 4, 5, 6});
  CHECK(context.data["v"].size() == 32);
  CHECK(context.read_floats("v") == std::vector<float>{1, 2, 3, 4, 5, 6});
  context.write_floats("v", {});
  CHECK(context.read_floats("v").empty());
  context.write_integers("n", std::vector<std::int32_t>{-1, 0, 7});
  CHECK(context.data["n"].size() == 16);
  CHECK(context.read_integers("n") == std::vector<std::int32_t>{-1, 0, 7});
  context.write_floats("f", std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(floats_of(context.data["f"])[1] == 4);
  CHECK(context.read_floats("f") == std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9});
}

}  // namespace
}  // namespace firn::test
