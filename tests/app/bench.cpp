#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "app/statistics.h"
#include "stages/process.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::read_file;
using firn::test::run_firn;
using firn::test::Words;
using nlohmann::json;

namespace {

json benched(const std::string& name, const Words& more = {}) {
  Words words{"bench", name, "--sizes", "small", "--runs", "1", "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run_firn(words);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  return json::parse(outcome.out);
}

std::set<std::string> names_of(const json& list) {
  std::set<std::string> names;
  for (const json& one : list) names.insert(one.at("name"));
  return names;
}

}  // namespace

TEST_CASE("a result of bench has name, seconds, runs, rate and unit, and nothing else", "[app]") {
  const json report = benched("step/mpm_snow/50000");
  CHECK(report.size() == 2);
  CHECK(report.at("device").get<std::string>().size() > 3);
  REQUIRE(report.at("results").size() == 1);
  const json& result = report.at("results").at(0);
  CHECK(result.size() == 5);
  CHECK(result.at("name") == "step/mpm_snow/50000");
  CHECK(result.at("runs") == 1);
  CHECK(result.at("unit") == "particle-steps/s");
  const double particles = result.at("rate").get<double>() * result.at("seconds").get<double>();
  CHECK(particles == Approx(50000).epsilon(0.01));
}

TEST_CASE("what a machine cannot do is told, and does not fail the rest", "[app]") {
  const json report = benched("step/mpm_snow/box");
  std::set<std::string> told = names_of(report.at("results"));
  if (report.contains("not_possible"))
    for (const json& one : report.at("not_possible")) {
      CHECK(one.at("reason").get<std::string>().size() > 10);
      told.insert(one.at("name"));
    }
  CHECK(told == std::set<std::string>{"step/mpm_snow/box/100", "step/mpm_snow/box/200", "step/mpm_snow/box/2000"});
  CHECK(names_of(report.at("results")).contains("step/mpm_snow/box/100"));
}

TEST_CASE("transfers are measured by form and by the order of particles", "[app]") {
  const json report = benched("transfers/grid_to_particles");
  CHECK(names_of(report.at("results")) ==
        std::set<std::string>{"transfers/grid_to_particles/atomics_fixed/sorted",
                              "transfers/grid_to_particles/atomics_fixed/random", "transfers/grid_to_particles/texture/sorted",
                              "transfers/grid_to_particles/texture/random", "transfers/grid_to_particles/shared/sorted",
                              "transfers/grid_to_particles/shared/random"});
  for (const json& result : report.at("results"))
    CHECK(result.at("rate").get<double>() * result.at("seconds").get<double>() == Approx(62500).epsilon(0.03));
}

TEST_CASE("every form of particles to grid is measured, or why it cannot be is told", "[app]") {
  const json report = benched("transfers/particles_to_grid/subgroup");
  if (report.at("results").empty()) {
    REQUIRE(report.at("not_possible").size() == 2);
    for (const json& one : report.at("not_possible"))
      CHECK(one.at("reason").get<std::string>().find("GL_KHR_shader_subgroup_basic") != std::string::npos);
  }
  CHECK(benched("transfers/particles_to_grid/shared").at("results").size() == 2);
}

TEST_CASE("planning takes no device, and its time grows with the stages, not with their square", "[app]") {
  const Folder folder;
  const bool plots = !firn::stages::find_program("gnuplot").empty();
  const json report = benched("graph", plots ? Words{"--plots", folder / "plots"} : Words{});
  CHECK(report.at("device") == "none");
  REQUIRE(report.at("results").size() == 4);
  const auto rate = [&](std::size_t i) { return report.at("results").at(i).at("rate").get<double>(); };
  // Quadratic would be 10 times slower per stage.
  CHECK(rate(3) > rate(2) / 8);
  if (plots) CHECK(read_file(folder / "plots/graph.png").starts_with("\x89PNG"));
}

TEST_CASE("a benchmark that is not there is told before anything is done, with the nearest or its sizes", "[app]") {
  const struct {
    const char *name, *sizes, *fragment;
  } table[] = {
      {"grap", "full", "no benchmark 'grap'; did you mean 'graph'?"},
      {"step/mpm_snw", "full", "no benchmark 'step/mpm_snw'; did you mean 'step/mpm_snow'?"},
      {"step/mpm_snow/bx", "small", "did you mean 'step/mpm_snow/box'?"},
      {"qqqqqqqqqqqqqqqqqqqqqqqqq", "small", "; valid: transfers, step, two_snowballs, heightfield, barriers, graph, "},
      {"step/mpm_snow/box/400", "small", "no benchmark 'step/mpm_snow/box/400' with --sizes small: it is one of --sizes full"},
      {"step/mpm_snow/box/200", "full", "no benchmark 'step/mpm_snow/box/200' with --sizes full: it is one of --sizes small"},
      {"graph/10/more", "full", "no benchmark 'graph/10/more'; "},
      {"heightfield/contour/256/1/heightfield.overlp", "small", "did you mean 'heightfield/contour/256/1/heightfield.overlap'?"},
      {"heightfield/contour/256/1/nonsense", "small", "no benchmark 'heightfield/contour/256/1/nonsense'; "},
      {"heightfield/contour/1024/1/heightfield.overlap", "small", "it is one of --sizes full"},
  };
  for (const auto& bad : table) {
    const Folder folder;
    const Outcome outcome = run_firn({"bench", bad.name, "--sizes", bad.sizes, "--plots", folder / "plots"});
    INFO(bad.name << " " << outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.empty());  // no device, no heading
    CHECK(outcome.err.find(bad.fragment) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "plots"));
  }
}

TEST_CASE("one stage of a step is a benchmark", "[app]") {
  CHECK(names_of(benched("heightfield/contour/256/1/heightfield.overlap").at("results"))
            .contains("heightfield/contour/256/1/heightfield.overlap"));
}

TEST_CASE("plots that cannot be drawn are refused before anything is measured", "[app]") {
  const Folder folder;
  const auto refused = [&](const std::string& plots, const std::string& path, const std::string& fragment) {
    const Outcome outcome = run_firn({"bench", "graph", "--plots", plots}, {{"PATH", path}});
    INFO(outcome.err);
    CHECK(outcome.status == 1);
    CHECK(outcome.out.empty());
    CHECK(outcome.err.find(fragment) != std::string::npos);
  };
  refused(folder / "plots", folder / "nothing", "gnuplot is not installed");
  CHECK_FALSE(std::filesystem::exists(folder / "plots"));
  // Whatever is called gnuplot will do: it is not reached.
  std::filesystem::create_symlink("/bin/true", folder / "gnuplot");
  const std::string file = folder.write("file", "");
  refused(file, folder / "", "cannot make the folder " + file);
  refused(file + "/below", folder / "", "cannot make the folder " + file + "/below");
  refused("/proc/x", folder / "", "cannot make the folder /proc/x");
}

TEST_CASE("the median of an even number of values lies between the middle two", "[app]") {
  using firn::app::median;
  CHECK(median({}) == 0);
  CHECK(median({3}) == 3);
  CHECK(median({4, 1}) == 2.5);
  CHECK(median({9, 1, 5}) == 5);
  CHECK(median({8, 1, 100, 4}) == 6);
  CHECK(median({7, 7, 1, 7}) == 7);
}

TEST_CASE("doctor measures what the device can do", "[app]") {
  const Outcome outcome = run_firn({"doctor", "--json"});
  REQUIRE(outcome.status == 0);
  const json speed = json::parse(outcome.out).at("speed");
  // Wide bounds: from a busy laptop to far beyond any device of today.
  CHECK(speed.at("copy_bytes_per_second").get<double>() > 1e7);
  CHECK(speed.at("buffer_copy_bytes_per_second").get<double>() > 1e8);
  CHECK(speed.at("multiply_add_flop_per_second").get<double>() > 1e8);
  CHECK(speed.at("multiply_add_flop_per_second").get<double>() < 1e16);
  CHECK(speed.at("launch_seconds").get<double>() < 1e-2);
  CHECK(run_firn({"doctor"}).out.find("copy by a kernel, read and written") != std::string::npos);
}
