#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/app/inputs.h"
#include "tests/catch.h"
#include "tests/small_disk.h"

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::Words;

TEST_CASE("a bad word on the command line is named, with what would be right", "[app]") {
  const Folder folder;
  const struct {
    Words words;
    std::string fragment;
  } table[] = {
      {{}, "subcommand is required"},
      {{"chek", "mpm_snow"}, "no verb 'chek'; did you mean 'check'?"},
      {{"run"}, "PIPELINE is required"},
      {{"check"}, "PIPELINE is required"},
      {{"check", "mpm_snow", "more"}, "more"},
      {{"--verison"}, "firn: no option '--verison'; did you mean '--version'?"},
      {{"run", "--stps", "5", "mpm_snow"}, "firn run: no option '--stps'; did you mean '--steps'?"},
      {{"check", "mpm_snow", "--scen", "a.yaml"}, "firn check: no option '--scen'; did you mean '--scene'?"},
      {{"check", "mpm_snow", "--scen=a.yaml"}, "no option '--scen'; did you mean '--scene'?"},
      {{"check", "mpm_snow", "--scene"}, "--scene"},
      {{"list", "--jsn"}, "no option '--jsn'; did you mean '--json'?"},
      {{"run", "mpm_snow", "--steps", "many"}, "--steps: must be a number from 0, not 'many'"},
      {{"run", "mpm_snow", "--steps", "-1"}, "--steps"},
      {{"run", "mpm_snow", "--frames", "-1"}, "--frames"},
      {{"run", "mpm_snow", "--steps", "1", "--frames", "1"}, "excludes"},
      {{"run"}, "PIPELINE is required"},
      {{"run", "--resume"}, "PIPELINE is required"},
      {{"run", "mpm_snow", "--checkpoint-every", "0"}, "--checkpoint-every: must be a number from 1, not '0'"},
      {{"run", "mpm_snow", "--from", "out"}, "excludes"},
      {{"run", "mpm_snow", "--barriers", "none"}, "--barriers: cannot be 'none'; valid: derived, all"},
      {{"run", "mpm_snow", "--barriers", "derivd"}, "cannot be 'derivd'; did you mean 'derived'? valid: derived, all"},
      {{"check", "mpm_snow", "--scene", "snowbal"}, "snowbal: error: there is no such file; did you mean 'snowball'?"},
      {{"check", "mpm_snwo.yaml"}, "there is no such file; did you mean 'mpm_snow.yaml'?"},
      {{"check", "pipelines/mpm_snwo.yaml"}, "there is no such file"},
      {{"check", "mpm_snwo"}, "mpm_snwo: error: there is no such file; did you mean 'mpm_snow'?"},
      {{"check", "mpm_snow", "--set", "kernel"}, "--set kernel: error: '=' is missing"},
      {{"check", "mpm_snow", "--set", "kernel="}, "--set kernel=: error: the value after '=' is missing"},
      {{"check", "mpm_snow", "--set", "=3"}, "--set =3: error: a name"},
      {{"check", "mpm_snow", "--set", "kernl=cubic"},
       "--set kernl=cubic: error: no parameter 'kernl' in this pipeline; did you mean 'kernel'"},
      {{"check", "mpm_snow", "--set", "kernel=qubic"}, "kernel cannot be 'qubic'; did you mean 'cubic'"},
      {{"check", "mpm_snow", "--set", "mpm.sotr.every=2"},
       "--set mpm.sotr.every=2: error: no stage 'mpm.sotr' in this pipeline; did you mean 'mpm.sort'"},
      {{"check", "mpm_snow", "--set", "mpm.grid_to_particles.flip=2"}, "--set mpm.grid_to_particles.flip=2: error: flip must be"},
      {{"check", "mpm_snow", "--set", "mpm.grid_to_particles.flop=1"},
       "--set mpm.grid_to_particles.flop=1: error: mpm.grid_to_particles has no parameter 'flop'; did you mean 'flip'"},
      {{"check", "mpm_snow", "--set", "scene.gravty=1"}, "--set scene.gravty=1: error: a scene has no key 'gravty'"},
      {{"check", "mpm_snow", "--set", "scene.gravity=1"}, "--set scene.gravity=1: error: gravity must be a list of 3 numbers"},
      {{"check", "mpm_snow", "--set", "scene.snow.7.per_cell=1"}, "--set scene.snow.7.per_cell=1: error: 'snow' is a list"},
      {{"check", "mpm_snow", "--set", "scene.snow.0.per_cell=[1"},
       "--set scene.snow.0.per_cell=[1: error: the value '[1' is no YAML"},
      {{"check", "mpm_snow", "--set", "scene.time.dt=.nan"}, "--set scene.time.dt=.nan: error: dt"},
      {{"check", "mpm_snow", "--set", "scene=a.yaml"}, "--set scene=a.yaml: error: write scene.<key>=<value>"},
      {{"check", "mpm_snow", "--disable", "mpm.srot"},
       "--disable mpm.srot: error: no stage 'mpm.srot' in this pipeline; did you mean"},
      {{"check", "mpm_snow", "--disable", "mpm.sort"}, "reads 'order', which no stage of this pipeline writes"},
      {{"check", "mpm_snow", "--image", "12"}, "--image 12: error: expected WIDTHxHEIGHT"},
      {{"check", "mpm_snow", "--image", "8x8"}, "--image 8x8: error: expected WIDTHxHEIGHT"},
      {{"check", "mpm_snow", "--image", "64x64x64"}, "--image 64x64x64: error: expected WIDTHxHEIGHT"},
      {{"run", "mpm_snow", "--dump", "position"}, "--dump position: error: expected BUFFER=FILE.npy"},
      {{"run", "mpm_snow", "--dump", "positoin=a.npy"},
       "--dump positoin=a.npy: error: no buffer 'positoin' in this pipeline; did you mean 'position'"},
      {{"run", "mpm_snow", "--dump", "position=nowhere/a.npy"},
       "--dump position=nowhere/a.npy: error: there is no folder 'nowhere'"},
  };
  for (const auto& bad : table) {
    Words words = bad.words;
    if (!words.empty() && words[0] == "run") words.insert(words.end(), {"--out", folder / "out"});
    const Outcome outcome = firn::test::run_firn(words);
    std::string line;
    for (const std::string& word : bad.words) line += word + " ";
    INFO("firn " << line << "\nexpected: " << bad.fragment);
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(bad.fragment) != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("a mistyped file is told with the nearest beside it", "[app]") {
  const Folder folder;
  folder.write("thaw.yaml", "firn: 1\n");
  const Outcome outcome = firn::test::run_firn({"check", folder / "thwa.yaml"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("there is no such file; did you mean '" + (folder / "thaw.yaml") + "'?") != std::string::npos);
}

TEST_CASE("the progress display ends with the last step", "[app]") {
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", firn::test::small_scene);
  const auto progress = [&](const Words& more) {
    const Outcome outcome = firn::test::run_firn(firn::test::run_without_pictures("mpm_snow", scene, folder / "out", more));
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    return outcome.err;
  };
  CHECK(progress({"--steps", "7"}).find("100 %  frame 2  step 7 ") != std::string::npos);
  CHECK(progress({"--set", "scene.time.end=0.002"}).find("100 %  frame 3  step 10 ") != std::string::npos);
  CHECK(progress({"--steps", "7"}).find(" 0:00 left") != std::string::npos);
  CHECK(progress({"--steps", "7", "-q"}).empty());
}

TEST_CASE("a --set that cannot be read brings no errors but its own", "[app]") {
  for (const char* text : {"scene.snow.0.per_cell=[1", "kernel=", "=3"}) {
    const Outcome outcome = firn::test::run_firn({"check", "mpm_snow", "--set", text});
    INFO(outcome.err);
    CHECK(outcome.status == 2);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  }
}

TEST_CASE("an error of a stage that setup and step both have is told once", "[app]") {
  const Outcome outcome = firn::test::run_firn({"explain", "mpm_snow", "--set", "mpm.gather_velocities.form=textur"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("did you mean 'texture'") != std::string::npos);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}

TEST_CASE("every verb explains itself, and the version is told", "[app]") {
  for (const char* verb : {"run", "check", "list", "inspect", "try", "completion", "doctor", "test"}) {
    const Outcome help = firn::test::run_firn({verb, "--help"});
    CAPTURE(verb);
    CHECK(help.status == 0);
    CHECK(help.out.find(verb) != std::string::npos);
    CHECK(help.err.empty());
    const Outcome version = firn::test::run_firn({verb, "--version"});
    CHECK(version.status == 0);
    CHECK(version.out.starts_with("firn "));
  }
  const Outcome help = firn::test::run_firn({"--help"});
  CHECK(help.status == 0);
  CHECK(help.out.find("Exit status") != std::string::npos);
  CHECK(firn::test::run_firn({"--version"}).status == 0);
}

TEST_CASE("list names every stage, and the same ones as JSON", "[app]") {
  const Outcome plain = firn::test::run_firn({"list"}), json = firn::test::run_firn({"list", "--json"});
  CHECK(plain.status == 0);
  REQUIRE(json.status == 0);
  const nlohmann::json list = nlohmann::json::parse(json.out);
  REQUIRE(list.is_array());
  CHECK(std::count(plain.out.begin(), plain.out.end(), '\n') == static_cast<std::ptrdiff_t>(list.size()));
  bool found = false;
  for (const nlohmann::json& stage : list) {
    CHECK(plain.out.find(stage.at("name").get<std::string>()) != std::string::npos);
    CHECK_FALSE(stage.at("doc").get<std::string>().empty());
    found |= stage.at("name") == "mpm.advect";
  }
  CHECK(found);
}

TEST_CASE("doctor tells devices and limits, also as JSON", "[app]") {
  const Outcome plain = firn::test::run_firn({"doctor"}), json = firn::test::run_firn({"doctor", "--json"});
  CHECK(plain.status == 0);
  CHECK(plain.out.find("bytes per storage block") != std::string::npos);
  REQUIRE(json.status == 0);
  const nlohmann::json report = nlohmann::json::parse(json.out);
  CHECK(report.at("devices").size() >= 1);
  for (const char* program : {"ffmpeg", "graphviz", "gnuplot"}) CHECK(report.at(program).is_boolean());
  CHECK(plain.out.find("\n  gnuplot   ") != std::string::npos);
  CHECK(report.at("used").at("limits").at("storage_block_bytes").get<std::int64_t>() >= (1 << 24));
}

TEST_CASE("output that cannot be written ends with status 1 and a sentence", "[app]") {
  // Longer and shorter than what is kept until the end; by the verb, and before there is one.
  for (const Words& words : {Words{"bench", "graph/10", "--runs", "1", "--json"},
                             {"bench", "graph", "--runs", "1"},
                             {"list"},
                             {"list", "--json"},
                             {"inspect", "mpm.sort"},
                             {"schema", "pipeline"},
                             {"completion", "bash"},
                             {"--help"}}) {
    CAPTURE(words);
    Outcome outcome;
    {
      const firn::test::SmallDisk disk(160);
      outcome = firn::test::run_firn(words);
    }
    CHECK(outcome.out.size() == 160);
    CHECK(outcome.status == 1);
    CHECK(outcome.err.find("stdout cannot be written") != std::string::npos);
  }
}
