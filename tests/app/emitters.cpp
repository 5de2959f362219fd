// Runs whose number of particles changes: their metrics, checkpoints and exports, and the verbs that look at them.

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/inputs.h"
#include "tests/app/manifests.h"
#include "tests/catch.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

const std::string scene = R"(firn: 1
name: come_and_go
time: {dt: 1.0e-3, fps: 100, end: 0.12}
domain: {min: [0, 0, 0], max: [1.5, 1, 1], cell: 0.05}
materials: {light: {preset: new_snow, density: 100, young: 1.0e4}}
emitters:
  - {snowfall: {center: [0.8, 0.8, 0.5], size: [0.5, 0.4], rate: 5, velocity: [0, -2, 0]}, material: light, from: 0.01}
  - {gun: {position: [0.3, 0.6, 0.5], direction: [1, 0.3, 0], speed: 4, spread: 5, radius: 0.05, rate: 2}, material: light}
sinks: [{box: {min: [0.6, 0.1, 0], max: [1.5, 0.7, 1]}}]
max_particles: 120
bodies: [{plane: {point: [0, 0.2, 0], normal: [0, 1, 0]}, friction: 0.5}]
)";

Outcome succeed(const Words& words) {
  Outcome outcome = run_firn(words);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  return outcome;
}

// By column.
std::map<std::string, std::vector<double>> metrics_in(const fs::path& run) {
  std::istringstream lines(read_file(run / "metrics.csv"));
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::size_t column = 0;
    const bool is_header = names.empty();
    for (std::string cell; std::getline(cells, cell, ','); ++column)
      if (is_header)
        names.push_back(cell);
      else
        columns[names.at(column)].push_back(std::stod(cell));
  }
  return columns;
}

// Buffers of particles in a checkpoint that repeat from run to run, with their hashes.
std::string particles_in(const fs::path& checkpoint) {
  std::istringstream lines(read_file(checkpoint / "SHA256SUMS"));
  std::string state;
  for (std::string line; std::getline(lines, line);)
    for (const char* name : {" position.", " velocity.", " elastic.", " plastic_det.", " mass.", " emit", " removed_mass."})
      if (line.find(name) != std::string::npos) state += line + "\n";
  return state;
}

}  // namespace

TEST_CASE("metrics tell how many particles there are, and what came less what went is what there is", "[app]") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  const Folder folder;
  const Outcome outcome = succeed(run_without_pictures(pipeline, folder.write("scene.yaml", scene), folder / "out"));
  INFO(outcome.err);
  auto metrics = metrics_in(folder / "out");
  REQUIRE(metrics["mass"].size() == 13);
  CHECK(metrics["particles"].front() == 0);
  CHECK(metrics["mass"].front() == 0);
  CHECK(metrics["max_jp"].front() == 1);
  for (std::size_t frame = 0; frame < 13; ++frame)
    CHECK(metrics["mass"][frame] == Approx(metrics["emitted_mass"][frame] - metrics["removed_mass"][frame]).epsilon(1e-8));
  CHECK(metrics["removed_mass"].back() > 0);
  CHECK(*std::ranges::max_element(metrics["particles"]) == 120);
  // Told once, however many frames it holds for.
  const std::string warning = "as many as max_particles of the scene allows";
  const std::size_t told = outcome.err.find(warning);
  REQUIRE(told != std::string::npos);
  CHECK(outcome.err.find(warning, told + 1) == std::string::npos);
}

TEST_CASE("a run whose particles come and go goes on from a checkpoint to the bit", "[app]") {
  const std::string pipeline = GENERATE("mpm_snow", "mpm_thesis", "mpm_apic");
  CAPTURE(pipeline);
  const Folder folder;
  const std::string file = folder.write("scene.yaml", scene);
  const fs::path whole = folder / "whole", halved = folder / "halved";
  succeed(run_without_pictures(pipeline, file, whole.string(), {"--checkpoint-every", "15", "--keep-checkpoints", "9"}));
  succeed(run_without_pictures(pipeline, file, halved.string(), {"--checkpoint-every", "15", "--steps", "50"}));
  succeed({"run", "--resume", (halved / "checkpoints/step_00000045").string(), "--steps", "120"});
  const auto particles = [&](const fs::path& run, const char* step) {
    return manifest_in(run / "checkpoints" / step).at("sizes").at("particles").get<int>();
  };
  CHECK(particles(whole, "step_00000045") != particles(whole, "step_00000120"));
  for (const char* step : {"step_00000090", "step_00000105", "step_00000120"}) {
    CAPTURE(step);
    CHECK(particles(halved, step) == particles(whole, step));
    CHECK(particles_in(halved / "checkpoints" / step) == particles_in(whole / "checkpoints" / step));
    CHECK(particles_in(whole / "checkpoints" / step).find("emitter_next") != std::string::npos);
  }
  for (const char* column : {"particles", "mass", "emitted_mass", "removed_mass", "kinetic_energy"})
    CHECK(metrics_in(halved)[column] == metrics_in(whole)[column]);
}

TEST_CASE("exports hold the particles that there are, even none", "[app]") {
  const Folder folder;
  const std::string file = folder.write("scene.yaml", scene);
  succeed(run_without_pictures("mpm_snow", file, folder / "out",
                               {"--frames", "5", "--export", "particles:vtp", "--export", "particles:npy", "--export", "surface",
                                "--dump", "position=" + (folder / "position.npy")}));
  const fs::path exports = fs::path(folder / "out") / "export";
  const auto text_of = [&](const char* frame) { return read_file(exports / (std::string("particles_") + frame + ".vtp")); };
  const auto points = [&](const char* frame) {
    const std::string text = text_of(frame), start = "NumberOfPoints=\"";
    const std::size_t at = text.find(start);
    REQUIRE(at != std::string::npos);
    const int count = std::stoi(text.substr(at + start.size()));
    CHECK(text.find("NumberOfVerts=\"" + std::to_string(count) + "\"") != std::string::npos);
    return count;
  };
  const auto metrics = metrics_in(folder / "out");
  CHECK(points("0000") == 0);
  for (const char* array : {"velocity", "J_P", "stress_norm", "material"})
    CHECK(text_of("0000").find(std::string("Name=\"") + array + "\"") != std::string::npos);
  CHECK(read_file(exports / "particles_0000_J_P.npy").find("'shape': (0,)") != std::string::npos);
  CHECK(points("0003") == metrics.at("particles")[3]);
  CHECK(points("0004") == metrics.at("particles")[4]);
  CHECK(read_file(folder / "position.npy").find("'shape': (" + std::to_string(points("0004")) + ", 3)") != std::string::npos);
}

TEST_CASE("compare, profile and try bear particles that come and go", "[app]") {
  const Folder folder;
  const std::string file = folder.write("scene.yaml", scene);
  const Outcome compared = succeed({"compare", "mpm_snow", "mpm_thesis", "--scene", file, "--frames", "4", "--image", "64x48"});
  CHECK(compared.out.find("position") != std::string::npos);
  succeed({"profile", "mpm_snow", "--scene", file, "--steps", "2", "--image", "64x48"});
  succeed({"explain", "mpm_snow", "--scene", file});
  for (const char* stage : {"mpm.emit", "mpm.remove"}) {
    const Outcome tried = run_firn({"try", stage});
    INFO(tried.err);
    CHECK((tried.status == 0 || tried.status == 2));
    CHECK(succeed({"inspect", stage}).out.find("Makes particles come and go") != std::string::npos);
  }
}
