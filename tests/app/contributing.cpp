// The program with the stage that CONTRIBUTING.md adds (tests/contributing.cmake builds it from the text).

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>

#include "scene/npy.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"

namespace {

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::read_file;

Outcome run_contributed(const std::string& words, const Folder& folder) {
  const std::string out = folder / "out.log", err = folder / "err.log";
  const int state = std::system(("cd '" + folder / "" + "' && FIRN_DATA='" FIRN_CONTRIBUTED_DATA "' '" FIRN_CONTRIBUTED "' " +
                                 words + " > '" + out + "' 2> '" + err + "'")
                                    .c_str());
  return {WIFEXITED(state) ? WEXITSTATUS(state) : -1, read_file(out), read_file(err)};
}

}  // namespace

TEST_CASE("a stage added as CONTRIBUTING says is listed, set, checked, ordered and run", "[app]") {
  const Folder folder;
  folder.write("scene.yaml", firn::test::small_scene);
  folder.write("pipeline.yaml", "firn: 1\nscene: scene.yaml\nsetup: [mpm.seed]\nstep:\n  - mpm.damp: {rate: 2}\n");
  CHECK(run_contributed("list", folder).out.find("mpm.damp") != std::string::npos);
  CHECK(run_contributed("inspect mpm.damp", folder).out.find("share of speed lost per second") != std::string::npos);

  const Outcome run = run_contributed("run pipeline.yaml --set mpm.damp.rate=500 --steps 10 --dump velocity=v.npy", folder);
  INFO(run.err);
  REQUIRE(run.status == 0);
  const firn::scene::NpyArray velocity = firn::scene::read_npy(folder / "v.npy");
  REQUIRE(velocity.values.size() > 100);
  for (std::size_t i = 0; i < velocity.values.size(); i += 3) {
    CHECK(velocity.values[i] == 0);
    CHECK(velocity.values[i + 1] == Approx(-3 * std::exp(-500 * 10 * 2e-4)).epsilon(1e-5));
  }

  const Outcome refused = run_contributed("check pipeline.yaml --set mpm.damp.rate=5000", folder);
  CHECK(refused.status == 2);
  CHECK(refused.err.find("rate must be between 0 and 1000, not 5000") != std::string::npos);

  folder.write("pipeline.yaml", "firn: 1\nscene: scene.yaml\nsetup: [mpm.seed]\nstep: [mpm.damp, mpm.advect]\n");
  CHECK(run_contributed("explain pipeline.yaml", folder).out.find("velocity: written by mpm.damp, read by mpm.advect") !=
        std::string::npos);
}
