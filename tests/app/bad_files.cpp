#include <algorithm>

#include "tests/app/bad_tables.h"
#include "tests/catch.h"

namespace {

using firn::test::Bad;
using firn::test::Folder;
using firn::test::Outcome;
using firn::test::small_pipeline;
using firn::test::small_scene;
using firn::test::spoil;
using firn::test::Spoilt;

// Some line of `text` begins with `place: error: ` and contains `fragment`.
bool tells(const std::string& text, const std::string& place, const std::string& fragment) {
  const std::string start = place + ": error: ";
  for (auto at = text.find(start); at != std::string::npos; at = text.find(start, at + 1)) {
    const std::string line = text.substr(at, text.find('\n', at) - at);
    if ((at == 0 || text[at - 1] == '\n') && line.find(fragment) != std::string::npos) return true;
  }
  return false;
}

void check_bad(const Folder& folder, const std::string& file, const std::string& text, const Bad& bad) {
  const Spoilt spoilt = spoil(text, bad);
  folder.write("pipeline.yaml", small_pipeline);
  folder.write("scene.yaml", small_scene);
  folder.write(file, spoilt.text);
  const Outcome outcome = firn::test::run_firn({"check", folder / "pipeline.yaml"});
  INFO(bad.from << " -> " << bad.to);
  INFO("expected: " << file << ":" << spoilt.place << ": error: ..." << bad.fragment);
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, folder / (file + ":" + spoilt.place), bad.fragment));
  CHECK(outcome.out.empty());
}

}  // namespace

TEST_CASE("the files that the tables of bad ones are made of are good", "[app]") {
  const Folder folder;
  folder.write("pipeline.yaml", small_pipeline);
  folder.write("scene.yaml", small_scene);
  const Outcome outcome = firn::test::run_firn({"check", folder / "pipeline.yaml"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(outcome.err.find("error") == std::string::npos);
}

TEST_CASE("every mistake in a pipeline is told at its place, with what would be right", "[app]") {
  const Folder folder;
  folder.write("other.yaml", "firn: 1\ninclude: pipeline.yaml\n");
  for (const Bad& bad : firn::test::bad_pipelines()) check_bad(folder, "pipeline.yaml", small_pipeline, bad);
}

TEST_CASE("every mistake in a scene is told at its place, with what would be right", "[app]") {
  const Folder folder;
  for (const Bad& bad : firn::test::bad_scenes()) check_bad(folder, "scene.yaml", small_scene, bad);
}

TEST_CASE("what is no pipeline or scene at all is told so", "[app]") {
  const Folder folder;
  const std::string pipeline = folder.write("pipeline.yaml", small_pipeline);
  const std::string scene = folder.write("scene.yaml", small_scene);
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), zeros(64, '\0');
  const struct {
    std::string file, place, fragment;
  } table[] = {
      {folder.write("picture.png", png), ":1:1", "not a text in UTF-8"},
      {folder.write("zeros", zeros), ":1:1", "control character"},
      {folder.write("latin.yaml", "firn: 1\nname: Schneeb\xe4lle\n"), ":2:14", "not a text in UTF-8"},
      {folder.write("empty.yaml", ""), "", "empty"},
      {folder.write("number.yaml", "3\n"), ":1:1", "must be a map"},
      {folder.write("list.yaml", "- 1\n- 2\n"), ":1:1", "must be a map"},
      {folder / "nothing.yaml", "", "no such file"},
      {folder / "", "", "a directory"},
  };
  for (const auto& bad : table) {
    for (const firn::test::Words& words : {firn::test::Words{"check", bad.file}, {"check", pipeline, "--scene", bad.file}}) {
      const Outcome outcome = firn::test::run_firn(words);
      INFO(bad.file << ": expected " << bad.place << " ... " << bad.fragment);
      INFO(outcome.err);
      CHECK(outcome.status == 2);
      CHECK(tells(outcome.err, bad.file + bad.place, bad.fragment));
    }
  }
}

TEST_CASE("a name that no file system takes is no file, wherever it stands", "[app]") {
  const Folder folder;
  const std::string longest(5000, 'a');
  const std::string pipeline = folder.write("pipeline.yaml", "firn: 1\nscene: " + longest + "\nstep: [mpm.advect]\n");
  CHECK(firn::test::run_firn({"check", pipeline}).status == 2);
  CHECK(firn::test::run_firn({"check", longest}).status == 2);
  CHECK(firn::test::run_firn({"check", "mpm_snow", "--scene", longest}).status == 2);
}

TEST_CASE("a scene with neither snow nor field is told that there is nothing to simulate", "[app]") {
  const Folder folder;
  const std::string pipeline = folder.write("pipeline.yaml", small_pipeline);
  const std::string scene = folder.write("scene.yaml", "firn: 1\nname: void\n");
  const Outcome outcome = firn::test::run_firn({"check", pipeline});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, scene + ":1:1", "nothing to simulate"));
}

TEST_CASE("two pipelines that include each other are told where the circle closes", "[app]") {
  const Folder folder;
  const std::string one = folder.write("one.yaml", "include: two.yaml\nfirn: 1\n");
  const std::string two = folder.write("two.yaml", "include: one.yaml\nfirn: 1\n");
  const Outcome outcome = firn::test::run_firn({"check", one});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, two + ":1:10", "includes itself"));
}

TEST_CASE("an absurd grid is told with its count and memory, at once and without taking the memory", "[app]") {
  const Folder folder;
  const std::string pipeline = folder.write("pipeline.yaml", small_pipeline);
  folder.write("scene.yaml", small_scene);
  const Outcome outcome = firn::test::run_firn({"check", pipeline, "--set", "scene.domain.cell=1e-5"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("a grid of 7.2e+14 nodes") != std::string::npos);
  CHECK(outcome.err.find("GiB") != std::string::npos);
  CHECK(outcome.peak_kilobytes < 200000);
}

TEST_CASE("two errors in a pipeline and one in its scene are all told at once", "[app]") {
  const Folder folder;
  const Spoilt first = spoil(small_pipeline, {"- mpm.advect", "- @mpm.advct", ""});
  const Spoilt second = spoil(first.text, {"flip: 0.95", "flip: @2", ""});
  const Spoilt third = spoil(small_scene, {"mass: 2", "mass: @-2", ""});
  const std::string pipeline = folder.write("pipeline.yaml", second.text);
  const std::string scene = folder.write("scene.yaml", third.text);
  const Outcome outcome = firn::test::run_firn({"check", pipeline});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, pipeline + ":" + first.place, "mpm.advect"));
  CHECK(tells(outcome.err, pipeline + ":" + second.place, "flip"));
  CHECK(tells(outcome.err, scene + ":" + third.place, "mass"));
}
