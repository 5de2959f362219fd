// Runs with --export: gone on with, repeated, and asked for what the first run did not have.

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/app/inputs.h"
#include "tests/catch.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> exports_in(const fs::path& run) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(run / "export"))
    files[entry.path().filename().string()] = read_file(entry.path());
  return files;
}

struct Runs {
  Folder folder;
  std::string scene = folder.write("scene.yaml", small_scene);

  // Frames at every fifth step.
  void start(const std::string& name, const std::string& steps) const {
    succeed(run_without_pictures("mpm_snow", scene, folder / name,
                                 {"--steps", steps, "--checkpoint-every", "15", "--export", "particles", "--export", "bodies:poses",
                                  "--export", "grid:vti", "--export", "grid:vdb", "--set", "io.particles.compression=5"}));
  }
  static void succeed(const Words& words) {
    const Outcome outcome = run_firn(words);
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
  }
};

}  // namespace

TEST_CASE("a run with exports that goes on from a checkpoint leaves the files of one that was never interrupted", "[app]") {
  const Runs runs;
  runs.start("whole", "45");
  runs.start("halved", "23");
  Runs::succeed({"run", "--resume", runs.folder / "halved", "--steps", "45"});
  const auto whole = exports_in(runs.folder / "whole"), halved = exports_in(runs.folder / "halved");
  CHECK(whole.size() > 30);
  for (const auto& [name, bytes] : whole) {
    CAPTURE(name);
    REQUIRE(halved.contains(name));
    const bool same = halved.at(name) == bytes;
    CHECK(same);
  }
  CHECK(halved.size() == whole.size());
  // Named again on the command line, as in the first run, and with others besides.
  Words words = run_without_pictures("mpm_snow", runs.scene, runs.folder / "halved", {"--steps", "50", "--resume"});
  const Outcome without = run_firn(words);
  INFO(without.err);
  CHECK(without.status == 2);
  CHECK(without.err.find("the stage io.particles is no longer there") != std::string::npos);
  const Outcome more = run_firn({"run", "--resume", runs.folder / "halved", "--steps", "50", "--export", "heightfield"});
  INFO(more.err);
  CHECK(more.status == 2);
}

TEST_CASE("a run with exports is repeated with them, and they are compared", "[app]") {
  const Runs runs;
  runs.start("first", "12");
  const Outcome again = run_firn({"run", "--from", runs.folder / "first"});
  INFO(again.err << again.out);
  CHECK(again.status == 0);
  const auto first = exports_in(runs.folder / "first"), second = exports_in(runs.folder / "first-repeat");
  const bool same = first == second;
  CHECK(same);
  const auto outputs = nlohmann::json::parse(read_file(runs.folder / "first/manifest.json")).at("outputs");
  for (const auto& [name, bytes] : first) CHECK(outputs.contains("export/" + name));
  CHECK(again.out == std::to_string(outputs.size()) + " of " + std::to_string(outputs.size()) + " outputs are the same\n");

  const Outcome more =
      run_firn({"run", "--from", runs.folder / "first", "--export", "particles:ply", "--out", runs.folder / "more"});
  INFO(more.err << more.out);
  CHECK(more.status == 1);
  CHECK(more.out.find("new: export/particles_0000.ply\n") != std::string::npos);
}
