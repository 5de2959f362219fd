// The folder of a run: what lies in it, and that nothing in it is ever written over unasked.

#include "app/run_folder.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/sha256.h"
#include "tests/app/inputs.h"
#include "tests/app/manifests.h"
#include "tests/catch.h"

using namespace firn::test;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::vector<std::vector<std::string>> table_in(const fs::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(read_file(file));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
  }
  return rows;
}

}  // namespace

TEST_CASE("an earlier run in the folder moves away, and is replaced with --force alone", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  const auto run = [&](const Words& more) {
    const Outcome outcome = run_firn(run_without_pictures("mpm_snow", scene, folder / "out", more));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return outcome;
  };
  const auto steps = [&](const std::string& name) { return manifest_in(folder / name).at("result").at("steps").get<int>(); };
  run({"--steps", "1"});
  fs::create_directories(folder / "out/frames");
  folder.write("out/frames/holiday.jpg", "mine");
  const Outcome second = run({"--steps", "2"});
  CHECK(second.err.find("the earlier run in " + (folder / "out") + " is now in " + (folder / "out-1")) != std::string::npos);
  CHECK(steps("out-1") == 1);
  CHECK(steps("out") == 2);
  CHECK(fs::exists(folder / "out-1/frames/holiday.jpg"));
  run({"--steps", "3"});
  CHECK(steps("out-1") == 1);
  CHECK(steps("out-2") == 2);

  // What Firn has written goes, nothing else.
  fs::create_directories(folder / "out/frames");
  folder.write("out/frames/holiday.jpg", "mine");
  folder.write("out/frames/frame_0007.png", "of the earlier run");
  folder.write("out/notes.txt", "mine");
  run({"--steps", "4", "--force"});
  CHECK(steps("out") == 4);
  CHECK_FALSE(fs::exists(folder / "out-3"));
  CHECK(fs::exists(folder / "out/frames/holiday.jpg"));
  CHECK(fs::exists(folder / "out/notes.txt"));
  CHECK_FALSE(fs::exists(folder / "out/frames/frame_0007.png"));
}

TEST_CASE("files of one's own with names of a run's are not written over, with a manifest beside them or without", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  fs::create_directories(folder / "out/export");
  folder.write("out/metrics.csv", "mine");
  folder.write("out/export/particles_0000.ply", "mine");
  fs::create_directories(folder / "notes");
  folder.write("notes/list.txt", "mine");
  for (const char* out : {"out", "notes"})
    REQUIRE(run_firn(run_without_pictures("mpm_snow", scene, folder / out, {"--steps", "1", "--export", "particles:ply"})).status ==
            0);
  CHECK(read_file(folder / "out-1/metrics.csv") == "mine");
  CHECK(read_file(folder / "out-1/export/particles_0000.ply") == "mine");
  CHECK(fs::exists(folder / "notes/manifest.json"));
  CHECK(fs::exists(folder / "notes/list.txt"));
}

TEST_CASE("what is wrong with a mesh stands in the log of the run, too", "[app]") {
  const Folder folder;
  folder.write("open.obj", "v 0.5 0.5 0.5\nv 1.5 0.5 0.5\nv 0.5 1.5 0.5\nv 0.5 0.5 1.5\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const std::string scene = folder.write("scene.yaml",
                                         "firn: 1\ndomain: {min: [0, 0, 0], max: [2, 2, 2], cell: 0.1}\n"
                                         "snow: [{mesh: {file: open.obj}, material: packed}]\n");
  const Outcome outcome = run_firn(run_without_pictures("mpm_snow", scene, folder / "out", {"--steps", "1"}));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  REQUIRE(outcome.err.find("open edges") != std::string::npos);
  CHECK(read_file(folder / "out/log.jsonl").find("open edges") != std::string::npos);
}

TEST_CASE("two runs do not write to one folder at a time", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  REQUIRE(run_firn(run_without_pictures("mpm_snow", scene, folder / "out", {"--steps", "2", "--checkpoint-every", "2"})).status ==
          0);
  const firn::app::RunFolder held(folder / "out", firn::app::Claim::resume);
  for (const Words& more : {Words{}, Words{"--force"}, Words{"--resume"}}) {
    Words words{"--steps", "3"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_firn(run_without_pictures("mpm_snow", scene, folder / "out", words));
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find("another process is running in this folder") != std::string::npos);
  }
  CHECK(manifest_in(folder / "out").at("result").at("steps") == 2);
}

TEST_CASE("a run's manifest tells what was run, on what, and what came of it", "[app]") {
  const Folder folder;
  const std::string dump = folder / "position.npy";
  const Outcome outcome =
      run_firn({"run", "mpm_snow", "--scene", folder.write("scene.yaml", small_scene), "--out", folder / "out", "--image", "64x48",
                "--frames", "3", "--set", "mpm.grid_to_particles.flip=0.5", "--dump", "position=" + dump});
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const json manifest = manifest_in(folder / "out");
  CHECK(manifest.at("firn").is_string());
  CHECK(manifest.at("revision").contains("commit"));
  CHECK(manifest.at("revision").contains("changes"));
  CHECK(manifest.at("command").at(1) == "run");
  CHECK(manifest.at("inputs").at("frames") == 3);
  bool found = false;
  for (const json& stage : manifest.at("pipeline").at("stages"))
    if (stage.at("stage") == "mpm.grid_to_particles") found = stage.at("parameters").at("flip") == 0.5;
  CHECK(found);
  CHECK(manifest.at("scene").at("resolved").get<std::string>().find("friction: 0.5") != std::string::npos);
  CHECK(manifest.at("shaders").at("mpm.advect: mpm/advect.comp").get<std::string>().size() == 64);
  CHECK(manifest.at("device").at("limits").at("storage_block_bytes").get<std::uint64_t>() > 1000);
  CHECK(manifest.at("result").at("exit_status") == 0);
  const json& outputs = manifest.at("outputs");
  for (const char* name : {"frames/frame_0000.png", "frames/frame_0002.png"})
    CHECK(outputs.at(name) == firn::app::sha256(read_file(fs::path(folder / "out") / name)));
  CHECK(outputs.at("dump position") == firn::app::sha256(read_file(dump)));
  CHECK(outputs.contains("metrics.csv"));

  std::istringstream log(read_file(folder / "out/log.jsonl"));
  int frames = 0, messages = 0;
  std::string last;
  for (std::string line; std::getline(log, line);) {
    const json event = json::parse(line);
    CHECK(event.at("time").get<std::string>().ends_with("Z"));
    last = event.at("event");
    frames += last == "frame" ? 1 : 0;
    messages += last == "message" ? 1 : 0;
  }
  CHECK(frames == 3);
  CHECK(messages > 0);
}

TEST_CASE("metrics of particles add up: mass, momentum and energy of a ball that falls freely", "[app]") {
  const Folder folder;
  std::string scene = small_scene;
  scene.replace(scene.find("center: [0.4, 0.45, 0.5]"), 24, "center: [0.4, 0.65, 0.5]");
  scene = scene.substr(0, scene.find("bodies:"));
  const Outcome outcome =
      run_firn(run_without_pictures("mpm_snow", folder.write("scene.yaml", scene), folder / "out", {"--frames", "6"}));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const auto rows = table_in(folder / "out/metrics.csv");
  REQUIRE(rows.size() == 7);
  CHECK(rows.front() == std::vector<std::string>{"frame", "step", "time", "dt", "mass", "momentum_x", "momentum_y", "momentum_z",
                                                 "kinetic_energy", "potential_energy", "max_speed", "min_jp", "max_jp",
                                                 "steps_per_second"});
  const auto value = [&](std::size_t row, std::size_t column) { return std::stod(rows[row][column]); };
  for (std::size_t row = 1; row < rows.size(); ++row) {
    CAPTURE(row);
    const double time = value(row, 2), mass = value(row, 4), speed = 3 + 9.81 * time;
    CHECK(value(row, 0) == Approx(static_cast<double>(row - 1)));
    CHECK(value(row, 1) == Approx(5.0 * static_cast<double>(row - 1)));
    CHECK(mass == Approx(value(1, 4)));
    CHECK(value(row, 6) == Approx(-mass * speed).epsilon(1e-4));
    CHECK(value(row, 8) == Approx(0.5 * mass * speed * speed).epsilon(1e-3));
    CHECK(value(row, 8) + value(row, 9) == Approx(value(1, 8) + value(1, 9)).epsilon(1e-3));
    CHECK(value(row, 10) == Approx(speed).epsilon(1e-3));
    CHECK(value(row, 11) == Approx(1).margin(1e-3));
  }
  CHECK(value(1, 9) == Approx(value(1, 4) * 9.81 * 0.65).epsilon(0.02));
}

TEST_CASE("metrics of a height field tell its mass and its greatest depth", "[app]") {
  const Folder folder;
  const Outcome outcome = run_firn(
      run_without_pictures("heightfield_contour", folder.write("scene.yaml", small_field), folder / "out", {"--steps", "1"}));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const auto rows = table_in(folder / "out/metrics.csv");
  CHECK(rows.at(0) == std::vector<std::string>{"frame", "step", "time", "dt", "snow_mass", "max_depth", "min_density",
                                               "max_density", "steps_per_second"});
  CHECK(std::stod(rows.at(1).at(4)) == Approx(3 * 3 * 0.4 * 100).epsilon(1e-6));
  CHECK(std::stod(rows.at(1).at(5)) == Approx(0.4));
  CHECK(std::stod(rows.at(1).at(6)) == Approx(100));
}

TEST_CASE("a run is repeated from its manifest, and what is not the same is named", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene), manifest = folder / "out/manifest.json";
  const Outcome first = run_firn({"run", "mpm_snow", "--scene", scene, "--out", folder / "out", "--image", "64x48", "--steps", "12",
                                  "--set", "kernel=quadratic", "--dump", "position=" + (folder / "position.npy")});
  INFO(first.err);
  REQUIRE(first.status == 0);
  const Outcome again = run_firn({"run", "--from", manifest});
  INFO(again.err);
  CHECK(again.status == 0);
  CHECK(again.out.find(" outputs are the same") != std::string::npos);
  CHECK(again.out.find("different") == std::string::npos);
  CHECK(manifest_in(folder / "out-repeat").at("result").at("steps") == 12);
  CHECK(fs::exists(folder / "out-repeat/position.npy"));
  CHECK(manifest_in(folder / "out") == json::parse(read_file(manifest)));

  std::string other = small_scene;
  other.replace(other.find("[0, -3, 0]"), 10, "[0, -4, 0]");
  folder.write("scene.yaml", other);
  const Outcome changed = run_firn({"run", "--from", folder / "out", "--out", folder / "other"});
  INFO(changed.out);
  CHECK(changed.status == 1);
  for (const char* name : {"different: frames/frame_0002.png", "different: metrics.csv", "different: dump position"})
    CHECK(changed.out.find(name) != std::string::npos);
  CHECK(changed.err.find("scene.snow.0.velocity.1 is -4, was -3") != std::string::npos);
  const bool kept = read_file(folder / "position.npy") == read_file(folder / "out-repeat/position.npy");
  CHECK(kept);
  // Words of the command line go before those of the manifest.
  const Outcome words = run_firn({"run", "--from", folder / "out", "--out", folder / "words", "--image", "32x24", "--disable",
                                  "io.video", "--scene", folder.write("third.yaml", small_scene), "--no-alias"});
  INFO(words.err);
  const json said = manifest_in(folder / "words").at("inputs");
  CHECK(said.at("image") == "32x24");
  CHECK(said.at("disable") == json{"io.video"});
  CHECK(said.at("scene") == folder / "third.yaml");
  CHECK(said.at("share_memory") == false);
  CHECK(run_firn({"run", "--from", folder / "out", "--scene", folder / "none.yaml"}).status == 2);
  CHECK(run_firn({"run", "--from", scene}).status == 2);
  CHECK(run_firn({"run", "--from", folder / "nowhere"}).status == 2);
}
