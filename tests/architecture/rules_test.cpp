#include "tests/architecture/rules.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/catch.h"

// Each rule is shown an offender, and beside it the nearest thing that is allowed.

namespace firn::architecture {
namespace {

Violations includes(const std::string& path, const std::string& text) { return check_includes({{path, text}}); }

std::string include_line(const std::string& target) { return "#include \"" + target + "\"\n"; }

bool is_allowed(const std::string& path, const std::string& target) { return includes(path, include_line(target)).empty(); }

std::string example_in(const std::string& room, const std::string& name) { return room + "/" + name; }

TEST_CASE("the table of rooms says who may include whom") {
  const std::vector<std::string> all = {"config", "gpu", "graph", "graph/execution", "scene", "stages", "app", "tests", "bench"};
  const std::vector<std::pair<std::string, std::vector<std::string>>> table = {
      {"config", {"config"}},
      {"gpu", {"gpu"}},
      {"graph", {"graph", "config"}},
      {"graph/execution", {"graph/execution", "graph", "gpu", "config"}},
      {"scene", {"scene", "config"}},
      {"stages", {"stages", "graph", "scene", "config"}},
      {"app", all},
      {"tests", all},
      {"bench", all},
  };
  for (const auto& [room, allowed] : table) {
    for (const std::string& target : all) {
      CAPTURE(room, target);
      const bool expected = std::find(allowed.begin(), allowed.end(), target) != allowed.end();
      CHECK(is_allowed(example_in(room, "one.cpp"), example_in(target, "two.h")) == expected);
    }
  }
}

TEST_CASE("a forbidden include is told with its place and with what is allowed") {
  const Violations found = includes("graph/plan.cpp", "#include <vector>\n\n  #  include \"gpu/device.h\"  // why\n");
  REQUIRE(found.size() == 1);
  CHECK(found[0] == "graph/plan.cpp:3: includes gpu/device.h; graph/ may include only graph, config");
}

TEST_CASE("angle brackets hide no include of ours") { CHECK(includes("config/node.cpp", "#include <gpu/device.h>\n").size() == 1); }

TEST_CASE("an include in a comment or a string is none") {
  CHECK(includes("config/node.cpp", "// #include \"gpu/device.h\"\nconst char* text = \"#include <glad/gl.h>\";\n").empty());
}

TEST_CASE("an include of GLSL within a string is none of C++") { CHECK(is_allowed("gpu/program.cpp", "lib/random.glsl")); }

TEST_CASE("a quoted include is written from the root") {
  CHECK_FALSE(is_allowed("config/node.cpp", "node.h"));
  CHECK_FALSE(is_allowed("graph/plan.cpp", "../gpu/device.h"));
  CHECK(is_allowed("config/node.cpp", "config/node.h"));
}

TEST_CASE("only the gpu room sees glad") {
  CHECK(includes("gpu/device.cpp", "#include <glad/gl.h>\n").empty());
  for (const std::string path : {"graph/execution/run.cpp", "app/view.cpp", "tests/gpu/device_test.cpp", "stages/mpm/step.cpp"}) {
    CAPTURE(path);
    CHECK(includes(path, "#include <glad/gl.h>\n").size() == 1);
    CHECK(includes(path, "#include <EGL/egl.h>\n").size() == 1);
  }
}

TEST_CASE("no stage includes another stage") {
  CHECK(is_allowed("stages/mpm/advect.cpp", "stages/mpm/advect.h"));
  CHECK(is_allowed("stages/mpm/advect.cpp", "stages/kernels.h"));
  CHECK(is_allowed("stages/register.cpp", "stages/mpm/advect.h"));
  CHECK(is_allowed("stages/kernels.cpp", "stages/kernels.h"));
  CHECK_FALSE(is_allowed("stages/mpm/advect.cpp", "stages/mpm/clear_grid.h"));
  CHECK_FALSE(is_allowed("stages/mpm/advect.h", "stages/render/snow.h"));
  CHECK_FALSE(is_allowed("stages/mpm/advect.cpp", "stages/heightfield/advect.h"));
  CHECK_FALSE(is_allowed("stages/kernels.h", "stages/mpm/advect.h"));
}

TEST_CASE("C++ outside the rooms is a violation") {
  CHECK(includes("viewer/window.cpp", "").size() == 1);
  CHECK(includes("window.cpp", "").size() == 1);
  CHECK(includes("docs/guide.md", include_line("gpu/device.h")).empty());
}

TEST_CASE("a file of source may have 400 lines and no more") {
  std::string text;
  for (int i = 0; i < longest_file; ++i) text += "\n";
  for (const std::string path : {"gpu/a.cpp", "gpu/a.h", "shaders/mpm/a.comp", "shaders/render/a.frag", "shaders/lib/a.glsl"}) {
    CAPTURE(path);
    CHECK(check_lengths({{path, text}}).empty());
    CHECK(check_lengths({{path, text + "last"}}).size() == 1);
  }
  CHECK(check_lengths({{"docs/a.md", text + text}}).empty());
}

TEST_CASE("a place of one machine is a violation in any file") {
  for (const std::string& place : {std::string("/wo") + "rk/x", std::string("/ro") + "ot/x", std::string("/ho") + "me/x"}) {
    CAPTURE(place);
    const Violations found = check_machine_paths({{"docs/a.md", "first\nsee " + place + "\n"}});
    REQUIRE(found.size() == 1);
    CHECK(found[0].starts_with("docs/a.md:2: "));
    CHECK(check_machine_paths({{"pipelines/a.yaml", "file: \"" + place + "\""}}).size() == 1);
    CHECK(check_machine_paths({{"docs/a.md", "results" + place}}).empty());
  }
}

TEST_CASE("a test case whose name ctest would lose is a violation") {
  for (const std::string& name : {std::string("--set wins"), std::string("a; b"), std::string("a\\\\b"), std::string("a [ b")}) {
    CAPTURE(name);
    const Violations found = check_test_names({{"tests/gpu/a.cpp", "\nTEST_CASE(\"" + name + "\") {}\n"}});
    REQUIRE(found.size() == 1);
    CHECK(found[0].starts_with("tests/gpu/a.cpp:2: "));
  }
  CHECK(check_test_names({{"tests/gpu/a.cpp", "TEST_CASE(\"a[3], b: 'c' (d)\", \"[tag; x]\") { f(); }\n"}}).empty());
}

TEST_CASE("build folders, results and hidden folders are no part of the tree") {
  namespace fs = std::filesystem;
  const fs::path root = fs::temp_directory_path() / ("firn-tree-" + std::to_string(test::seed()));
  for (const std::string path : {"a/b.cpp", "build-debug/b.cpp", "out/b.md", ".git/b.h", ".ci/run", "x.txt", "a/picture.png"}) {
    fs::create_directories((root / path).parent_path());
    std::ofstream(root / path) << path;
  }
  std::string found;
  for (const SourceFile& file : read_tree(root.string())) {
    CHECK(file.path == file.text);
    found += file.path + " ";
  }
  fs::remove_all(root);
  CHECK(found == ".ci/run a/b.cpp x.txt ");
}

}  // namespace
}  // namespace firn::architecture
