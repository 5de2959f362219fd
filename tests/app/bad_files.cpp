#include <algorithm>
#include <stdexcept>

#include "tests/app/inputs.h"
#include "tests/catch.h"

namespace {

using firn::test::Folder;
using firn::test::Outcome;
using firn::test::small_pipeline;
using firn::test::small_scene;

// `from` becomes `to`, where '@' marks the place that the message must name; `fragment` is part of the message.
struct Bad {
  const char *from, *to, *fragment;
};

struct Spoilt {
  std::string text, place;
};

Spoilt spoil(std::string text, const Bad& bad) {
  const auto found = text.find(bad.from);
  if (found == std::string::npos) throw std::logic_error(std::string("no such text to spoil: ") + bad.from);
  text.replace(found, std::string(bad.from).size(), bad.to);
  const auto mark = text.find('@');
  if (mark == std::string::npos) throw std::logic_error(std::string("no place marked: ") + bad.to);
  text.erase(mark, 1);
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(mark), '\n') + 1;
  const auto begin = mark == 0 ? std::string::npos : text.rfind('\n', mark - 1);
  const std::size_t column = begin == std::string::npos ? mark + 1 : mark - begin;
  return {text, std::to_string(line) + ":" + std::to_string(column)};
}

// Some line of `text` begins with `place: error: ` and contains `fragment`.
bool tells(const std::string& text, const std::string& place, const std::string& fragment) {
  const std::string start = place + ": error: ";
  for (auto at = text.find(start); at != std::string::npos; at = text.find(start, at + 1)) {
    const std::string line = text.substr(at, text.find('\n', at) - at);
    if ((at == 0 || text[at - 1] == '\n') && line.find(fragment) != std::string::npos) return true;
  }
  return false;
}

void check_bad(const Folder& folder, const std::string& file, const std::string& text, const Bad& bad) {
  const Spoilt spoilt = spoil(text, bad);
  folder.write("pipeline.yaml", small_pipeline);
  folder.write("scene.yaml", small_scene);
  folder.write(file, spoilt.text);
  const Outcome outcome = firn::test::run_firn({"check", folder / "pipeline.yaml"});
  INFO(bad.from << " -> " << bad.to);
  INFO("expected: " << file << ":" << spoilt.place << ": error: ..." << bad.fragment);
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, folder / (file + ":" + spoilt.place), bad.fragment));
  CHECK(outcome.out.empty());
}

}  // namespace

TEST_CASE("the files that the tables of bad ones are made of are good", "[app]") {
  const Folder folder;
  folder.write("pipeline.yaml", small_pipeline);
  folder.write("scene.yaml", small_scene);
  const Outcome outcome = firn::test::run_firn({"check", folder / "pipeline.yaml"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK(outcome.err.find("error") == std::string::npos);
}

TEST_CASE("every mistake in a pipeline is told at its place, with what would be right", "[app]") {
  const Folder folder;
  folder.write("other.yaml", "firn: 1\ninclude: pipeline.yaml\n");
  const Bad table[] = {
      {"- mpm.advect", "- @mpm.advct", "unknown stage 'mpm.advct'; did you mean 'mpm.advect'"},
      {"firn: 1", "firn: @2", "firn must be 1, not 2"},
      {"firn: 1\n", "@", "missing key 'firn'"},
      {"name: small", "@nmae: small", "a pipeline has no key 'nmae'; did you mean 'name'"},
      {"setup:", "@setpu:", "did you mean 'setup'"},
      {"flip: 0.95", "@flop: 0.95", "mpm.grid_to_particles has no parameter 'flop'; did you mean 'flip'"},
      {"flip: 0.95", "flip: @1.5", "flip must be between 0 and 1, not 1.5"},
      {"flip: 0.95", "flip: @much", "flip must be a number, not 'much'"},
      {"flip: 0.95", "flip: @.nan", "flip must be a finite number"},
      {"flip: 0.95", "flip: @[1, 2]", "flip must be a number"},
      {"flip: 0.95", "flip: 0.95, @flip: 0.9", "duplicate key 'flip'"},
      {"{kernel: \"${kernel}\", flip", "{kernel: @qubic, flip", "kernel cannot be 'qubic'; did you mean 'cubic'"},
      {"\"${kernel}\", flip", "@\"${kernle}\", flip", "did you mean 'kernel'"},
      {"- mpm.deform", "- mpm.deform: {bind: {@elastik: elastic}}", "mpm.deform has no port 'elastik'; did you mean 'elastic'"},
      {"- mpm.deform", "- mpm.deform: {bind: {@elastic: position}}", "differ in type"},
      {"- mpm.deform", "- mpm.deform: {every: @0}", "every must be"},
      {"- mpm.deform", "- mpm.deform: {enable: @perhaps}", "enable must be true or false"},
      {"- mpm.deform", "- mpm.deform: @7", "must be a map"},
      {"- mpm.deform", "- mpm.deform: {}\n    @mpm.stress: {}", "one stage per list entry"},
      {"- mpm.deform", "- repeat: @0\n    stages: [mpm.deform]", "repeat must be"},
      {"- mpm.deform", "- {repeat: {max: 3, until: @{buffer: residul, below: 1}}, stages: [mpm.deform]}", "no buffer 'residul'"},
      {"  - mpm.seed\n  - bodies.place\n", "  - bodies.place\n  - mpm.clear_grid: {accumulate: fixed}\n  - @mpm.stress\n",
       "reads 'material', which no stage of this pipeline writes; mpm.seed would"},
      {"- mpm.grid_collide", "- mpm.grid_collide: {@node: all}", "mpm.grid_collide has no parameter 'node'; did you mean 'nodes'"},
      {"scene: scene.yaml", "scene: @scnee.yaml", "no such scene file"},
      {"scene: scene.yaml", "scene: scene.yaml\n@scene: other.yaml", "duplicate key 'scene'"},
      {"name: small", "include: @nowhere.yaml", "no such file"},
      {"name: small", "include: @pipeline.yaml", "includes itself"},
      {"step:\n", "step: @mpm.sort\nfoot:\n", "step must be a list of stages"},
      {"  kernel: quadratic", "@\tkernel: quadratic", "a tab indents this line"},
      {"parameters:\n  kernel: quadratic", "parameters: [\n  kernel: quadratic\n  accumulate@: fixed",
       "the '[' of line 4, column 13 is still open"},
  };
  for (const Bad& bad : table) check_bad(folder, "pipeline.yaml", small_pipeline, bad);
}

TEST_CASE("every mistake in a scene is told at its place, with what would be right", "[app]") {
  const Folder folder;
  const Bad table[] = {
      {"gravity:", "@gravty:", "a scene has no key 'gravty'; did you mean 'gravity'"},
      {"gravity: [0, -9.81, 0]", "gravity: @[0, -9.81]", "gravity must be a list of 3 numbers"},
      {"-9.81", "@-.inf", "must be a finite number"},
      {"dt: 2.0e-4", "dt: @-2.0e-4", "must be greater than 0"},
      {"dt: 2.0e-4", "dt: @fast", "must be a number"},
      {"fps: 1000", "fps: @0", "fps must be greater than 0"},
      {"seed: 3", "seed: @1.5", "seed must be a whole number"},
      {"seed: 3", "seed: @-1", "seed must be at least 0"},
      {"cell: 0.05", "cell: @.nan", "cell must be a finite number"},
      {"cell: 0.05", "cell: @0", "cell must be greater than 0"},
      {"{min: [0, 0, 0], max: [0.8, 0.9, 1.0], cell: 0.05}", "@{min: [0, 0, 0], max: [0.8, 0.9, 1.0]}", "needs the key 'cell'"},
      {"[0.8, 0.9, 1.0]", "@[0.8, 0.9, 1.01]", "whole multiple of cell"},
      {"[0.8, 0.9, 1.0]", "@[0.8, -0.9, 1.0]", "greater than its min along y"},
      {"max: [0.8, 0.9, 1.0], cell: 0.05", "max: @[800, 900, 1000], cell: 0.05", "GiB"},
      {"preset: packed", "preset: @paked", "preset cannot be 'paked'; did you mean 'packed'"},
      {"density: 400", "density: @-400", "density must be greater than 0 and at most 2000, not -400"},
      {"density: 400", "@densty: 400", "did you mean 'density'"},
      {"young: 1.0e5", "young: @\"1.0e5\"", "remove the quotes"},
      {"material: ball", "material: @bal", "did you mean 'ball'"},
      {"per_cell: 4", "per_cell: @65", "per_cell must be between 1 and 64"},
      {"  - {sphere: {center: [0.4, 0.45, 0.5], radius: 0.12}", "  - @{sphere: {center: [0.4, 0.45, 0.05], radius: 0.12}",
       "sticks out of the domain"},
      {"  - {sphere: {center", "  - @{spher: {center", "needs one of sphere, box"},
      {"radius: 0.12", "radius: @-0.12", "radius must be greater than 0"},
      {"sphere: {center: [0.4, 0.45, 0.5], radius: 0.12}", "points: {file: @points.npy, mass: 1}", "does not exist"},
      {"mass: 2", "mass: @-2", "mass must be greater than 0"},
      {"mass: 2", "mass: 2, @mass: 3", "duplicate key 'mass'"},
      {"friction: 0.5", "friction: @-1", "friction must be at least 0"},
      {"  - {sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5]", "  - @{sphere: {radius: 0.1}, position: [4, 0.2, 0.5]",
       "body outside the domain: 'stone'"},
      {"  - {sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5], name: stone",
       "  - @{sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5], name: ground", "two bodies are called 'ground'"},
      {"name: ground", "name: ground, mass: @3", "a plane has no end and so no mass"},
      {"snow:", "@snwo:", "did you mean 'snow'"},
      {"bodies:", "camera: @{from: [1, 1, 1], to: [1, 1, 1]}\nbodies:", "from and to are the same"},
      {"bodies:", "light: @{sun: [0, 0, 0]}\nbodies:", "must not be zero"},
      {"firn: 1", "firn: @9", "format version 9"},
  };
  for (const Bad& bad : table) check_bad(folder, "scene.yaml", small_scene, bad);
}

TEST_CASE("what is no pipeline or scene at all is told so", "[app]") {
  const Folder folder;
  const std::string pipeline = folder.write("pipeline.yaml", small_pipeline);
  const std::string scene = folder.write("scene.yaml", small_scene);
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), zeros(64, '\0');
  const struct {
    std::string file, place, fragment;
  } table[] = {
      {folder.write("picture.png", png), ":1:1", "not a text in UTF-8"},
      {folder.write("zeros", zeros), ":1:1", "control character"},
      {folder.write("latin.yaml", "firn: 1\nname: Schneeb\xe4lle\n"), ":2:14", "not a text in UTF-8"},
      {folder.write("empty.yaml", ""), "", "empty"},
      {folder.write("number.yaml", "3\n"), ":1:1", "must be a map"},
      {folder.write("list.yaml", "- 1\n- 2\n"), ":1:1", "must be a map"},
      {folder / "nothing.yaml", "", "no such file"},
      {folder / "", "", "a directory"},
  };
  for (const auto& bad : table) {
    for (const firn::test::Words& words : {firn::test::Words{"check", bad.file}, {"check", pipeline, "--scene", bad.file}}) {
      const Outcome outcome = firn::test::run_firn(words);
      INFO(bad.file << ": expected " << bad.place << " ... " << bad.fragment);
      INFO(outcome.err);
      CHECK(outcome.status == 2);
      CHECK(tells(outcome.err, bad.file + bad.place, bad.fragment));
    }
  }
}

TEST_CASE("a scene with neither snow nor field is told that there is nothing to simulate", "[app]") {
  const Folder folder;
  const std::string pipeline = folder.write("pipeline.yaml", small_pipeline);
  const std::string scene = folder.write("scene.yaml", "firn: 1\nname: void\n");
  const Outcome outcome = firn::test::run_firn({"check", pipeline});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, scene + ":1:1", "nothing to simulate"));
}

TEST_CASE("two pipelines that include each other are told where the circle closes", "[app]") {
  const Folder folder;
  const std::string one = folder.write("one.yaml", "include: two.yaml\nfirn: 1\n");
  const std::string two = folder.write("two.yaml", "include: one.yaml\nfirn: 1\n");
  const Outcome outcome = firn::test::run_firn({"check", one});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, two + ":1:10", "includes itself"));
}

TEST_CASE("an absurd grid is told with its count and memory, at once and without taking the memory", "[app]") {
  const Folder folder;
  const std::string pipeline = folder.write("pipeline.yaml", small_pipeline);
  folder.write("scene.yaml", small_scene);
  const Outcome outcome = firn::test::run_firn({"check", pipeline, "--set", "scene.domain.cell=1e-5"});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find("a grid of 7.2e+14 nodes") != std::string::npos);
  CHECK(outcome.err.find("GiB") != std::string::npos);
  CHECK(outcome.peak_kilobytes < 200000);
}

TEST_CASE("two errors in a pipeline and one in its scene are all told at once", "[app]") {
  const Folder folder;
  const Spoilt first = spoil(small_pipeline, {"- mpm.advect", "- @mpm.advct", ""});
  const Spoilt second = spoil(first.text, {"flip: 0.95", "flip: @2", ""});
  const Spoilt third = spoil(small_scene, {"mass: 2", "mass: @-2", ""});
  const std::string pipeline = folder.write("pipeline.yaml", second.text);
  const std::string scene = folder.write("scene.yaml", third.text);
  const Outcome outcome = firn::test::run_firn({"check", pipeline});
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(tells(outcome.err, pipeline + ":" + first.place, "mpm.advect"));
  CHECK(tells(outcome.err, pipeline + ":" + second.place, "flip"));
  CHECK(tells(outcome.err, scene + ":" + third.place, "mass"));
}
