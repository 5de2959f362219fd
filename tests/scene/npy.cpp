#include "scene/npy.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/scene/support.h"
#include "tests/small_disk.h"

namespace firn::test {

using scene::NpyArray;
using scene::NpyKind;
using scene::NpyShape;

namespace {

// A file of format version `version` with this dictionary, as the format's description lays it out.
std::string npy_file(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  const std::string text = dictionary + "\n";
  bytes += static_cast<char>(text.size() & 0xff);
  bytes += static_cast<char>(text.size() >> 8);
  if (version > 1) bytes += std::string(2, '\0');
  return bytes + text + data;
}

std::string message_of(const std::string& bytes) {
  try {
    scene::parse_npy(bytes, "array.npy");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

template <typename T>
void round_trip(NpyKind kind, const NpyShape& shape, const std::vector<T>& values) {
  const TemporaryFolder folder;
  scene::write_npy(folder / "a.npy", shape, std::span<const T>(values));
  const NpyArray array = scene::read_npy(folder / "a.npy");
  CHECK(array.kind == kind);
  CHECK(array.shape == shape);
  REQUIRE(array.values.size() == values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T back = static_cast<T>(array.values[i]);
    CHECK(std::memcmp(&back, &values[i], sizeof(T)) == 0);
  }
  const scene::NpyHeader header = scene::read_npy_header(folder / "a.npy");
  CHECK(header.shape == shape);
  CHECK(header.count == values.size());
  CHECK(header.data_offset % 64 == 0);
}

}  // namespace

TEST_CASE("npy: what is written reads back bit for bit, for every kind and shape") {
  using limits_f = std::numeric_limits<float>;
  round_trip<float>(NpyKind::float32, {2, 3}, {0.0F, -0.0F, 1.5F, limits_f::max(), limits_f::denorm_min(), -limits_f::infinity()});
  round_trip<double>(NpyKind::float64, {4}, {0.1, -1e308, std::numeric_limits<double>::denorm_min(), 3});
  round_trip<std::int32_t>(NpyKind::int32, {1, 2, 1, 2}, {-2147483647 - 1, 2147483647, 0, -1});
  round_trip<std::uint32_t>(NpyKind::uint32, {3, 1}, {0, 4294967295U, 7});
  round_trip<float>(NpyKind::float32, {}, {2.5F});
  round_trip<float>(NpyKind::float32, {0, 3}, {});
}

TEST_CASE("npy: NaN reads back as NaN") {
  const TemporaryFolder folder;
  const std::vector<float> values{std::numeric_limits<float>::quiet_NaN()};
  scene::write_npy(folder / "a.npy", {1}, std::span<const float>(values));
  CHECK(std::isnan(scene::read_npy(folder / "a.npy").values[0]));
}

TEST_CASE("npy: random arrays read back") {
  INFO("seed " << seed());
  std::mt19937_64 random(seed());
  for (int run = 0; run < 20; ++run) {
    const NpyShape shape{random() % 5 + 1, random() % 5 + 1, random() % 5 + 1};
    std::vector<double> values(shape[0] * shape[1] * shape[2]);
    for (double& value : values) value = static_cast<double>(random()) / 1e9;
    round_trip<double>(NpyKind::float64, shape, values);
  }
}

TEST_CASE("npy: the bytes written are those of the format") {
  const TemporaryFolder folder;
  const std::vector<float> values{1, 2};
  scene::write_npy(folder / "a.npy", {2, 1}, std::span<const float>(values));
  std::ifstream stream(folder / "a.npy", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  REQUIRE(bytes.size() == 128 + 8);
  const std::string dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1), }";
  CHECK(bytes.substr(0, 10) == std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  CHECK(bytes.substr(10, 118) == dictionary + std::string(118 - 1 - dictionary.size(), ' ') + "\n");
  CHECK(bytes.substr(128) == std::string("\x00\x00\x80\x3f\x00\x00\x00\x40", 8));
}

TEST_CASE("npy: versions 1 to 3, any order of keys, double quotes and missing commas are understood") {
  const std::string one("\x00\x00\x80\x3f", 4);
  for (const char version : {'\1', '\2', '\3'}) {
    const NpyArray array =
        scene::parse_npy(npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (1,), }   ", one, version), "a");
    CHECK(array.values == std::vector<double>{1});
  }
  CHECK(scene::parse_npy(npy_file("{\"shape\":(1 , 1),\"fortran_order\":False,\"descr\":\"<f4\"}", one), "a").shape ==
        NpyShape{1, 1});
  CHECK(scene::parse_npy(npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': ()}", one), "a").shape.empty());
}

TEST_CASE("npy: a broken file is refused with a sentence that names it and its fault") {
  const std::string good = "{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }", eight(8, '\0');
  REQUIRE(message_of(npy_file(good, eight)).empty());
  const struct {
    const char* what;
    std::string bytes, fragment;
  } broken[] = {
      {"nothing", "", "no .npy file"},
      {"another kind of file", "\x89PNG\r\n\x1a\n and more", "no .npy file"},
      {"cut in the magic", "\x93NUM", "cut off"},
      {"cut in the length", npy_file(good, eight).substr(0, 9), "cut off"},
      {"cut in the dictionary", npy_file(good, eight).substr(0, 40), "cut off in its header"},
      {"cut in the values", npy_file(good, eight).substr(0, npy_file(good, eight).size() - 1), "needs 8 bytes of values but has 7"},
      {"something behind", npy_file(good, eight + "x"), "followed by something else"},
      {"version 0", npy_file(good, eight, 0), "version 0"},
      {"version 4", npy_file(good, eight, 4), "version 4"},
      {"big endian", npy_file("{'descr': '>f4', 'fortran_order': False, 'shape': (2,), }", eight), "'>f4'"},
      {"half floats", npy_file("{'descr': '<f2', 'fortran_order': False, 'shape': (4,), }", eight), "astype"},
      {"long integers", npy_file("{'descr': '<i8', 'fortran_order': False, 'shape': (1,), }", eight), "'<i8'"},
      {"objects", npy_file("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }", eight), "'|O'"},
      {"structured", npy_file("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (2,), }", eight), "structured"},
      {"Fortran order", npy_file("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 1), }", eight), "Fortran order"},
      {"order unknown", npy_file("{'descr': '<f4', 'fortran_order': Maybe, 'shape': (2,), }", eight), "True or False"},
      {"negative extent", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (-2,), }", eight), "whole numbers"},
      {"broken extent", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2.5,), }", eight), "missing"},
      {"shape no tuple", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': 2, }", eight), "'('"},
      {"huge extent", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999,), }", eight), "63 bits"},
      {"huge product", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (4294967296, 4294967296), }", eight),
       "more values than"},
      {"huge count", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (1000000000000,), }", eight), "cut off"},
      {"no shape", npy_file("{'descr': '<f4', 'fortran_order': False}", eight), "'shape'"},
      {"a key twice", npy_file("{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (2,), }", eight), "second time"},
      {"a strange key", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2,), 'z': 1}", eight), "'z'"},
      {"no brace", npy_file("'descr': '<f4', 'fortran_order': False, 'shape': (2,), }", eight), "'{'"},
      {"open quote", npy_file("{'descr", eight), "not closed"},
      {"open brace", npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2,)", eight), "'}'"},
      {"two dictionaries", npy_file(good + good, eight), "closing brace"},
      {"header of 4 GiB", std::string("\x93NUMPY\x02\x00\xff\xff\xff\xff", 12) + eight, "cannot be right"},
  };
  for (const auto& each : broken) {
    INFO(each.what);
    const std::string message = message_of(each.bytes);
    INFO(message);
    CHECK(message.find("array.npy: ") == 0);
    CHECK(message.find(each.fragment) != std::string::npos);
  }
}

TEST_CASE("npy: cut or altered bytes never do more than throw") {
  INFO("seed " << seed());
  std::mt19937_64 random(seed());
  const std::string good = npy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }", std::string(16, '\1'));
  for (int run = 0; run < 20000; ++run) {
    std::string bytes = good.substr(0, random() % (good.size() + 1));
    for (int change = 0; change < 3 && !bytes.empty(); ++change) bytes[random() % bytes.size()] = static_cast<char>(random());
    std::size_t values = 0;
    try {
      values = scene::parse_npy(bytes, "a").values.size();
    } catch (const std::runtime_error& error) {
      if (std::string(error.what()).find("a: ") != 0) FAIL(error.what());
    }
    if (values > bytes.size()) FAIL("more values than bytes");
  }
}

TEST_CASE("npy: a missing file and a folder are refused, and so is what cannot be written") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(scene::read_npy(folder / "none.npy"), std::runtime_error);
  CHECK_THROWS_AS(scene::read_npy(folder / ""), std::runtime_error);
  const std::vector<float> values(4);
  CHECK_THROWS_AS(scene::write_npy(folder / "no/such/folder.npy", {4}, std::span<const float>(values)), std::runtime_error);
  CHECK_THROWS_AS(scene::write_npy(folder / "a.npy", {5}, std::span<const float>(values)), std::runtime_error);
  CHECK_FALSE(std::filesystem::exists(folder / "a.npy"));
}

TEST_CASE("npy: what does not fit on the disk is refused by name and is not left as half a file") {
  const TemporaryFolder folder;
  const std::vector<float> values(1000);
  const auto write = [&] { scene::write_npy(folder / "a.npy", {1000}, std::span<const float>(values)); };
  {
    const SmallDisk disk(4127);  // one byte less than it takes
    CHECK_THROWS_WITH(write(), (folder / "a.npy").string() + ": cannot be written to its end; is the disk full?");
  }
  CHECK_FALSE(std::filesystem::exists(folder / "a.npy"));
  const SmallDisk disk(4128);
  CHECK_NOTHROW(write());
}

}  // namespace firn::test
