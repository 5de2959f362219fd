#include <csignal>

#include "tests/app/inputs.h"
#include "tests/app/manifests.h"
#include "tests/catch.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::run_firn;
using firn::test::run_without_pictures;
using firn::test::small_scene;
using firn::test::Words;

namespace {

nlohmann::json result_in(const Folder& folder) { return firn::test::manifest_in(folder / "out").at("result"); }

// Runs on the small scene with `more` words, expects that the numbers break, and that manifest and message agree.
void check_broken(const std::string& pipeline, const Words& more, const Words& fragments) {
  const Folder folder;
  const Outcome outcome = run_firn(run_without_pictures(pipeline, folder.write("scene.yaml", small_scene), folder / "out", more));
  INFO(outcome.err);
  CHECK(outcome.status == 4);
  for (const std::string& fragment : fragments) {
    INFO("expected: " << fragment);
    CHECK(outcome.err.find(fragment) != std::string::npos);
  }
  const nlohmann::json result = result_in(folder);
  CHECK(result.at("exit_status") == 4);
  CHECK(outcome.err.find(result.at("message").get<std::string>()) != std::string::npos);
}

}  // namespace

TEST_CASE("a device without OpenGL 4.3 ends with status 3 and says what is needed and offered", "[app]") {
  const Folder folder;
  const Outcome outcome = run_firn(run_without_pictures("mpm_snow", folder.write("scene.yaml", small_scene), folder / "out"),
                                   {{"MESA_GL_VERSION_OVERRIDE", "4.2"}});
  INFO(outcome.err);
  CHECK(outcome.status == 3);
  CHECK(outcome.err.find("OpenGL 4.3 is needed") != std::string::npos);
  CHECK(outcome.err.find("offers 4.2") != std::string::npos);
  CHECK(run_firn({"doctor"}, {{"MESA_GL_VERSION_OVERRIDE", "4.2"}}).status == 3);
}

TEST_CASE("an unknown device ends with status 3 and names those there are", "[app]") {
  const Folder folder;
  const Outcome outcome =
      run_firn(run_without_pictures("mpm_snow", folder.write("scene.yaml", small_scene), folder / "out", {"--device", "abacus"}));
  INFO(outcome.err);
  CHECK(outcome.status == 3);
  CHECK(outcome.err.find("abacus") != std::string::npos);
}

TEST_CASE("a grid beyond the device's storage blocks ends with status 3 and names buffer and bytes", "[app]") {
  const Folder folder;
  // 401 x 451 x 501 nodes; llvmpipe's storage blocks hold 2^27 bytes, and GPUs' hold more than this grid.
  const Outcome outcome = run_firn(run_without_pictures("mpm_thesis", folder.write("scene.yaml", small_scene), folder / "out",
                                                        {"--device", "software", "--set", "scene.domain.max=[20, 22.5, 25]"}));
  INFO(outcome.err);
  CHECK(outcome.status == 3);
  CHECK(outcome.err.find("buffer 'grid_mass' needs 362425404 bytes") != std::string::npos);
  CHECK(outcome.seconds < 20);
  CHECK(outcome.peak_kilobytes < 400000);
}

TEST_CASE("a snowball that flies out of the domain ends with status 4, naming stage, step and count", "[app]") {
  check_broken("mpm_snow", {"--set", "scene.snow.0.velocity=[0, 60, 0]"},
               {"mpm.advect found a particle outside the domain in step ", " case"});
}

TEST_CASE("numbers beyond the range of floats end with status 4, naming the stage", "[app]") {
  check_broken("mpm_thesis", {"--set", "scene.gravity=[0, 1.0e+39, 0]", "--steps", "3"},
               {" found a value that is not a finite number in step 0 ("});
}

TEST_CASE("too many particles for a fixed-point sum end with status 4", "[app]") {
  const Folder folder;
  // One place filled 150 times over, where sums are scaled for a crowd of 8 times the seeded one.
  std::string scene = small_scene.substr(0, small_scene.find("  - {sphere"));
  for (int i = 0; i < 150; ++i) scene += "  - {sphere: {center: [0.4, 0.45, 0.5], radius: 0.1}, material: ball, per_cell: 1}\n";
  const std::string file = folder.write("scene.yaml", scene);
  const Outcome outcome = run_firn(run_without_pictures("mpm_thesis", file, folder / "out", {"--steps", "1"}));
  INFO(outcome.err);
  CHECK(outcome.status == 4);
  CHECK(outcome.err.find("mpm.particles_to_grid found a sum or a list that outgrows the room kept for it in step 0") !=
        std::string::npos);
  CHECK(run_firn(run_without_pictures("mpm_thesis", file, folder / "out", {"--steps", "1", "--set", "accumulate=float"})).status ==
        0);
}

TEST_CASE("a run that is interrupted ends with status 130 and still writes its manifest", "[app]") {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Folder folder;
    const Outcome outcome = firn::test::run_firn_signalled(
        run_without_pictures("mpm_snow", folder.write("scene.yaml", small_scene), folder / "out", {"--steps", "1000000"}),
        "steps/s", signal);
    INFO(outcome.err);
    CHECK(outcome.status == 130);
    const nlohmann::json result = result_in(folder);
    CHECK(result.at("exit_status") == 130);
    CHECK(result.at("message") == "interrupted");
    CHECK(result.at("steps").get<int>() >= 1);
  }
}

TEST_CASE("a results folder that cannot be made ends with status 1 and is named", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  const Outcome outcome = run_firn(run_without_pictures("mpm_snow", scene, scene + "/out", {"--steps", "1"}));
  INFO(outcome.err);
  CHECK(outcome.status == 1);
  CHECK(outcome.err.find("cannot make the folder " + scene + "/out") != std::string::npos);
}
