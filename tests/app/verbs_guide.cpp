// docs/verbs.md, followed to the letter.

#include "scene/npy.h"
#include "tests/app/documents.h"

namespace {

namespace fs = std::filesystem;

using firn::test::Folder;
using firn::test::read_file;

// A clone in which the commands of some sections have been run.
void follow(const Folder& clone, const std::vector<std::string>& sections) {
  fs::create_symlink(FIRN_PROGRAM, clone / "firn");
  fs::copy(fs::path(FIRN_SOURCE_DIR) / "pipelines", clone / "pipelines", fs::copy_options::recursive);
  const std::string text = read_file(FIRN_SOURCE_DIR "/docs/verbs.md");
  for (const std::string& section : sections) {
    CAPTURE(section);
    const std::size_t begin = text.find("## " + section + "\n");
    REQUIRE(begin != std::string::npos);
    int commands = 0;
    for (const firn::test::Block& block : firn::test::blocks_of(text.substr(begin, text.find("\n## ", begin) - begin)))
      if (block.language == "sh") {
        ++commands;
        firn::test::run_commands(block.text, clone);
      }
    CHECK(commands > 0);
  }
}

}  // namespace

TEST_CASE("the commands that look at one stage do what their document says", "[app]") {
  const Folder clone;
  const std::vector<float> overlap(36, 0.1F), velocity{1, 0, 0};
  const std::vector<std::int32_t> owner(36);
  firn::scene::write_npy(clone / "overlap.npy", {6, 6}, std::span<const float>(overlap));
  firn::scene::write_npy(clone / "owner.npy", {6, 6}, std::span<const std::int32_t>(owner));
  firn::scene::write_npy(clone / "velocity.npy", {1, 3}, std::span<const float>(velocity));
  follow(clone, {"What there is: `list` and `inspect`", "One stage alone: `try`"});
  CHECK(firn::scene::read_npy(clone / "weight.npy").values.size() == 36);
}

TEST_CASE("the commands that compare pipelines leave what their document says", "[app]") {
  const Folder clone;
  follow(clone, {"compare"});
  for (const char* folder : {"out/compare-heightfield_contour-heightfield_distance/", "out/compare-mpm_snow-mpm_snow/", "out/two/"})
    for (const char* file : {"index.html", "a.png", "b.png", "difference.png", "comparison.json"}) {
      CAPTURE(folder, file);
      CHECK(fs::exists(clone / (folder + std::string(file))));
    }
}

TEST_CASE("the commands that print schemas leave what their document says", "[app]") {
  const Folder clone;
  follow(clone, {"schema"});
  CHECK(read_file(clone / "pipeline.json") == read_file(FIRN_SOURCE_DIR "/pipelines/schema/pipeline.json"));
}
