#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "config/node.h"
#include "config/numbers.h"
#include "tests/app/bad_tables.h"
#include "tests/catch.h"

namespace {

namespace fs = std::filesystem;

using firn::config::Node;
using firn::test::Folder;
using firn::test::Outcome;
using firn::test::run_firn;
using nlohmann::json;

// As an editor reads YAML 1.2.
json as_json(const Node& node) {
  json result;
  switch (node.kind) {
    case Node::Kind::null:
      return nullptr;
    case Node::Kind::sequence:
      result = json::array();
      for (const Node& item : node.items) result.push_back(as_json(item));
      return result;
    case Node::Kind::map:
      result = json::object();
      for (const firn::config::Entry& entry : node.entries) result[entry.key] = as_json(entry.value);
      return result;
    case Node::Kind::scalar:
      break;
  }
  if (!node.quoted) {
    if (node.scalar == "true" || node.scalar == "false") return node.scalar == "true";
    if (const auto whole = firn::config::parse_whole(node.scalar)) return *whole;
    if (const auto number = firn::config::parse_number(node.scalar)) return *number;
  }
  return node.scalar;
}

constexpr const char* program = R"(
import glob, json, os, sys
from jsonschema import Draft7Validator
folder = sys.argv[1]
for kind in ("pipeline", "scene"):
    with open(os.path.join(folder, kind + ".schema")) as file:
        schema = json.load(file)
    Draft7Validator.check_schema(schema)
    validator = Draft7Validator(schema)
    for name in sorted(glob.glob(os.path.join(folder, kind + "_*.json"))):
        with open(name) as file:
            errors = list(validator.iter_errors(json.load(file)))
        with open(name + ".result", "w") as file:
            file.write(errors[0].message if errors else "good")
)";

// Texts against the schemas that firn prints, by Python's validator (Debian: python3-jsonschema).
class Validation {
 public:
  Validation() {
    for (const char* kind : {"pipeline", "scene"}) {
      const Outcome schema = run_firn({"schema", kind, "--out", folder_ / (std::string(kind) + ".schema")});
      INFO(schema.err);
      REQUIRE(schema.status == 0);
    }
  }

  // What YAML itself refuses is not asked about.
  void add(const std::string& kind, const std::string& title, const std::string& text) {
    firn::config::Diagnostics diagnostics;
    const Node node = firn::config::parse(text, title, diagnostics);
    if (diagnostics.has_errors()) return;
    const std::string file = kind + "_" + std::to_string(files_.size()) + ".json";
    folder_.write(file, as_json(node).dump());
    files_.emplace_back(title, file);
  }

  // By title: "good", or what is wrong.
  std::vector<std::pair<std::string, std::string>> results() {
    const std::string script = folder_.write("validate.py", program);
    const std::string python = fs::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
    const int status = std::system((python + " '" + script + "' '" + fs::path(script).parent_path().string() + "'").c_str());
    REQUIRE(status == 0);  // else: is python3-jsonschema there?
    std::vector<std::pair<std::string, std::string>> list;
    for (const auto& [title, file] : files_) list.emplace_back(title, firn::test::read_file(folder_ / (file + ".result")));
    return list;
  }

 private:
  const Folder folder_;
  std::vector<std::pair<std::string, std::string>> files_;
};

const fs::path root = FIRN_SOURCE_DIR;

std::vector<fs::path> yaml_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  return files;
}

bool is_scene(const fs::path& file) { return file.parent_path().filename() == "scenes"; }

// Scenes with every key there is.
const std::string full_scene = R"(firn: 1
name: full
doc: everything
seed: 2
time: {dt: auto, cfl: 0.3, fps: 30, end: 1}
gravity: [0, -9.81, 0]
domain: {min: [0, 0, 0], max: [3, 3, 3], cell: 0.1, blocks: 5000}
materials:
  own: {preset: packed, density: 400, young: 1.0e5, poisson: 0.3, hardening: 10, critical_compression: 0.02, critical_stretch: 0.005,
        min_density: 30, max_density: 500, slope: 0.6, color: [1, 1, 1]}
snow:
  - {sphere: {center: [1, 1, 1], radius: 0.3}, material: own, velocity: [0, 0, 0], spin: [0, 1, 0], per_cell: 8}
  - {box: {min: [1, 1, 1], max: [1.4, 1.4, 1.4]}, material: own, orientation: {axis: [0, 1, 0], degrees: 30}}
  - {box: {center: [1, 1, 1], size: [0.5, 0.5, 0.5]}, material: own, orientation: [0, 0, 0, 1]}
  - {capsule: {from: [1, 1, 1], to: [1.5, 1, 1], radius: 0.2}, material: wet}
  - {points: {file: points.npy, mass: 0.1}, material: own}
  - {mesh: {file: sledge.obj, scale: 0.5, rotate: {axis: [0, 1, 0], degrees: 30}, translate: [1, 1, 1]}, material: wet, sampling: poisson}
emitters:
  - {snowfall: {center: [1, 2, 1], size: [1, 1], rate: 1, velocity: [0, -1, 0]}, material: own, per_cell: 8, from: 0, until: 1}
  - {gun: {position: [1, 1, 1], direction: [1, 1, 0], speed: 5, spread: 5, radius: 0.05, rate: 1}, material: wet}
sinks:
  - {box: {min: [0, 0, 0], max: [3, 0.3, 3]}, from: 0, until: 1}
max_particles: 100000
field: {size: [10, 10], cells: [64, 64], origin: [0, 0], material: own, ground: 0, depth: {image: depth.npy, metres: 0.5}, density: 100}
bodies:
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, name: floor, friction: 0.5, color: [0, 0, 1]}
  - {sphere: {radius: 0.2}, position: [1, 2, 1], velocity: [0, 1, 0], spin: [0, 0, 1], orientation: [0, 0, 0, 1], mass: 3}
  - {box: {size: [0.5, 0.5, 0.5]}, path: [{t: 0, position: [1, 2, 1], orientation: [0, 0, 0, 1]}, {t: 1, position: [2, 2, 1]}]}
  - {box: {min: [1, 1, 1], max: [2, 2, 2]}}
  - {capsule: {from: [0, -0.5, 0], to: [0, 0.5, 0], radius: 0.2}, position: [1, 2, 1]}
  - {mesh: {file: sledge.obj, scale: 1}, position: [1, 2, 1]}
camera: {from: [1, 1, 1], to: [0, 0, 0], fov: 40}
light: {sun: [0, -1, 0]}
)";

void collect_keys(const json& schema, std::set<std::string>& keys) {
  if (const auto properties = schema.find("properties"); properties != schema.end())
    for (const auto& [key, value] : properties->items()) keys.insert(key);
  for (const json& part : schema)
    if (part.is_structured()) collect_keys(part, keys);
}

}  // namespace

TEST_CASE("every pipeline and scene that comes with Firn is good by the schema that firn prints", "[app]") {
  Validation validation;
  for (const char* folder : {"pipelines", "bench"})
    for (const fs::path& file : yaml_files(root / folder))
      validation.add(is_scene(file) ? "scene" : "pipeline", file.string(), firn::test::read_file(file));
  validation.add("pipeline", "small pipeline", firn::test::small_pipeline);
  validation.add("scene", "small scene", firn::test::small_scene);
  validation.add("scene", "full scene", full_scene);
  const auto results = validation.results();
  CHECK(results.size() > 15);
  for (const auto& [title, result] : results) {
    CAPTURE(title);
    CHECK(result == "good");
  }
}

TEST_CASE("the schema refuses the bad files of the tables, but for those that only check can tell", "[app]") {
  Validation validation;
  std::vector<bool> expected;
  const auto add = [&](const std::string& kind, const std::string& text, const firn::test::Bad& bad) {
    validation.add(kind, kind + ": " + bad.from + " -> " + bad.to, firn::test::spoil(text, bad).text);
  };
  std::set<std::string> only_check;
  for (const firn::test::Bad& bad : firn::test::bad_pipelines()) {
    add("pipeline", firn::test::small_pipeline, bad);
    if (!bad.seen_by_schema) only_check.insert(std::string("pipeline: ") + bad.from + " -> " + bad.to);
  }
  for (const firn::test::Bad& bad : firn::test::bad_scenes()) {
    add("scene", firn::test::small_scene, bad);
    if (!bad.seen_by_schema) only_check.insert(std::string("scene: ") + bad.from + " -> " + bad.to);
  }
  const auto results = validation.results();
  CHECK(results.size() > 50);
  for (const auto& [title, result] : results) {
    CAPTURE(title, result);
    CHECK((result == "good") == only_check.contains(title));
  }
}

TEST_CASE("the scene's schema and the reader of scenes know the same keys", "[app]") {
  const json schema = json::parse(run_firn({"schema", "scene"}).out);
  std::set<std::string> keys;
  collect_keys(schema, keys);
  CHECK(keys.size() > 50);
  for (const std::string& key : keys) {
    CAPTURE(key);
    CHECK((full_scene.find(" " + key + ":") != std::string::npos || full_scene.find("{" + key + ":") != std::string::npos ||
           full_scene.find("\n" + key + ":") != std::string::npos || full_scene.starts_with(key + ":")));
  }
  // The reader knows every one of these keys: whatever else it may say of this scene.
  const Folder folder;
  const std::string scene = folder.write("scene.yaml", full_scene);
  const Outcome outcome = run_firn({"check", "mpm_snow", "--scene", scene});
  INFO(outcome.err);
  CHECK(outcome.err.find("has no key") == std::string::npos);
  CHECK(outcome.err.find("needs one of") == std::string::npos);
}

TEST_CASE("the schemas beside the pipelines are those that firn prints", "[app]") {
  for (const std::string kind : {"pipeline", "scene"}) {
    INFO("to bring it up to date: firn schema " << kind << " --out pipelines/schema/" << kind << ".json");
    const bool same = run_firn({"schema", kind}).out == firn::test::read_file(root / "pipelines/schema" / (kind + ".json"));
    CHECK(same);
  }
}

TEST_CASE("every pipeline and scene that comes with Firn tells editors its schema", "[app]") {
  for (const char* folder : {"pipelines", "bench"})
    for (const fs::path& file : yaml_files(root / folder)) {
      CAPTURE(file.string());
      const std::string text = firn::test::read_file(file), begin = "# yaml-language-server: $schema=";
      REQUIRE(text.starts_with(begin));
      const fs::path schema = file.parent_path() / text.substr(begin.size(), text.find('\n') - begin.size());
      CHECK(fs::is_regular_file(schema));
      CHECK(schema.filename() == (is_scene(file) ? "scene.json" : "pipeline.json"));
    }
}
