// Where compiled programs are kept, and that a run neither fails nor changes because of them.

#include "app/program_cache.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/app/child.h"
#include "tests/catch.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

Variables places(const Folder& folder, const std::string& cache) {
  return {{"FIRN_CACHE", cache},
          {"XDG_CACHE_HOME", folder / "xdg"},
          {"HOME", folder / "home"},
          {"MESA_SHADER_CACHE_DIR", folder / "mesa"}};
}

std::size_t programs_in(const fs::path& folder) {
  if (!fs::exists(folder)) return 0;
  std::size_t count = 0;
  for (const auto& file : fs::directory_iterator(folder)) count += file.path().extension() == ".program" ? 1 : 0;
  return count;
}

Words two_steps(const Folder& folder, const std::string& name) {
  return {"run",       "heightfield_contour",
          "--steps",   "2",
          "--image",   "32x32",
          "--disable", "io.video",
          "--set",     "scene.field.cells=[32, 32]",
          "--dump",    "depth=" + (folder / (name + ".npy")),
          "--out",     folder / name};
}

}  // namespace

TEST_CASE("FIRN_CACHE comes before XDG_CACHE_HOME, and that before the home folder", "[app]") {
  const Folder folder;
  const auto told = [&](const std::string& cache, const std::string& xdg, const std::string& home) {
    const Outcome outcome =
        run_firn({"doctor", "--json"},
                 {{"FIRN_CACHE", cache}, {"XDG_CACHE_HOME", xdg}, {"HOME", home}, {"MESA_SHADER_CACHE_DIR", folder / "mesa"}});
    REQUIRE(outcome.status == 0);
    return nlohmann::json::parse(outcome.out).at("compiled_programs").at("folder").get<std::string>();
  };
  const std::string own = folder / "own", xdg = folder / "xdg", home = folder / "home";
  CHECK(told(own, xdg, home) == own);
  CHECK(told("", xdg, home) == xdg + "/firn");
  CHECK(told("", "relative", home) == home + "/.cache/firn");
  CHECK(told("", "", home) == home + "/.cache/firn");
  CHECK(told("", "", "").empty());
  CHECK(told("off", xdg, home).empty());
}

TEST_CASE("a run keeps its programs, uses them again, and does without where they are damaged", "[app]") {
  const Folder folder;
  const std::string cache = folder / "kept";
  const auto run = [&](const std::string& name, const std::string& kept) {
    const Outcome outcome = run_firn(two_steps(folder, name), places(folder, kept));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    CHECK(outcome.err.find("program") == std::string::npos);  // not a word to the user
    return read_file(folder / (name + ".npy"));
  };
  const std::string without = run("off", "off");
  CHECK(programs_in(folder / "xdg/firn") == 0);
  CHECK(run("first", cache) == without);
  const std::size_t kept = programs_in(cache);
  if (kept == 0) return;  // the driver hands out none
  CHECK(run("second", cache) == without);
  CHECK(programs_in(cache) == kept);
  for (const auto& file : fs::directory_iterator(cache)) std::ofstream(file.path(), std::ios::app) << "damage";
  CHECK(run("third", cache) == without);
  CHECK(programs_in(cache) == kept);
  const Outcome doctor = run_firn({"doctor"}, places(folder, cache));
  CHECK(doctor.out.find(std::to_string(kept) + " in " + cache) != std::string::npos);
  CHECK(run("blocked", folder.write("a file", "")) == without);
}
