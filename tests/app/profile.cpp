#include "app/profile.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/inputs.h"
#include "tests/catch.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::read_file;
using firn::test::run_firn;
using firn::test::small_scene;
using firn::test::Words;
using nlohmann::json;

namespace {

constexpr int passes_of_mpm_snow = 14;  // in a step

Outcome profiled(const Folder& folder, const std::string& format, const Words& more = {}) {
  Words words{"profile", "mpm_snow", "--scene", folder.write("scene.yaml", small_scene), "--steps", "6", "--warm-up",
              "2",       "--format", format};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = run_firn(words);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  return outcome;
}

json pass_of(const json& profile, const std::string& work) {
  for (const json& pass : profile.at("passes"))
    if (pass.at("work") == work) return pass;
  FAIL("no pass " << work);
  return {};
}

}  // namespace

TEST_CASE("a profile tells time, bytes and bandwidth of every pass", "[app]") {
  const Folder folder;
  const json profile = json::parse(profiled(folder, "json", {"--cost"}).out);
  CHECK(profile.at("pipeline") == "mpm_snow");
  CHECK(profile.at("steps") == 6);
  CHECK(profile.at("clock").get<std::string>().find("clock") != std::string::npos);
  CHECK(profile.contains("cost"));
  double share = 0;
  for (const json& pass : profile.at("passes")) {
    CAPTURE(pass.dump());
    CHECK(pass.at("launches") == 6);
    CHECK(pass.at("median").get<double>() > 0);
    CHECK(pass.at("p90") >= pass.at("median"));
    share += pass.at("share").get<double>();
    const double bytes = pass.at("bytes_read").get<double>() + pass.at("bytes_written").get<double>();
    CHECK(pass.at("bytes_per_second").get<double>() == Approx(bytes / pass.at("median").get<double>()));
    const double copy = std::max(profile.at("speed").at("copy_bytes_per_second").get<double>(),
                                 profile.at("speed").at("buffer_copy_bytes_per_second").get<double>());
    CHECK(pass.at("share_of_copy").get<double>() == Approx(pass.at("bytes_per_second").get<double>() / copy));
  }
  CHECK(share == Approx(1));
}

TEST_CASE("a profile tells the share of the device's arithmetic rate where a stage says what it adds and multiplies", "[app]") {
  const Folder folder;
  const json profile = json::parse(profiled(folder, "json").out);
  const json advect = pass_of(profile, "mpm/advect.comp");
  const double particles = advect.at("bytes_written").get<double>() / 16;
  CHECK(advect.at("operations").get<double>() == Approx(6 * particles));  // x + dt v
  const double rate = advect.at("operations").get<double>() / advect.at("median").get<double>();
  CHECK(advect.at("operations_per_second").get<double>() == Approx(rate));
  const double most = profile.at("speed").at("multiply_add_flop_per_second").get<double>();
  CHECK(advect.at("share_of_arithmetic").get<double>() == Approx(rate / most));
  CHECK_FALSE(pass_of(profile, "mpm/blocks_find.comp").contains("share_of_arithmetic"));
}

TEST_CASE("a pass that adds and multiplies nearly as fast as the device is held back by arithmetic", "[app]") {
  firn::app::Profile profile;
  profile.speed = {.copy = 1e9, .buffer_copy = 0, .multiply_add = 1e9, .launch = 1e-6};
  firn::app::ProfiledPass pass;
  pass.seconds = {1e-3};
  CHECK(profile.held_back_by(pass) == "its own work");
  pass.operations = 7e5;
  CHECK(profile.held_back_by(pass) == "arithmetic");
  pass.operations = 5e5;
  CHECK(profile.held_back_by(pass) == "its own work");
  pass.traffic = {{"position", "read", "storage", 8e5, 0}};
  CHECK(profile.held_back_by(pass) == "bytes");
  pass.operations = 9e5;
  CHECK(profile.held_back_by(pass) == "arithmetic");
  pass.traffic.front().read = 2e6;
  CHECK(profile.held_back_by(pass) == "arithmetic");
  pass.operations = 0;
  CHECK(profile.held_back_by(pass) == "unclear");
}

TEST_CASE("bytes of a pass follow from its ports, those of listed blocks from the list", "[app]") {
  const Folder folder;
  const json profile = json::parse(profiled(folder, "json").out);
  // 16 bytes of position read and written, 16 of velocity read.
  const json advect = pass_of(profile, "mpm/advect.comp");
  const double particles = advect.at("bytes_written").get<double>() / 16;
  CHECK(particles > 50);
  CHECK(particles == std::floor(particles));
  CHECK(advect.at("bytes_read").get<double>() == Approx(2 * 16 * particles));
  // Only part of the 17 x 19 x 21 nodes lies in blocks that particles reach.
  const json update = pass_of(profile, "mpm/grid_collide.comp");
  CHECK(update.at("elements").get<std::string>().find("groups of 64, read back once") != std::string::npos);
  for (const json& buffer : update.at("buffers"))
    if (buffer.at("buffer") == "grid_velocity") {
      CHECK(buffer.at("written").get<double>() > 0);
      CHECK(buffer.at("written").get<double>() < 16.0 * 17 * 19 * 21);
    }
}

TEST_CASE("a trace holds every launch inside its step", "[app]") {
  const Folder folder;
  const Outcome outcome = profiled(folder, "trace", {"--out", folder / "trace.json"});
  CHECK(outcome.out.empty());
  const json trace = json::parse(read_file(folder / "trace.json"));
  std::vector<json> steps(6);
  std::size_t launches = 0;
  for (const json& event : trace.at("traceEvents"))
    if (event.at("ph") == "X" && event.at("cat") == "step")
      steps.at(std::stoul(event.at("name").get<std::string>().substr(5))) = event;
  for (const json& event : trace.at("traceEvents")) {
    if (event.at("ph") != "X" || event.at("cat") == "step") continue;
    const json& step = steps.at(event.at("args").at("step").get<std::size_t>());
    ++launches;
    CAPTURE(event.dump(), step.dump());
    CHECK(event.at("ts") >= step.at("ts"));
    CHECK(event.at("ts").get<double>() + event.at("dur").get<double>() <=
          step.at("ts").get<double>() + step.at("dur").get<double>() + 1e-3);
  }
  CHECK(launches == 6 * passes_of_mpm_snow);
}

TEST_CASE("the page of a profile needs nothing from elsewhere", "[app]") {
  const Folder folder;
  const std::string page = profiled(folder, "html").out;
  CHECK(page.starts_with("<!doctype html>"));
  for (const char* foreign : {"http:", "https:", "src=", "@import", "<link"}) {
    CAPTURE(foreign);
    std::string rest = page;
    // The name of SVG's elements is no address that is looked up.
    const std::string namespace_name = "http://www.w3.org/2000/svg";
    for (std::size_t at = rest.find(namespace_name); at != std::string::npos; at = rest.find(namespace_name))
      rest.erase(at, namespace_name.size());
    CHECK(rest.find(foreign) == std::string::npos);
  }
  const std::string begin = R"(<script type="application/json" id="data">)";
  const std::size_t from = page.find(begin) + begin.size();
  const json data = json::parse(page.substr(from, page.find("</script>", from) - from));
  CHECK(data.at("launches").size() == 6 * passes_of_mpm_snow);
}

TEST_CASE("a pipeline without steps is not profiled, and the file is named", "[app]") {
  const Folder folder;
  folder.write("scene.yaml", small_scene);
  const std::string file = folder.write("still.yaml", "firn: 1\nname: still\nscene: scene.yaml\nsetup:\n  - mpm.seed\n");
  const Outcome outcome = run_firn({"profile", file});
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("still.yaml: error: nothing to time") != std::string::npos);
}
