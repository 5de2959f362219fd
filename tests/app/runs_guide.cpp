// The Python in docs/runs.md reads checkpoints.

#include <fmt/format.h>

#include <filesystem>

#include "scene/npy.h"
#include "stages/process.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"

using namespace firn::test;
namespace fs = std::filesystem;
using firn::stages::find_program;

TEST_CASE("the Python of the guide reads a checkpoint", "[app]") {
  const Folder folder;
  // The distribution's own, which has the distribution's NumPy.
  const fs::path program = fs::exists("/usr/bin/python3") ? fs::path("/usr/bin/python3") : find_program("python3");
  const auto python = [&](const std::vector<std::string>& words) {
    const std::string said = folder / "said";
    fs::remove(said);
    if (firn::stages::Process(program, words, said, said).finish() != 0) return "failed: " + read_file(said);
    return read_file(said);
  };
  if (program.empty() || find_program("zstd").empty() || !python({"-c", "import numpy"}).empty()) {
    WARN("NumPy or zstd is not installed: not tested");
    return;
  }
  const Outcome outcome =
      run_firn(run_without_pictures("mpm_snow", folder.write("scene.yaml", small_scene), folder / "out",
                                    {"--steps", "4", "--checkpoint-every", "4", "--dump", "position=" + (folder / "position.npy"),
                                     "--dump", "mass=" + (folder / "mass.npy")}));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const std::string guide = read_file(FIRN_SOURCE_DIR "/docs/runs.md"), begin = "```python\n";
  const std::size_t at = guide.find(begin) + begin.size();
  const std::string code = guide.substr(at, guide.find("```", at) - at);
  const std::string said = python({folder.write("read.py", code), folder / "out/checkpoints/step_00000004"});
  INFO(said);
  const firn::scene::NpyArray mass = firn::scene::read_npy(folder / "mass.npy"),
                              position = firn::scene::read_npy(folder / "position.npy");
  double total = 0, height = 0;
  for (std::size_t i = 0; i < mass.values.size(); ++i) {
    total += mass.values[i];
    height += mass.values[i] * position.values[3 * i + 1];
  }
  CHECK(said.starts_with("step 4 at 0.0008"));
  double said_total = 0, x = 0, y = 0, z = 0;
  const std::size_t particles = said.find('\n') + 1;
  int count = 0;
  REQUIRE(std::sscanf(said.c_str() + particles, "%d particles of %lf kg about [%lf %lf %lf]", &count, &said_total, &x, &y, &z) ==
          5);
  CHECK(count == static_cast<int>(mass.values.size()));
  CHECK(said_total == Approx(total).epsilon(1e-5));
  CHECK(y == Approx(height / total).epsilon(1e-4));
}
