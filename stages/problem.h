#pragma once

// A scene made ready for stages: particles sampled, and everything the graph wants to know of it as plain data.

#include <memory>

#include "graph/environment.h"
#include "scene/mesh.h"
#include "scene/sampling.h"
#include "scene/scene.h"

namespace firn::stages {

struct Image {
  int width = 1280, height = 720;
};

struct Problem {
  scene::Scene scene;
  scene::Particles particles;
  std::vector<scene::TriangleMesh> meshes;  // per body; empty for other shapes
  Image image;
  std::string output;  // folder for what stages write; empty: they write nothing
};

// Throws config::InputError where files of the scene cannot be read.
std::shared_ptr<const Problem> make_problem(scene::Scene scene, Image image, std::string output);

// Whether a body's triangles are swept one by one: those of meshes, and of boxes that may turn.
bool facets_are_swept(const scene::Body& body);

// Triangles of all boxes and meshes among the bodies, and how many of them are swept.
struct FacetCounts {
  std::size_t all = 0, swept = 0;
};
FacetCounts facet_counts(const Problem& problem);

// Domains: particles (as many as there is room for), emitters, sinks, materials, nodes, grid_rows, grid_blocks, block_table,
// surface_corners, cells, tiles, bodies, key_frames, facets, swept_facets, body_distances, image, shadow_map. Constants: see
// environment.cpp.
graph::Environment environment(const Problem& problem);

// Bound of all speeds that the scene can bring about, m/s: initial speeds, bodies, and what gravity adds; for fixed-point scales.
double speed_bound(const scene::Scene& scene);

// The largest stable step of the explicit scheme, s: cfl h / (speed + speed of sound), over all materials.
double stable_time_step(const scene::Scene& scene);

}  // namespace firn::stages
