// What a run leaves where the disk is full: every file as a whole run has it, or none; and an error that names the first that is
// none.

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/checkpoint_files.h"
#include "app/files.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"
#include "tests/small_disk.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> files_in(const fs::path& run) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(run))
    if (entry.is_regular_file()) files[entry.path().lexically_relative(run).string()] = read_file(entry.path());
  return files;
}

// Those that tell of times by the clock are whole where they can be read; checkpoints have hashes of their own.
void check_whole(const std::string& name, const std::string& bytes, const std::map<std::string, std::string>& whole_run) {
  if (name.ends_with("manifest.json")) {
    CHECK(nlohmann::json::accept(bytes));
  } else if (name == "log.jsonl" || name == "metrics.csv") {
    CHECK((bytes.empty() || bytes.ends_with('\n')));
    std::istringstream lines(bytes);
    const std::string header = whole_run.at("metrics.csv").substr(0, whole_run.at("metrics.csv").find('\n'));
    for (std::string line; std::getline(lines, line);) {
      if (name == "log.jsonl") CHECK(nlohmann::json::accept(line));
      if (name == "metrics.csv") CHECK(std::ranges::count(line, ',') == std::ranges::count(header, ','));
    }
  } else if (name.ends_with(".mp4")) {
    CHECK(bytes.find("moov") != std::string::npos);  // a film up to where the disk was full; without this it is none
  } else if (!name.starts_with("checkpoints/") && !name.ends_with(".pvd") && !name.ends_with(".series")) {
    REQUIRE(whole_run.contains(name));
    const bool same = bytes == whole_run.at(name);
    CHECK(same);
  }
}

std::string complaint(const auto& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("lines and files that do not fit on the disk are refused by name and leave what was there", "[app]") {
  const Folder folder;
  const std::string file = folder.write("lines", "one\n"), other = folder.write("other", "as it was");
  firn::app::LineFile lines(file);
  lines.add("two\n");
  {
    const SmallDisk disk(10);
    CHECK(complaint([&] { lines.add("three\n"); }) == file + ": cannot be written: File too large");
    CHECK(complaint([&] { firn::app::replace_file(other, "eleven more"); }) == other + ".part: cannot be written: File too large");
  }
  CHECK(read_file(file) == "one\ntwo\n");
  lines.add("three\n");
  CHECK(read_file(file) == "one\ntwo\nthree\n");
  CHECK(read_file(other) == "as it was");
  CHECK_FALSE(fs::exists(other + ".part"));
}

TEST_CASE("where the disk is full every file is whole or absent, and the error names one that is absent", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", small_scene);
  const auto run = [&](const std::string& name) {
    Words words{"run",
                "mpm_snow",
                "--scene",
                scene,
                "--out",
                folder / name,
                "--image",
                "320x240",
                "--steps",
                "11",
                "--checkpoint-every",
                "5",
                "--set",
                "scene.snow.0.per_cell=64",
                "--dump",
                "elastic=" + (folder / name) + "/elastic.npy"};
    for (const char* each : {"particles:vtp", "particles:ply", "particles:npy", "grid:vti", "surface:ply", "bodies:vtp"})
      words.insert(words.end(), {"--export", each});
    return run_firn(words);
  };
  const Outcome unlimited = run("whole");
  INFO(unlimited.err);
  REQUIRE(unlimited.status == 0);
  const std::map<std::string, std::string> whole = files_in(folder / "whole");

  // One byte less than the largest file of a kind needs; files of one kind have their first frame's name.
  std::map<std::string, std::size_t> largest;
  for (const auto& [name, bytes] : whole) {
    const std::string kind = name.starts_with("checkpoints/")
                                 ? "checkpoint"
                                 : fs::path(name).stem().string().substr(0, 6) + fs::path(name).extension().string();
    largest[kind] = std::max(largest[kind], bytes.size());
  }
  CHECK(largest.size() > 8);
  for (const auto& [kind, size] : largest) {
    CAPTURE(kind, size);
    Outcome outcome;
    {
      const SmallDisk disk(size - 1);
      outcome = run("small");
    }
    INFO(outcome.err);
    std::set<std::string> too_large;
    for (const auto& [name, bytes] : whole)
      if (bytes.size() >= size) too_large.insert(name);
    const std::map<std::string, std::string> left = files_in(folder / "small");
    if (kind != "manife.json" && kind != "log.jsonl" && kind != "metric.csv") CHECK(outcome.status == 1);
    if (outcome.status != 0)
      CHECK(std::ranges::any_of(too_large, [&](const std::string& name) {
        const std::string stem = name.starts_with("checkpoints/") ? "checkpoints/" : name;
        return outcome.err.find((folder / "small") + "/" + stem) != std::string::npos;
      }));
    for (const auto& [name, bytes] : left) {
      CAPTURE(name);
      CHECK_FALSE(name.ends_with(".part"));
      check_whole(name, bytes, whole);
    }
    if (fs::exists(folder / "small/checkpoints"))
      for (const fs::directory_entry& each : fs::directory_iterator(folder / "small/checkpoints"))
        CHECK_NOTHROW(firn::app::verify_files(each.path()));
    fs::remove_all(folder / "small");
  }
}
