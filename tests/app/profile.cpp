#include "app/profile.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "stages/listed.h"
#include "stages/register.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::read_file;
using firn::test::run_firn;
using firn::test::small_field;
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

json buffer_of(const json& pass, const std::string& name) {
  for (const json& buffer : pass.at("buffers"))
    if (buffer.at("buffer") == name) return buffer;
  FAIL(pass.at("work") << " has no buffer " << name);
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
    const double by_bytes = pass.at("share_of_copy"), by_arithmetic = pass.value("share_of_arithmetic", 0.0);
    CHECK(by_bytes == Approx(pass.at("bytes_per_second").get<double>() / copy));
    CHECK(pass.at("share_of_bound").get<double>() == Approx(std::max(by_bytes, by_arithmetic)));
    CHECK(pass.at("bound") == (by_bytes >= by_arithmetic ? "bytes" : "arithmetic"));
    CHECK(pass.at("reason").get<std::string>() != "");
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

TEST_CASE("a pass is held back by the nearer of its bounds, once it comes near it", "[app]") {
  firn::app::Profile profile;
  profile.speed = {.copy = 1e9, .buffer_copy = 0, .multiply_add = 1e9, .launch = 1e-6};
  profile.units = 4;
  firn::app::ProfiledPass pass;
  pass.seconds = {1e-3};
  pass.groups = 100;
  const auto held_by = [&](const char* name) { CHECK(profile.held_back_by(pass).name == name); };
  const auto nearer = [&](double share, bool by_bytes) {
    const firn::app::Profile::Bound bound = profile.bound(pass).value();
    CHECK(bound.share == Approx(share));
    CHECK(bound.by_bytes == by_bytes);
  };
  held_by("its own work");
  pass.operations = 7e5;
  held_by("arithmetic");
  nearer(0.7, false);
  pass.operations = 5e5;
  held_by("its own work");
  pass.traffic = {{"position", "read", "storage", 8e5, 0}};
  held_by("bandwidth");
  nearer(0.8, true);
  CHECK(profile.held_back_by(pass).sentence.find("80 %") != std::string::npos);
  pass.operations = 9e5;
  held_by("arithmetic");
  nearer(0.9, false);
  pass.operations = 0;
  pass.traffic.front().read = 2e6;
  held_by("caches");
  // What it may touch shows nothing.
  pass.traffic.front().at_most = true;
  held_by("its own work");
  CHECK(profile.bound(pass).value().at_most);
  pass.traffic.front().read = 2e5;
  pass.traffic.front().scattered = true;
  held_by("scattered reads");
  pass.traffic.push_back({"momentum", "accumulate", "storage", 1e5, 1e5});
  held_by("atomic sums");
  CHECK(profile.held_back_by(pass).sentence.find("momentum") != std::string::npos);
  pass.groups = 1;
  held_by("too few elements");
  pass.seconds = {2e-6};
  pass.traffic.clear();
  pass.operations = {};
  held_by("launching");
  pass.operations = 1.8e-6 * profile.speed.multiply_add;  // short, and all the same arithmetic
  held_by("arithmetic");
  pass.operations = 5e-6 * profile.speed.multiply_add;
  held_by("arithmetic");
  CHECK(profile.held_back_by(pass).sentence.find("2.5 times") != std::string::npos);
  pass.host = true;
  held_by("the processor");
  CHECK_FALSE(profile.bound(pass));
}

TEST_CASE("a launch that was held up does not change a pass's share", "[app]") {
  firn::app::Profile profile;
  profile.steps = 5;
  profile.passes.resize(2);
  profile.passes[0].seconds = {1e-3, 1e-3, 1e-3, 1e-3, 1};
  profile.passes[1].seconds = {3e-3, 3e-3, 3e-3, 3e-3, 3e-3};
  CHECK(profile.share_of_time(profile.passes[0]) == Approx(0.25));
  CHECK(profile.share_of_time(profile.passes[1]) == Approx(0.75));
}

TEST_CASE("snow that emitters bring is there to be profiled", "[app]") {
  const Folder folder;
  const json profile = json::parse(
      run_firn({"profile", "mpm_snow", "--scene", "snow_gun", "--warm-up", "200", "--steps", "4", "--format", "json"}).out);
  CHECK(pass_of(profile, "mpm/advect.comp").at("bytes_written").get<double>() > 16 * 10);
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
  CHECK(advect.at("bytes_at_most") == false);
  // One group a block; of the 5 x 5 x 6 blocks of this grid particles reach some.
  const json gather = pass_of(profile, "mpm/gather_velocities.comp");
  const double blocks = gather.at("groups").get<double>();
  CHECK(blocks > 1);
  CHECK(blocks < 150);
  CHECK(buffer_of(gather, "grid_velocity").at("written").get<double>() == Approx(blocks * 64 * 16));
  CHECK(buffer_of(gather, "packed_particles").at("read").get<double>() == Approx(particles * 3 * 16));
  const json back = pass_of(profile, "mpm/grid_to_particles_by_cell.comp");
  CHECK(back.at("groups").get<double>() == Approx(blocks));
  CHECK(buffer_of(back, "grid_velocity").at("read").get<double>() == Approx(blocks * 64 * 16));
  CHECK(buffer_of(back, "velocity").at("written").get<double>() == Approx(particles * 16));
  // The table that finds blocks has an entry for each; its cells are counted by particles, wherever these lie.
  const json find = pass_of(profile, "mpm/blocks_find.comp");
  CHECK(buffer_of(find, "block_key").at("read").get<double>() == Approx(blocks * 4));
  CHECK(buffer_of(find, "cell_count").at("at_most") == true);
}

TEST_CASE("bytes of passes over active tiles are those of the tiles", "[app]") {
  const Folder folder;
  const Outcome outcome = run_firn({"profile", "heightfield_distance", "--scene", folder.write("scene.yaml", small_field), "--set",
                                    "scene.field.cells=[128, 128]", "--steps", "6", "--warm-up", "2", "--format", "json"});
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const json profile = json::parse(outcome.out);
  const json overlap = pass_of(profile, "heightfield/overlap.comp");
  const double tiles = overlap.at("groups").get<double>();
  CHECK(tiles > 1);
  CHECK(tiles < 64);
  CHECK(buffer_of(overlap, "overlap").at("written").get<double>() == Approx(tiles * 256 * 4));
  // Half as many invocations as rows of a tile, each with two floats for every cell on its way.
  const json outflow = pass_of(profile, "heightfield/flatten_outflow.comp");
  CHECK(buffer_of(outflow, "outflow").at("written").get<double>() == Approx(outflow.at("groups").get<double>() * 256 * 8));
  // A single group goes from cell to cell, and nobody knows how far; no farther than bodies are.
  const json transform = pass_of(profile, "heightfield/distance_transform.comp");
  CHECK(transform.at("bytes_at_most") == true);
  CHECK(buffer_of(transform, "distance").at("read").get<double>() == Approx(tiles * 256 * 4));
  // All tiles are looked through, and of the picture of bodies the whole depth is cleared, no more.
  CHECK(buffer_of(pass_of(profile, "heightfield/active_list.comp"), "tile_stamp").at("read") == 64 * 4);
  const json bodies = pass_of(profile, "bodies");
  CHECK(buffer_of(bodies, "underside_depth").at("written") == 128 * 128 * 4);
  CHECK(buffer_of(bodies, "underside_map").at("written").get<double>() == Approx(tiles * 256 * 8));
  CHECK(bodies.at("bytes_at_most") == true);
}

TEST_CASE("passes that are left out for want of bodies are shown so", "[app]") {
  const Folder folder;
  std::string scene = small_scene;
  scene.erase(scene.find("bodies:"));
  const Words words{"profile", "mpm_snow", "--scene", folder.write("scene.yaml", scene), "--steps", "3", "--warm-up", "1"};
  const auto with = [&](const Words& more) {
    Words all = words;
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = run_firn(all);
    REQUIRE(outcome.status == 0);
    return outcome.out;
  };
  const json collide = pass_of(json::parse(with({"--format", "json"})), "mpm/grid_collide.comp");
  CHECK(collide.at("left_out") == "there are no bodies");
  CHECK(collide.at("launches") == 0);
  CHECK_FALSE(collide.contains("bytes_read"));
  CHECK(with({}).find("mpm.grid_collide mpm/grid_collide.comp: it is never launched, as there are no bodies") != std::string::npos);
}

TEST_CASE("every shipped pass over a list is known to the profile", "[app]") {
  const firn::graph::Registry stages = firn::stages::all_stages(nullptr);
  for (const auto& [name, type] : stages.all())
    for (const firn::graph::Work& work : type.spec.work)
      if (const auto* dispatch = std::get_if<firn::graph::Dispatch>(&work); dispatch && !dispatch->indirect.empty()) {
        CAPTURE(name, dispatch->kernel);
        CHECK(firn::stages::groups_of_all(dispatch->indirect) != "");
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
