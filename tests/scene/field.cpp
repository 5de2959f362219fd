#include "scene/field.h"

#include "scene/npy.h"
#include "tests/scene/png_files.h"
#include "tests/scene/support.h"

namespace firn::test {

namespace {

// 3 x 2 cells of 0.5 m, densities 50 to 150.
std::string scene_text(const std::string& sources) {
  return "firn: 1\nfield: {size: [1.5, 1], cells: [3, 2], material: new_snow, " + sources + "}\n";
}

struct Files {
  TemporaryFolder folder;
  void png(const std::string& name, const std::vector<int>& samples) const {
    folder.write(name, png_bytes({PNG_COLOR_TYPE_GRAY, 16}, 3, 2, samples));
  }
  void npy(const std::string& name, const std::vector<float>& values) const {
    scene::write_npy(folder / name, {2, 3}, std::span(values));
  }
  [[nodiscard]] scene::FieldArrays sampled(const std::string& sources) const {
    return scene::sample_field(good_scene(scene_text(sources), folder / "scene.yaml"));
  }
  // The errors of sampling, and that they stand where `marker` is.
  [[nodiscard]] std::string errors(const std::string& sources, const std::string& marker) const {
    const std::string text = scene_text(sources);
    const scene::Scene scene = good_scene(text, folder / "scene.yaml");
    try {
      scene::sample_field(scene);
    } catch (const config::InputError& error) {
      const config::Place& place = error.diagnostics().all().front().place;
      CHECK(std::array<int, 2>{place.line, place.column} == place_of(text, marker));
      CHECK(place.file == (folder / "scene.yaml").string());
      return error.what();
    }
    return "";
  }
};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("numbers fill every cell of a field") {
  const scene::FieldArrays field = Files().sampled("ground: -0.5, depth: 0.25, density: 120");
  CHECK(field.ground == std::vector<float>(6, -0.5F));
  CHECK(field.depth == std::vector<float>(6, 0.25F));
  CHECK(field.density == std::vector<float>(6, 120.0F));
}

TEST_CASE("images give ground, depth and density, white being the value named, row 0 at the smallest z") {
  const Files files;
  files.png("g.png", {0, 65535, 0, 0, 0, 0});
  files.png("d.png", {0, 13107, 26214, 39321, 52428, 65535});
  files.npy("r.npy", {60, 70, 80, 90, 100, 150});
  const scene::FieldArrays field =
      files.sampled("ground: {image: g.png, metres: -2}, depth: {image: d.png, metres: 0.5}, density: {image: r.npy}");
  CHECK(field.ground == std::vector<float>{0, -2, 0, 0, 0, 0});
  for (std::size_t i = 0; i < 6; ++i) CHECK(field.depth[i] == Approx(0.1 * static_cast<double>(i)));
  CHECK(field.density == std::vector<float>{60, 70, 80, 90, 100, 150});
}

TEST_CASE("arrays are in the field's units unless a factor is named") {
  const Files files;
  files.npy("d.npy", {1, 2, 3, 4, 5, 6});
  CHECK(files.sampled("depth: {image: d.npy}").depth[5] == 6);
  CHECK(files.sampled("depth: {image: d.npy, metres: 0.5}").depth[5] == 3);
}

TEST_CASE("a field of one cell is a field") {
  const scene::FieldArrays field =
      scene::sample_field(good_scene("firn: 1\nfield: {size: [2, 2], cells: [1, 1], ground: 1, depth: 0.5, material: sand}\n"));
  CHECK(field.depth == std::vector<float>{0.5F});
  CHECK(field.density == std::vector<float>{1500});
}

TEST_CASE("a negative depth is an error at its image") {
  const Files files;
  files.npy("d.npy", {1, 2, 3, -0.25, 5, -6});
  const std::string text = files.errors("depth: {image: d.npy}", "{image");
  CHECK(contains(text, "depth is -0.25 in row 1, column 0"));
  CHECK(contains(text, "one of 2 such cells"));
}

TEST_CASE("a density outside of its material is an error where snow lies and nowhere else") {
  const Files files;
  files.npy("r.npy", {60, 70, 80, 90, 40, 1000});
  files.npy("d.npy", {1, 1, 1, 1, 0, 0});
  const std::string text = files.errors("depth: 1, density: {image: r.npy}", "{image");
  CHECK(contains(text, "density is 40 in row 1, column 1"));
  CHECK(contains(text, "between 50 (min_density) and 150 kg/m3"));
  const scene::FieldArrays field = files.sampled("depth: {image: d.npy}, density: {image: r.npy}");
  CHECK(field.density == std::vector<float>{60, 70, 80, 90, 50, 150});
}

TEST_CASE("a broken image is an error at its place that names the file, together with all others") {
  const Files files;
  files.folder.write("g.png", "\x89PNG\r\n\x1a\n nothing more");
  files.folder.write("d.png", "text");
  const std::string text = files.errors("ground: {image: g.png, metres: 1}, depth: {image: d.png, metres: 1}", "{image: g.png");
  CHECK(contains(text, (files.folder / "g.png").string() + ": this PNG file is broken"));
  CHECK(contains(text, (files.folder / "d.png").string() + ": this is no PNG file"));
}

TEST_CASE("a scale that is no finite number, or would make depths negative, is an error where it stands") {
  const Files files;
  files.png("d.png", {0, 0, 0, 0, 0, 0});
  for (const std::string scale : {".nan", ".inf", "-.inf", "-0.5", "1e999", "deep"}) {
    INFO(scale);
    const std::string text = scene_text("depth: {image: d.png, metres: " + scale + "}");
    const ReadResult result = read_text(text, files.folder / "scene.yaml");
    REQUIRE(result.diagnostics.all().size() == 1);
    const config::Diagnostic& error = result.diagnostics.all().front();
    CHECK(contains(error.text, "metres"));
    CHECK(std::array<int, 2>{error.place.line, error.place.column} == place_of(text, scale + "}"));
  }
}

TEST_CASE("cells that are not square by more than one part in a million are refused with a size that fits") {
  const auto result = [](const std::string& size) {
    return read_text("firn: 1\nfield: {size: " + size + ", cells: [30, 20], depth: 1, material: new_snow}\n");
  };
  CHECK(result("[3, 2]").diagnostics.all().empty());
  CHECK(result("[3, 2.000001]").diagnostics.all().empty());
  CHECK(contains(result("[3, 2.00001]").text(), "square"));
  CHECK(contains(result("[3, 3]").text(), "[3, 2]"));
}

}  // namespace firn::test
