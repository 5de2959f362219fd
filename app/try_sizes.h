#pragma once

// The surroundings of one stage alone: sizes of domains from the arrays it is given, constants from them, from the command line, or
// from a scene.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/node.h"
#include "graph/environment.h"
#include "graph/plan.h"
#include "scene/npy.h"

namespace firn::app {

struct GivenArray {
  std::string file;
  scene::NpyArray array;
  config::Place place;
};
using GivenArrays = std::map<std::string, GivenArray>;  // by port

// "(rows, columns)", "(bodies, 3)", "(nodes, 3, 3)": what an array for the port looks like.
std::string expected_shape(const graph::Port& port);

// Domains of the bound ports and the work of `stage` get their sizes: from `sizes` (DOMAIN=N or [rows, columns]), from the arrays,
// else from what `environment` has already; `notes` tells what was taken instead. What follows from others is set too: tiles, grid
// rows and blocks, the nodes per axis.
void size_domains(const graph::PlannedStage& stage, const GivenArrays& arrays, const std::vector<std::string>& sizes,
                  graph::Environment& environment, std::vector<std::string>& notes, config::Diagnostics& diagnostics);

// Constants that the stage's kernels use: from `words` (NAME=VALUE), from `environment`, from the arrays, or an honest default,
// told in `notes`. `known` has all there are, with unit and doc.
void set_constants(const graph::StageSpec& spec, const GivenArrays& arrays, const std::vector<std::string>& words,
                   const graph::Environment& known, graph::Environment& environment, std::vector<std::string>& notes,
                   config::Diagnostics& diagnostics);

}  // namespace firn::app
