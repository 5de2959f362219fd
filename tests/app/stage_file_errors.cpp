#include <filesystem>
#include <vector>

#include "scene/npy.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"

// GLSL that does not compile: a mistake of the input in a stage that is a file, one of Firn's own below shaders/.

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::run_firn;

namespace {

std::string cooling(const std::string& body) {
  return "/*\nfirn: 1\nname: cooling\ndoc: Cools\nports:\n"
         "  warmth: {type: float, domain: cells, access: read_write, unit: K, doc: how warm}\n"
         "  wind: {type: vec3, domain: cells, access: read, usage: sampled, unit: m/s, doc: what cools, optional: true}\n"
         "parameters:\n  strength: {default: 1, doc: how much}\n"
         "  mode: {kind: choice, choices: [fine, coarse], default: fine, doc: how}\n"
         "constants: [gravity]\nover: cells\n*/\n#include \"lib/cells.glsl\"\n\nvoid main() {\n" +
         body + "}\n";
}
constexpr const char* first_line = ":17: error: ";  // of the body

Outcome tried(const Folder& folder, const std::string& text) {
  const std::vector<float> warmth(4);
  firn::scene::write_npy(folder / "warmth.npy", {2, 2}, std::span<const float>(warmth));
  return run_firn({"try", folder.write("cooling.comp", text), "--in", "warmth=" + folder / "warmth.npy"});
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("a mistake in the GLSL of a stage's file is bad input, told at its line with the nearest name", "[app]") {
  const Folder folder;
  const struct {
    std::string line, name;
  } table[] = {
      {"warmth[element_index()] -= strenth;", "strength"},
      {"wamrth[element_index()] -= strength;", "warmth"},
      {"warmth[element_index()] -= gravty.y;", "gravity"},
      {"if (element_index() < cells_cout) return;", "cells_count"},
      {"if (elment_index() < cells_count) return;", "element_index"},
      {"uint cell = cell_idnex(ivec2(0));", "cell_index"},
      {"float half_strength = 1; warmth[0] = half_strenght;", "half_strength"},
  };
  for (const auto& wrong : table) {
    const Outcome outcome = tried(folder, cooling(wrong.line + "\n"));
    INFO(wrong.line << "\n" << outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(folder / "cooling.comp" + first_line) != std::string::npos);
    CHECK(outcome.err.find("; did you mean '" + wrong.name + "'?") != std::string::npos);
    CHECK(outcome.out.empty());
  }
}

TEST_CASE("mistakes in the GLSL of several stage files are told at once, and the run leaves nothing behind", "[app]") {
  const Folder folder;
  const std::string one = cooling("  depth[0] = dpeth[1];\n  strenth;\n"), two = cooling("  depth[0] = 1 +;\n");
  folder.write("one.comp", replaced(replaced(one, "warmth:", "depth:"), "unit: K", "unit: m"));
  folder.write("two.comp",
               replaced(replaced(replaced(two, "warmth:", "depth:"), "unit: K", "unit: m"), "name: cooling", "name: other"));
  folder.write("s.yaml", firn::test::small_field);
  const std::string pipeline =
      folder.write("p.yaml", "firn: 1\nscene: s.yaml\nsetup: [heightfield.init]\nstep:\n  - ./one.comp\n  - ./two.comp\n");
  const Outcome outcome = run_firn({"run", pipeline, "--steps", "1", "--out", folder / "out"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find(folder / "one.comp" + first_line) != std::string::npos);
  CHECK(outcome.err.find("one.comp:18: error: ") != std::string::npos);
  CHECK(outcome.err.find(folder / "two.comp" + first_line) != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("a stage's file that includes what is not there is bad input", "[app]") {
  const Folder folder;
  const std::string text = replaced(cooling(""), "lib/cells.glsl", "lib/cels.glsl");
  for (const Outcome& outcome : {tried(folder, text), run_firn({"inspect", folder.write("cooling.comp", text), "--glsl"})}) {
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(folder / "cooling.comp" + ":14: error: no file 'lib/cels.glsl' to include") != std::string::npos);
  }
}

TEST_CASE("a shader of Firn's own that does not compile ends with status 1", "[app]") {
  const Folder folder;
  std::filesystem::create_directories(folder / "shaders/mpm");
  folder.write("shaders/mpm/advect.comp", "void main() { postion[0] = 1; }\n");
  const Outcome outcome = run_firn(firn::test::run_without_pictures("mpm_snow", folder.write("scene.yaml", firn::test::small_scene),
                                                                    folder / "out", {"--steps", "1"}),
                                   {{"FIRN_DATA", folder / ""}});
  INFO(outcome.err);
  CHECK(outcome.status == 1);
  CHECK(outcome.err.find("shaders/mpm/advect.comp:1: error: ") != std::string::npos);
}
