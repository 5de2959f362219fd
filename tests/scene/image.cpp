#include "scene/image.h"

#include "scene/npy.h"
#include "tests/scene/png_files.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

std::string error_of(const std::string& bytes) {
  try {
    scene::parse_png(bytes, "drift.png");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::vector<double> decoded(const PngKind& kind, std::uint32_t width, std::uint32_t height, const std::vector<int>& samples) {
  const scene::GreyImage image = scene::parse_png(png_bytes(kind, width, height, samples), "test.png");
  CHECK(image.width == static_cast<int>(width));
  CHECK(image.height == static_cast<int>(height));
  return image.values;
}

}  // namespace

TEST_CASE("grey images of every depth give the stored value over the largest one") {
  const int depth = GENERATE(1, 2, 4, 8, 16);
  const bool interlaced = GENERATE(false, true);
  CAPTURE(depth, interlaced);
  const int white = (1 << depth) - 1;
  const std::vector<int> samples{0, white, white / 3, white, 0, white / 2};
  const std::vector<double> values = decoded({PNG_COLOR_TYPE_GRAY, depth, interlaced}, 3, 2, samples);
  REQUIRE(values.size() == samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) CHECK(values[i] == static_cast<double>(samples[i]) / white);
}

TEST_CASE("colour becomes grey by the weights of Rec. 709") {
  const int depth = GENERATE(8, 16);
  const int white = (1 << depth) - 1;
  const std::vector<double> values =
      decoded({PNG_COLOR_TYPE_RGB, depth}, 5, 1, {white, 0, 0, 0, white, 0, 0, 0, white, white, white, white, 77, 77, 77});
  CHECK(values[0] == Approx(0.2126));
  CHECK(values[1] == Approx(0.7152));
  CHECK(values[2] == Approx(0.0722));
  CHECK(values[3] == 1);
  CHECK(values[4] == 77.0 / white);
}

TEST_CASE("what is transparent counts as black") {
  CHECK(decoded({PNG_COLOR_TYPE_GRAY_ALPHA, 8}, 3, 1, {255, 255, 255, 0, 102, 51}) ==
        std::vector<double>{1, 0, (102 / 255.0) * (51 / 255.0)});
  CHECK(decoded({PNG_COLOR_TYPE_RGB_ALPHA, 16}, 2, 1, {65535, 65535, 65535, 0, 65535, 65535, 65535, 65535}) ==
        std::vector<double>{0, 1});
}

TEST_CASE("palettes are looked up") {
  CHECK(decoded({PNG_COLOR_TYPE_PALETTE, 8}, 2, 1, {1, 4}) == std::vector<double>{50 / 255.0, 200 / 255.0});
  CHECK(decoded({PNG_COLOR_TYPE_PALETTE, 4}, 2, 1, {1, 4}) == std::vector<double>{50 / 255.0, 200 / 255.0});
}

TEST_CASE("a broken PNG file is an error that names it, wherever it is cut off") {
  const std::string good = png_bytes({PNG_COLOR_TYPE_GRAY, 16}, 9, 7, std::vector<int>(63, 12345));
  for (std::size_t length = 0; length < good.size(); length += 3) {
    INFO(length);
    const std::string text = error_of(good.substr(0, length));
    CHECK(text.find("drift.png: this ") == 0);
  }
  std::string flipped = good;
  flipped[good.size() / 2] ^= 0x40;
  CHECK(error_of(flipped).find("drift.png: this PNG file is broken: ") == 0);
  CHECK(error_of("GIF89a").find("this is no PNG file") != std::string::npos);
}

TEST_CASE("a PNG file that claims to be enormous is refused before memory is taken") {
  std::string bytes = png_bytes({PNG_COLOR_TYPE_GRAY, 8}, 1, 1, {0});
  for (const std::size_t at : {18UL, 22UL}) bytes[at] = 0x0f;  // width and height: 983,041
  CHECK(error_of(bytes).find("drift.png: ") == 0);
}

TEST_CASE("a two-dimensional array is an image, its values unchanged") {
  const TemporaryFolder folder;
  const std::vector<float> values{1, -2, 3, 4, 5, 600};
  scene::write_npy(folder / "a.npy", {2, 3}, std::span(values));
  const scene::GreyImage image = scene::read_image((folder / "a.npy").string());
  CHECK(image.width == 3);
  CHECK(image.height == 2);
  CHECK(image.values == std::vector<double>(values.begin(), values.end()));

  scene::write_npy(folder / "b.npy", {6}, std::span(values));
  const std::vector<float> with_nan{1, 2, std::nanf(""), 4};
  scene::write_npy(folder / "c.npy", {2, 2}, std::span(with_nan));
  for (const auto& [name, part] : {std::pair{"b.npy", "two dimensions"}, std::pair{"c.npy", "row 1, column 0 is nan"}}) {
    const std::string file = (folder / name).string();
    try {
      scene::read_image(file);
      FAIL(name);
    } catch (const std::runtime_error& error) {
      CHECK(std::string(error.what()).find(file) == 0);
      CHECK(std::string(error.what()).find(part) != std::string::npos);
    }
  }
}

TEST_CASE("a file of floats is an image as wide as the cells, or a square") {
  const TemporaryFolder folder;
  std::vector<float> values(36);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5F * static_cast<float>(i);
  folder.write("map.f32", std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)));
  const scene::GreyImage wide = scene::read_image((folder / "map.f32").string(), 12, 3);
  CHECK(wide.width == 12);
  CHECK(wide.height == 3);
  CHECK(wide.values[13] == 6.5);
  const scene::GreyImage square = scene::read_image((folder / "map.f32").string(), 5, 5);
  CHECK(square.width == 6);
  CHECK(square.values.back() == 17.5);
}

TEST_CASE("an image of the cells' own size comes through unchanged, any other is bilinear between centres") {
  const scene::GreyImage image{2, 2, {0, 1, 2, 5}};
  CHECK(scene::resample(image, 2, 2).values == image.values);
  const std::vector<double> row = scene::resample({2, 1, {0, 1}}, 4, 1).values;
  for (std::size_t i = 0; i < 4; ++i) CHECK(row[i] == Approx(std::vector<double>{0, 0.25, 0.75, 1}[i]));
  const std::vector<double> column = scene::resample({1, 2, {0, 1}}, 1, 4).values;
  CHECK(column == row);
  CHECK(scene::resample(image, 1, 1).values[0] == Approx(2));
  for (const double value : scene::resample({1, 1, {0.3}}, 5, 3).values) CHECK(value == Approx(0.3));
}

TEST_CASE("a plane stays a plane when resampled, away from the edges") {
  scene::GreyImage plane{12, 8, {}};
  const auto height = [](double x, double z) { return 0.3 + 2 * x - 0.7 * z; };
  for (int z = 0; z < 8; ++z)
    for (int x = 0; x < 12; ++x) plane.values.push_back(height((x + 0.5) / 12, (z + 0.5) / 8));
  const int width = GENERATE(5, 12, 31), rows = GENERATE(6, 19);
  const scene::GreyImage result = scene::resample(plane, width, rows);
  for (int z = 0; z < rows; ++z)
    for (int x = 0; x < width; ++x) {
      const double px = (x + 0.5) / width, pz = (z + 0.5) / rows;
      if (std::abs(px - 0.5) > 0.45 || std::abs(pz - 0.5) > 0.43) continue;
      CHECK(result.values[static_cast<std::size_t>(z * width + x)] == Approx(height(px, pz)));
    }
}

}  // namespace firn::test
