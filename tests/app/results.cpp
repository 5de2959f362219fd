#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/npy.h"
#include "tests/app/inputs.h"
#include "tests/app/manifests.h"
#include "tests/catch.h"

using firn::scene::NpyArray;
using firn::scene::NpyShape;
using firn::scene::read_npy;
using firn::test::Folder;
using firn::test::manifest_in;
using firn::test::Outcome;
using firn::test::read_file;
using firn::test::run_firn;
using firn::test::run_without_pictures;
using firn::test::small_scene;
using firn::test::Words;

namespace {

constexpr const char* dumped[] = {"position", "velocity", "elastic", "grid_mass", "grid_velocity"};

// The bytes of all dumped buffers after 30 steps, one after the other.
std::string state(const std::string& pipeline, const Words& more, const firn::test::Variables& variables = {}) {
  const Folder folder;
  Words words{"--steps", "30"};
  for (const std::string buffer : dumped) words.insert(words.end(), {"--dump", buffer + "=" + (folder / (buffer + ".npy"))});
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome =
      run_firn(run_without_pictures(pipeline, folder.write("scene.yaml", small_scene), folder / "out", words), variables);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  std::string bytes;
  for (const std::string buffer : dumped) bytes += read_file(folder / (buffer + ".npy"));
  REQUIRE(bytes.size() > 100000);
  return bytes;
}

}  // namespace

TEST_CASE("a run repeats to the bit: again, with one thread or two, and with every barrier", "[app]") {
  // Not CHECK(a == b): a failure would print the bytes.
  for (const char* pipeline : {"mpm_snow", "mpm_thesis"}) {
    CAPTURE(pipeline);
    const std::string first = state(pipeline, {});
    const bool again = state(pipeline, {}) == first;
    const bool one_thread = state(pipeline, {}, {{"LP_NUM_THREADS", "1"}}) == first;
    const bool two_threads = state(pipeline, {}, {{"LP_NUM_THREADS", "2"}}) == first;
    const bool every_barrier = state(pipeline, {"--barriers", "all"}) == first;
    CHECK(again);
    CHECK(one_thread);
    CHECK(two_threads);
    CHECK(every_barrier);
    const bool other_seed = state(pipeline, {"--set", "scene.seed=4"}) == first;
    CHECK_FALSE(other_seed);
  }
}

TEST_CASE("dumps have the shapes of their domains: (N, 3), (N, 3, 3), (nz, ny, nx)", "[app]") {
  const Folder folder;
  const auto file = [&](const std::string& name) { return folder / (name + ".npy"); };
  Words words{"--steps", "3"};
  for (const std::string buffer : dumped) words.insert(words.end(), {"--dump", buffer + "=" + file(buffer)});
  words.insert(words.end(), {"--dump", "material=" + file("material"), "--dump", "mass=" + file("mass")});
  const Outcome outcome =
      run_firn(run_without_pictures("mpm_snow", folder.write("scene.yaml", small_scene), folder / "out", words));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const nlohmann::json manifest = manifest_in(folder / "out");
  const std::uint64_t count = manifest.at("sizes").at("particles");
  CHECK(count > 100);
  const NpyArray position = read_npy(file("position")), elastic = read_npy(file("elastic")), mass = read_npy(file("mass")),
                 grid_mass = read_npy(file("grid_mass"));
  CHECK(position.shape == NpyShape{count, 3});
  CHECK(elastic.shape == NpyShape{count, 3, 3});
  CHECK(grid_mass.shape == NpyShape{21, 19, 17});
  CHECK(read_npy(file("grid_velocity")).shape == NpyShape{21, 19, 17, 3});
  CHECK(read_npy(file("material")).kind == firn::scene::NpyKind::int32);

  // Values where they belong: the ball about its centre, the elastic deformation about the identity, the grid's mass the ball's,
  // about the ball's centre in the file's order of indices.
  for (std::size_t i = 0; i < count; ++i) {
    const double distance =
        std::hypot(position.values[3 * i] - 0.4, position.values[3 * i + 1] - 0.45, position.values[3 * i + 2] - 0.5);
    CHECK(distance < 0.13);
    CHECK(elastic.values[9 * i + 4] == Approx(1.0).margin(0.05));
    CHECK(elastic.values[9 * i + 1] == Approx(0.0).margin(0.05));
  }
  double total = 0, on_grid = 0, x = 0, y = 0, z = 0;
  for (const double m : mass.values) total += m;
  for (std::size_t k = 0, n = 0; k < 21; ++k)
    for (std::size_t j = 0; j < 19; ++j)
      for (std::size_t i = 0; i < 17; ++i, ++n) {
        const double m = grid_mass.values[n];
        on_grid += m;
        x += m * 0.05 * static_cast<double>(i);
        y += m * 0.05 * static_cast<double>(j);
        z += m * 0.05 * static_cast<double>(k);
      }
  CHECK(on_grid == Approx(total).epsilon(1e-4));
  CHECK(x / on_grid == Approx(0.4).margin(0.01));
  CHECK(y / on_grid == Approx(0.45).margin(0.01));
  CHECK(z / on_grid == Approx(0.5).margin(0.01));
}

TEST_CASE("the option --steps, --frames and the scene's end stop a run there, as its manifest tells", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  const auto result = [&](const Words& words) {
    const Outcome outcome = run_firn(run_without_pictures("mpm_thesis", scene, folder / "out", words));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return manifest_in(folder / "out").at("result");
  };
  CHECK(result({"--steps", "0"}).at("steps") == 0);
  const nlohmann::json seven = result({"--steps", "7"});
  CHECK(seven.at("steps") == 7);
  CHECK(seven.at("exit_status") == 0);
  CHECK(seven.at("simulated_seconds").get<double>() == Approx(7 * 2e-4));
  // A frame each 5 steps; the first stands before any step.
  const nlohmann::json frames = result({"--frames", "3"});
  CHECK(frames.at("frames") == 3);
  CHECK(frames.at("steps") == 10);
  CHECK(result({"--set", "scene.time.end=0.002"}).at("steps") == 10);
}

TEST_CASE("a manifest is written whatever bytes the command line has", "[app]") {
  const Folder folder;
  const std::string output = folder / "out\xff";
  const Outcome outcome =
      run_firn(run_without_pictures("mpm_thesis", folder.write("scene.yaml", small_scene), output, {"--steps", "1"}));
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(manifest_in(output).at("result").at("steps") == 1);
}

TEST_CASE("an automatic time step meets every frame and is as long as the CFL condition allows", "[app]") {
  for (const char* pipeline : {"mpm_snow", "mpm_thesis"}) {
    CAPTURE(pipeline);
    const Folder folder;
    const std::string scene = folder.write("scene.yaml", small_scene);
    const auto steps = [&](const std::string& cfl) {
      const Outcome outcome = run_firn(run_without_pictures(
          pipeline, scene, folder / "out", {"--set", "scene.time.dt=auto", "--set", "scene.time.cfl=" + cfl, "--frames", "6"}));
      INFO(outcome.err);
      REQUIRE(outcome.status == 0);
      const nlohmann::json result = manifest_in(folder / "out")["result"];
      CHECK(result["simulated_seconds"].get<double>() == Approx(0.005).margin(1e-9));
      return result["steps"].get<int>();
    };
    const int coarse = steps("0.4"), fine = steps("0.1");
    CAPTURE(coarse, fine);
    CHECK(fine > 2 * coarse);
    CHECK(coarse >= 5);
  }
}

TEST_CASE("a scene given as a pipeline is told as such, once", "[app]") {
  const Folder folder;
  const Outcome outcome = run_firn({"check", folder.write("scene.yaml", small_scene)});
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("this is a scene, not a pipeline") != std::string::npos);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}
