// Runs that go on from a checkpoint end as those that were never interrupted, to the bit.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "stages/process.h"
#include "tests/app/inputs.h"
#include "tests/app/manifests.h"
#include "tests/catch.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

void succeed(const Words& words) {
  const Outcome outcome = run_firn(words);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
}

std::string scene_for(const Folder& folder, const std::string& pipeline) {
  return folder.write("scene.yaml", pipeline.starts_with("heightfield") ? small_field : small_scene);
}

// The hashes of all buffers in a checkpoint, but for lists in no particular order and what is stored by them.
std::string state_in(const fs::path& checkpoint) {
  std::istringstream lines(read_file(checkpoint / "SHA256SUMS"));
  std::string state;
  for (std::string line; std::getline(lines, line);)
    if (std::ranges::none_of(std::array{"manifest.json", " active_blocks.", " block_", " particle_cell.", " order.", " packed_",
                                        " grid_", " active_tiles.", " flatten_tiles.", " leaving.", " waiting.", " woken."},
                             [&](const char* name) { return line.find(name) != std::string::npos; }))
      state += line + "\n";
  return state;
}

// The lines of one that the other has not: the buffers that differ.
std::string differing(const std::string& one, const std::string& other) {
  std::istringstream lines(one);
  std::string found;
  for (std::string line; std::getline(lines, line);)
    if (other.find(line) == std::string::npos) found += line + "\n";
  return found;
}

std::map<std::string, std::string> frames_in(const fs::path& run) {
  std::map<std::string, std::string> frames;
  for (const fs::directory_entry& entry : fs::directory_iterator(run / "frames"))
    frames[entry.path().filename().string()] = read_file(entry.path());
  return frames;
}

std::string metrics_in(const fs::path& run) {
  std::istringstream lines(read_file(run / "metrics.csv"));
  std::string text;
  for (std::string line; std::getline(lines, line);) text += line.substr(0, line.rfind(',')) + "\n";
  return text;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string frames_of_film(const Folder& folder, const fs::path& film) {
  const fs::path ffprobe = firn::stages::find_program("ffprobe"), said = folder / "said";
  fs::remove(said);
  firn::stages::Process(ffprobe,
                        {"-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0", film.string()},
                        said, "")
      .finish();
  return read_file(said);
}

}  // namespace

TEST_CASE("a run that goes on from a checkpoint leaves what one leaves that was never interrupted", "[app]") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic", "heightfield_contour", "heightfield_distance");
  CAPTURE(pipeline);
  const Folder folder;
  const fs::path whole = folder / "whole", halved = folder / "halved";
  const Words words{"run", pipeline, "--scene", scene_for(folder, pipeline), "--image", "64x48", "--checkpoint-every", "15"};
  const auto with = [&](Words more) {
    more.insert(more.begin(), words.begin(), words.end());
    return more;
  };
  succeed(with({"--out", whole.string(), "--steps", "45"}));
  succeed(with({"--out", halved.string(), "--steps", "23"}));
  // Pictures that a process drew which died after the checkpoint are drawn again.
  std::ofstream(halved / "frames/frame_0900.png") << "of a dead process";
  const Outcome resumed = run_firn({"run", "--resume", halved.string(), "--steps", "45"});
  INFO(resumed.err);
  REQUIRE(resumed.status == 0);
  CHECK(resumed.err.find("going on from") != std::string::npos);
  CHECK(resumed.err.find("step 15") != std::string::npos);

  CHECK(state_in(whole / "checkpoints/step_00000045") == state_in(halved / "checkpoints/step_00000045"));
  CHECK(state_in(whole / "checkpoints/step_00000045").size() > 1000);
  const bool same_frames = frames_in(whole) == frames_in(halved);
  CHECK(same_frames);
  CHECK(frames_in(whole).size() == 10);
  CHECK(metrics_in(whole) == metrics_in(halved));
  const nlohmann::json manifest = manifest_in(halved);
  CHECK(manifest.at("resumed_from") == nlohmann::json({"step_00000015"}));
  CHECK(manifest.at("result").at("steps") == 45);
  if (firn::stages::find_program("ffprobe").empty() || firn::stages::find_program("ffmpeg").empty()) {
    WARN("ffmpeg is not installed: the film is not tested");
    return;
  }
  CHECK(frames_of_film(folder, whole / "video.mp4") == "10\n");
  CHECK(frames_of_film(folder, halved / "video.mp4") == "10\n");
}

TEST_CASE("a run that is killed at any moment goes on to the same end", "[app]") {
  const bool at_length = std::getenv("FIRN_LONG") != nullptr;
  const int kills = at_length ? 50 : 3;
  const std::string pipeline = GENERATE("mpm_snow", "heightfield_contour");
  CAPTURE(pipeline, seed());
  std::mt19937_64 random(seed());
  const Folder folder;
  const std::string scene = scene_for(folder, pipeline);
  const fs::path whole = folder / "whole";
  const Words more{"--steps", "48", "--checkpoint-every", "4"};
  const auto words = [&](const fs::path& out) { return run_without_pictures(pipeline, scene, out.string(), more); };
  const Outcome uninterrupted = run_firn(words(whole));
  INFO(uninterrupted.err);
  REQUIRE(uninterrupted.status == 0);
  const std::string state = state_in(whole / "checkpoints/step_00000048");

  int killed = 0, resumed = 0;
  double longest = uninterrupted.seconds;  // that a process lives at most, as far as is known
  for (int attempt = 0; killed < kills; ++attempt) {
    CAPTURE(attempt, killed);
    REQUIRE(attempt < 20 * kills);
    const fs::path out = folder / fmt::format("killed_{}", attempt);
    // Every other one is killed for a second time, on its way from a checkpoint.
    for (int times = 0; times <= attempt % 2; ++times) {
      const bool goes_on = fs::exists(out / "checkpoints") &&
                           std::ranges::any_of(names_in(out / "checkpoints"),
                                               [](const auto& name) { return name.find(".part") == std::string::npos; });
      const double moment = std::uniform_real_distribution<double>(0, longest)(random);
      const Outcome dead = run_firn_killed(goes_on ? Words{"run", "--resume", out.string()} : words(out), moment);
      CHECK((dead.status == -1 || dead.status == 0));
      if (dead.status == -1)
        ++killed;
      else if (!goes_on)
        longest = std::min(longest, dead.seconds);
    }
    Outcome end = run_firn({"run", "--resume", out.string()});
    if (end.status == 2) {
      CHECK(end.err.find("there is no") != std::string::npos);  // it died before its first checkpoint
      end = run_firn(words(out));
    } else {
      ++resumed;
    }
    INFO(end.err);
    REQUIRE(end.status == 0);
    CHECK(differing(state_in(out / "checkpoints/step_00000048"), state) == "");
    CHECK(metrics_in(out) == metrics_in(whole));
    CHECK(names_in(out / "checkpoints").size() == 3);
    fs::remove_all(out);
  }
  if (at_length)
    WARN(fmt::format("{}: killed {} times; {} runs went on from a checkpoint, all to the same end", pipeline, killed, resumed));
}

TEST_CASE("an interrupted run leaves a checkpoint, names it, and goes on to the same end", "[app]") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene), out = folder / "out";
  const Outcome stopped =
      run_firn_signalled(run_without_pictures("mpm_snow", scene, out, {"--steps", "1000000"}), "steps/s", signal);
  INFO(stopped.err);
  CHECK(stopped.status == 130);
  const std::vector<std::string> names = names_in(folder / "out/checkpoints");
  REQUIRE(names.size() == 1);
  CHECK(stopped.err.find("checkpoints/" + names.front()) != std::string::npos);
  const int step = manifest_in(folder / "out").at("result").at("steps");
  CHECK(names.front() == fmt::format("step_{:08}", step));

  const std::string end = std::to_string(step + 20), resumed = folder / "resumed.npy", whole = folder / "whole.npy";
  succeed({"run", "--resume", out, "--steps", end, "--dump", "elastic=" + resumed});
  succeed(run_without_pictures("mpm_snow", scene, folder / "whole", {"--steps", end, "--dump", "elastic=" + whole}));
  const bool same = read_file(resumed) == read_file(whole);
  CHECK(same);
}

TEST_CASE("an interrupted run leaves no checkpoint where none are to be kept", "[app]") {
  const Folder folder;
  const Outcome stopped =
      run_firn_signalled(run_without_pictures("mpm_snow", folder.write("scene.yaml", small_scene), folder / "out",
                                              {"--steps", "1000000", "--keep-checkpoints", "0"}),
                         "steps/s", SIGINT);
  CHECK(stopped.status == 130);
  CHECK_FALSE(fs::exists(folder / "out/checkpoints"));
}

TEST_CASE("the newest checkpoints are kept, as many as were asked for", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  succeed(run_without_pictures("mpm_snow", scene, folder / "three", {"--steps", "10", "--checkpoint-every", "2"}));
  CHECK(names_in(folder / "three/checkpoints") == std::vector<std::string>{"step_00000006", "step_00000008", "step_00000010"});
  succeed(run_without_pictures("mpm_snow", scene, folder / "one",
                               {"--steps", "10", "--checkpoint-every", "3", "--keep-checkpoints", "1"}));
  CHECK(names_in(folder / "one/checkpoints") == std::vector<std::string>{"step_00000009"});
}

TEST_CASE("a run that goes back to an older checkpoint forgets the newer ones", "[app]") {
  const Folder folder;
  succeed(run_without_pictures("mpm_snow", folder.write("scene.yaml", small_scene), folder / "out",
                               {"--steps", "10", "--checkpoint-every", "2"}));
  succeed({"run", "--resume", folder / "out/checkpoints/step_00000006", "--steps", "9"});
  CHECK(names_in(folder / "out/checkpoints") == std::vector<std::string>{"step_00000006", "step_00000008"});
}

TEST_CASE("a run that is not the same any more does not go on, and what has changed is named", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene), out = folder / "out";
  const auto words = [&](const Words& more) { return run_without_pictures("mpm_snow", scene, out, more); };
  succeed(words({"--steps", "4", "--checkpoint-every", "2"}));
  const auto refused = [&](Words more, const std::string& fragment, const Variables& variables = {}) {
    more.push_back("--resume");
    const Outcome outcome = run_firn(words(more), variables);
    INFO(outcome.err);
    INFO("expected: " << fragment);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(fragment) != std::string::npos);
  };
  refused({"--set", "scene.gravity=[0, -1.62, 0]"}, "scene.gravity.1 is -1.62, was -9.81");
  refused({"--set", "scene.snow.0.per_cell=5"}, "scene.snow.0.per_cell is 5, was 4");
  refused({"--set", "mpm.grid_to_particles.flip=0.5"}, "mpm.grid_to_particles.flip is 0.5, was 0.95");
  refused({"--set", "kernel=quadratic"}, "mpm.gather_velocities.kernel is \"quadratic\", was \"cubic\"");
  refused({"--disable", "mpm.particle_collide"}, "the stage mpm.particle_collide is no longer there");
  fs::create_directories(folder / "data/shaders/mpm");
  std::ofstream(folder / "data/shaders/mpm/advect.comp") << read_file(FIRN_SOURCE_DIR "/shaders/mpm/advect.comp") << "// other\n";
  refused({}, "the shader of mpm.advect: mpm/advect.comp has changed", {{"FIRN_DATA", folder / "data"}});

  // What does not decide how it goes on may change.
  succeed(words({"--resume", "--steps", "6", "--barriers", "all", "--no-alias", "--dump", "position=" + (folder / "p.npy"), "--set",
                 "scene.time.end=3"}));
}

TEST_CASE("a scene's own file that has changed is named when a run is to go on", "[app]") {
  const Folder folder;
  std::string scene = small_field;
  scene.replace(scene.find("depth: 0.4"), 10, "depth: {image: drift.npy, metres: 0.4}");
  const std::string zeros(48 * 48 * 4, '\0');
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (48, 48), }";
  header.resize(117, ' ');
  const std::string npy = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n";
  folder.write("drift.npy", npy + zeros);
  const Words words = run_without_pictures("heightfield_contour", folder.write("scene.yaml", scene), folder / "out");
  const auto with = [&](Words more) {
    more.insert(more.begin(), words.begin(), words.end());
    return more;
  };
  succeed(with({"--steps", "4", "--checkpoint-every", "2"}));
  folder.write("drift.npy", npy + std::string(48 * 48, '\x3d') + zeros.substr(48 * 48));
  const Outcome outcome = run_firn(with({"--resume"}));
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("drift.npy has changed") != std::string::npos);
}

TEST_CASE("a run whose scene names files goes on from any folder, on its own scene and not one of that name there", "[app]") {
  const Folder folder;
  std::string scene = small_field;
  scene.replace(scene.find("depth: 0.4"), 10, "depth: {image: drift.npy, metres: 0.4}");
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (48, 48), }";
  header.resize(117, ' ');
  fs::create_directories(folder / "there");
  fs::create_directories(folder / "here");
  folder.write("there/drift.npy", std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n" + std::string(48 * 48 * 4, '\0'));
  folder.write("there/scene.yaml", scene);
  folder.write("here/scene.yaml", small_scene);
  const fs::path before = fs::current_path();
  fs::current_path(folder / "there");
  const Outcome first =
      run_firn(run_without_pictures("heightfield_contour", "scene.yaml", "out", {"--steps", "4", "--checkpoint-every", "2"}));
  fs::current_path(folder / "here");
  const Outcome resumed = run_firn({"run", "--resume", "../there/out", "--steps", "6"});
  const Outcome repeated = run_firn({"run", "--from", "../there/out"});
  fs::current_path(before);
  INFO(first.err << resumed.err << repeated.err << repeated.out);
  CHECK(first.status == 0);
  CHECK(resumed.status == 0);
  CHECK(repeated.status == 0);
}

TEST_CASE("a run does not go on to an end before its checkpoint", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene), out = folder / "out";
  succeed(run_without_pictures("mpm_snow", scene, out, {"--steps", "6", "--checkpoint-every", "4"}));
  const std::string metrics = read_file(folder / "out/metrics.csv");
  const Outcome outcome = run_firn({"run", "--resume", out, "--steps", "3"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("is at step 4, beyond --steps 3") != std::string::npos);
  CHECK(read_file(folder / "out/metrics.csv") == metrics);
  CHECK(run_firn({"run", "--resume", out, "--frames", "0"}).status == 2);
}

TEST_CASE("where there is no checkpoint, --resume says so", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  for (const Words& words : {Words{"run", "--resume", folder / "nothing"}, Words{"run", "--resume", scene},
                             run_without_pictures("mpm_snow", scene, folder / "out", {"--resume"})}) {
    const Outcome outcome = run_firn(words);
    INFO(outcome.err);
    CHECK(outcome.status == 2);
  }
  succeed(run_without_pictures("mpm_snow", scene, folder / "out", {"--steps", "2"}));
  const Outcome outcome = run_firn({"run", "--resume", folder / "out"});
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("there is no checkpoint in this folder") != std::string::npos);
}
