// What fuzzers found worth keeping, looked at again by an ordinary build: no crash, no hazard, no error without a text, and no file
// that takes longer than a second.

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/catch.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/inputs.h"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const std::string& target) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(FIRN_SOURCE_DIR) / "tests/fuzz/corpus" / target))
    files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

void replay(const std::string& target, void (*check)(const firn::fuzz::Sandbox&, std::string_view)) {
  const firn::fuzz::Sandbox sandbox;
  const std::vector<fs::path> files = files_of(target);
  CHECK(files.size() > 20);
  for (const fs::path& file : files) {
    CAPTURE(file.string());
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::clock_t start = std::clock();
    CHECK_NOTHROW(check(sandbox, text));
    CHECK(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC < 1);
  }
}

}  // namespace

TEST_CASE("no pipeline of the corpus crashes, hangs or leaves a hazard") { replay("pipeline", firn::fuzz::check_pipeline); }
TEST_CASE("no scene of the corpus crashes or hangs") { replay("scene", firn::fuzz::check_scene); }
TEST_CASE("no stage file of the corpus crashes, hangs or leaves a hazard") { replay("stage", firn::fuzz::check_stage); }
TEST_CASE("no array of the corpus crashes or hangs") { replay("array", firn::fuzz::check_array); }
TEST_CASE("no image of the corpus crashes or hangs") { replay("image", firn::fuzz::check_image); }
TEST_CASE("no mesh of the corpus crashes or hangs") { replay("mesh", firn::fuzz::check_mesh); }
TEST_CASE("no STL mesh of the corpus crashes or hangs") { replay("stl", firn::fuzz::check_stl); }
TEST_CASE("no checkpoint of the corpus crashes or hangs") { replay("checkpoint", firn::fuzz::check_checkpoint); }
TEST_CASE("no manifest of a run of the corpus crashes or hangs") { replay("manifest", firn::fuzz::check_manifest); }
