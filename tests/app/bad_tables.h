#pragma once

// Mistakes in the small pipeline and scene of inputs.h.

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/app/inputs.h"

namespace firn::test {

// `from` becomes `to`, where '@' marks the place that the message must name; `fragment` is part of the message.
struct Bad {
  const char *from, *to, *fragment;
  bool seen_by_schema = true;  // false: only `firn check` can tell
};

struct Spoilt {
  std::string text, place;
};

inline Spoilt spoil(std::string text, const Bad& bad) {
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

inline std::vector<Bad> bad_pipelines() {
  return {
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
      {"\"${kernel}\", flip", "@\"${kernle}\", flip", "did you mean 'kernel'", false},
      {"- mpm.deform", "- mpm.deform: {bind: {@elastik: elastic}}", "mpm.deform has no port 'elastik'; did you mean 'elastic'"},
      {"- mpm.deform", "- mpm.deform: {bind: {@elastic: position}}", "differ in type", false},
      {"- mpm.deform", "- mpm.deform: {every: @0}", "every must be"},
      {"- mpm.deform", "- mpm.deform: {enable: @perhaps}", "enable must be true or false"},
      {"- mpm.deform", "- mpm.deform: @7", "must be a map"},
      {"- mpm.deform", "- mpm.deform: {}\n    @mpm.stress: {}", "one stage per list entry"},
      {"- mpm.deform", "- repeat: @0\n    stages: [mpm.deform]", "repeat must be"},
      {"- mpm.deform", "- {repeat: {max: 3, until: @{buffer: residul, below: 1}}, stages: [mpm.deform]}", "no buffer 'residul'",
       false},
      {"  - mpm.seed\n  - bodies.place\n", "  - bodies.place\n  - mpm.clear_grid: {accumulate: fixed}\n  - @mpm.stress\n",
       "reads 'material', which no stage of this pipeline writes; mpm.emit or mpm.seed would", false},
      {"- mpm.grid_collide", "- mpm.grid_collide: {@node: all}", "mpm.grid_collide has no parameter 'node'; did you mean 'nodes'"},
      {"scene: scene.yaml", "scene: @scnee.yaml", "no such scene file", false},
      {"scene: scene.yaml", "scene: scene.yaml\n@scene: other.yaml", "duplicate key 'scene'"},
      {"name: small", "include: @nowhere.yaml", "no such file", false},
      {"name: small", "include: @pipeline.yaml", "includes itself", false},
      {"step:\n", "step: @mpm.sort\nfoot:\n", "step must be a list of stages"},
      {"  kernel: quadratic", "@\tkernel: quadratic", "a tab indents this line"},
      {"parameters:\n  kernel: quadratic", "parameters: [\n  kernel: quadratic\n  accumulate@: fixed",
       "the '[' of line 4, column 13 is still open"},
  };
}

inline std::vector<Bad> bad_scenes() {
  return {
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
      {"[0.8, 0.9, 1.0]", "@[0.8, 0.9, 1.01]", "whole multiple of cell", false},
      {"[0.8, 0.9, 1.0]", "@[0.8, -0.9, 1.0]", "greater than its min along y", false},
      {"max: [0.8, 0.9, 1.0], cell: 0.05", "max: @[800, 900, 1000], cell: 0.05", "GiB", false},
      {"preset: packed", "preset: @paked", "preset cannot be 'paked'; did you mean 'packed'"},
      {"density: 400", "density: @-400", "density must be greater than 0 and at most 2000, not -400"},
      {"density: 400", "@densty: 400", "did you mean 'density'"},
      {"young: 1.0e5", "young: @\"1.0e5\"", "remove the quotes"},
      {"material: ball", "material: @bal", "did you mean 'ball'", false},
      {"per_cell: 4", "per_cell: @65", "per_cell must be between 1 and 64"},
      {"  - {sphere: {center: [0.4, 0.45, 0.5], radius: 0.12}", "  - @{sphere: {center: [0.4, 0.45, 0.05], radius: 0.12}",
       "sticks out of the domain", false},
      {"  - {sphere: {center", "  - @{spher: {center", "needs one of sphere, box"},
      {"radius: 0.12", "radius: @-0.12", "radius must be greater than 0"},
      {"sphere: {center: [0.4, 0.45, 0.5], radius: 0.12}", "points: {file: @points.npy, mass: 1}", "does not exist", false},
      {"mass: 2", "mass: @-2", "mass must be greater than 0"},
      {"mass: 2", "mass: 2, @mass: 3", "duplicate key 'mass'"},
      {"friction: 0.5", "friction: @-1", "friction must be at least 0"},
      {"  - {sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5]", "  - @{sphere: {radius: 0.1}, position: [4, 0.2, 0.5]",
       "body outside the domain: 'stone'", false},
      {"  - {sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5], name: stone",
       "  - @{sphere: {radius: 0.1}, position: [0.4, 0.2, 0.5], name: ground", "two bodies are called 'ground'", false},
      {"name: ground", "name: ground, mass: @3", "a plane has no end and so no mass"},
      {"snow:", "@snwo:", "did you mean 'snow'"},
      {"bodies:", "camera: @{from: [1, 1, 1], to: [1, 1, 1]}\nbodies:", "from and to are the same", false},
      {"bodies:", "light: @{sun: [0, 0, 0]}\nbodies:", "must not be zero", false},
      {"firn: 1", "firn: @9", "format version 9"},
  };
}

}  // namespace firn::test
