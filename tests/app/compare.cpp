#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/inputs.h"
#include "tests/catch.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::read_file;
using firn::test::run_firn;
using firn::test::small_scene;
using nlohmann::json;

namespace {

json difference(const json& comparison, const std::string& buffer) {
  for (const json& one : comparison.at("differences"))
    if (one.at("buffer") == buffer) return one;
  FAIL("no buffer " << buffer);
  return {};
}

// The page's and the table's numbers, as JSON.
json compared(const Folder& folder, firn::test::Words words) {
  words.insert(words.begin(), "compare");
  words.insert(words.end(), {"--out", folder / "out", "--image", "64x48"});
  const Outcome outcome = run_firn(words);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(outcome.out.find("B / A") != std::string::npos);
  return json::parse(read_file(folder / "out/comparison.json"));
}

bool is_png(const std::string& file) { return read_file(file).starts_with("\x89PNG"); }

}  // namespace

TEST_CASE("a pipeline compared with itself differs in nothing", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  const json result = compared(folder, {"mpm_snow", "mpm_snow", "--scene", scene, "--frames", "3"});
  CHECK(result.at("differences").size() > 10);
  for (const json& one : result.at("differences")) {
    CAPTURE(one.dump());
    CHECK(one.at("max") == 0.0);
    CHECK(one.at("rms") == 0.0);
  }
  CHECK(result.at("only_a").empty());
  CHECK(result.at("only_b").empty());
  CHECK(result.at("pictures").at("rms") == 0.0);
  CHECK(result.at("a").at("masses").at("particles").get<double>() > 1);
  for (const json& pass : result.at("passes")) CHECK(pass.at("a").at("launches") == pass.at("b").at("launches"));
}

TEST_CASE("that a pipeline is compared with itself is said, by whichever name it goes", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene), file = FIRN_SOURCE_DIR "/pipelines/mpm_snow.yaml";
  const auto said = [&](firn::test::Words words) {
    words.insert(words.begin(), {"compare", "mpm_snow"});
    words.insert(words.end(), {"--scene", scene, "--steps", "1", "--image", "64x48", "--out", folder / "out"});
    const Outcome outcome = run_firn(words);
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    return outcome.err.find("A and B are the same pipeline with the same settings") != std::string::npos;
  };
  CHECK(said({"mpm_snow"}));
  CHECK(said({file, "--set-a", "kernel=cubic", "--set-b", "kernel=cubic"}));
  CHECK_FALSE(said({file, "--set-b", "kernel=quadratic"}));
  CHECK_FALSE(said({"mpm_thesis"}));
}

TEST_CASE("two pipelines for one model agree to rounding, and their passes stand beside each other", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  const json result = compared(folder, {"mpm_thesis", "mpm_snow", "--scene", scene, "--steps", "10"});
  CHECK(result.at("a").at("steps") == 10);
  const json position = difference(result, "position");
  CHECK(position.at("max").get<double>() < 1e-4);
  CHECK(position.at("rms").get<double>() <= position.at("max").get<double>());
  CHECK(position.at("largest").get<double>() == Approx(std::hypot(0.4, 0.45, 0.5)).margin(0.15));
  CHECK(result.at("a").at("masses").at("particles") == result.at("b").at("masses").at("particles"));
  bool both = false, only_a = false, only_b = false;
  for (const json& pass : result.at("passes")) {
    const bool a = pass.at("a").at("launches").get<int>() > 0, b = pass.at("b").at("launches").get<int>() > 0;
    both |= a && b && pass.at("phase") == "step" && pass.at("work") == "mpm/grid_collide.comp";
    only_a |= a && !b && pass.at("work") == "mpm/particles_to_grid.comp";
    only_b |= b && !a && pass.at("work") == "mpm/blocks_scatter.comp";
    if (a && pass.at("phase") == "step") CHECK(pass.at("a").at("median").get<double>() > 0);
  }
  CHECK(both);
  CHECK(only_a);
  CHECK(only_b);
}

TEST_CASE("settings of one side change that side alone", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  const json result = compared(folder, {"mpm_snow", "--scene", scene, "--steps", "20", "--set", "scene.seed=5", "--set",
                                        "scene.bodies=[]", "--set-b", "scene.gravity=[0, 9.81, 0]"});
  // After 20 steps of 2e-4 s, 2 g t apart: the snow falls freely.
  CHECK(difference(result, "velocity").at("rms").get<double>() == Approx(2 * 9.81 * 20 * 2e-4).epsilon(0.05));
  CHECK(result.at("b").at("set") == "scene.gravity=[0, 9.81, 0]");
  CHECK(result.at("a").at("set") == "");
}

TEST_CASE("the page holds pictures and numbers in one file", "[app]") {
  const Folder folder;
  const json result =
      compared(folder, {"heightfield_contour", "heightfield_distance", "--frames", "6", "--set", "scene.field.cells=[64, 64]"});
  for (const char* name : {"out/a.png", "out/b.png", "out/difference.png"}) CHECK(is_png(folder / name));
  const std::string page = read_file(folder / "out/index.html");
  const std::string picture = "src=\"data:image/png;base64,";
  std::size_t pictures = 0;
  for (auto at = page.find(picture); at != std::string::npos; at = page.find(picture, at + 1)) ++pictures;
  const bool same = page.find("The two pictures are the same") != std::string::npos;
  CHECK(pictures == (same ? 2 : 3));
  CHECK(page.find("http") == std::string::npos);  // nothing is fetched
  CHECK(page.find("heightfield.distribute_contour") != std::string::npos);
  CHECK(page.find("heightfield.distribute_distance") != std::string::npos);
  const double a = result.at("a").at("masses").at("the field"), b = result.at("b").at("masses").at("the field");
  CHECK(a > 1000);
  CHECK(b == Approx(a).epsilon(1e-3));
}

TEST_CASE("what cannot be compared is refused before anything runs", "[app]") {
  const Folder folder;
  const Outcome same = run_firn({"compare", "mpm_snow", "--out", folder / "out"});
  CHECK(same.status == 2);
  CHECK(same.err.find("nothing differs") != std::string::npos);
  const Outcome unknown = run_firn({"compare", "mpm_snow", "mpm_thesis", "--set-b", "kernl=cubic", "--out", folder / "out"});
  CHECK(unknown.status == 2);
  CHECK(unknown.err.find("did you mean 'kernel'") != std::string::npos);
  const Outcome other_model = run_firn({"compare", "mpm_snow", "heightfield_contour", "--out", folder / "out"});
  CHECK(other_model.status == 2);
  CHECK(other_model.err.find("the scene has no 'field'") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}
