// docs/guide/, followed to the letter: every file that it has the reader write is written, every command that it names is run.

#include <regex>

#include "tests/app/documents.h"
#include "tests/catch.h"

namespace {

namespace fs = std::filesystem;

using firn::test::Block;
using firn::test::blocks_of;
using firn::test::Folder;
using firn::test::read_file;
using firn::test::run_commands;

const fs::path guide = fs::path(FIRN_SOURCE_DIR) / "docs/guide";

// What a chapter uses of a clone.
void follow(const std::string& chapter) {
  const Folder clone;
  fs::create_symlink(FIRN_PROGRAM, clone / "firn");
  fs::create_directory(clone / "mine");
  fs::copy(fs::path(FIRN_SOURCE_DIR) / "pipelines", clone / "pipelines", fs::copy_options::recursive);
  int commands = 0;
  for (const Block& block : blocks_of(read_file(guide / chapter))) {
    if (block.language == "sh") {
      ++commands;
      run_commands(block.text, clone);
    } else if (block.file.starts_with("mine/")) {
      clone.write(block.file, block.text);
    }
  }
  CHECK(commands > 0);
}

}  // namespace

TEST_CASE("chapter 1 of the guide, a first run, does what it says", "[app]") { follow("1-first-run.md"); }
TEST_CASE("chapter 2 of the guide, reading a pipeline, does what it says", "[app]") { follow("2-read-a-pipeline.md"); }
TEST_CASE("chapter 3 of the guide, swapping a method, does what it says", "[app]") { follow("3-swap-a-method.md"); }
TEST_CASE("chapter 4 of the guide, timing a pass, does what it says", "[app]") { follow("4-time-a-pass.md"); }
TEST_CASE("chapter 5 of the guide, writing a stage, does what it says", "[app]") { follow("5-write-a-stage.md"); }
TEST_CASE("chapter 6 of the guide, writing a scene, does what it says", "[app]") { follow("6-write-a-scene.md"); }

TEST_CASE("links of the guide lead to files, and all chapters are listed", "[app]") {
  const std::regex link("\\]\\(([^)#]+)");
  std::string contents;
  for (const auto& entry : fs::directory_iterator(guide)) {
    const std::string text = read_file(entry.path());
    for (auto found = std::sregex_iterator(text.begin(), text.end(), link); found != std::sregex_iterator(); ++found) {
      const std::string target = (*found)[1];
      CAPTURE(entry.path().string(), target);
      CHECK((target.starts_with("https://") || fs::exists(guide / target)));
    }
    if (entry.path().filename() == "README.md") contents = text;
  }
  for (const auto& entry : fs::directory_iterator(guide))
    if (entry.path().filename() != "README.md") CHECK(contents.find(entry.path().filename().string()) != std::string::npos);
}
