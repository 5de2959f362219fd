#pragma once

// The closed surface of the snow that particles make, for files and for pictures.

#include <array>
#include <span>
#include <vector>

#include "graph/host.h"
#include "graph/spec.h"
#include "scene/mesh.h"
#include "stages/node_field.h"

namespace firn::stages {

// What the surface is, by the parameters that surface_parameters declares.
struct SurfaceShape {
  double cell = 1;    // edge of the mesh's cells, in cells of the grid
  double level = 0;   // share of space that counts as inside
  int smoothing = 0;  // passes over the share before
};
std::vector<graph::ParameterSpec> surface_parameters(double level);  // where nothing else is said
SurfaceShape surface_shape(const graph::ParameterValues& parameters);

// The share of space that snow fills, as `density`: 1 as it was laid, in whatever material, because it is made of initial volumes.
// `carried`, three floats a particle, comes along as `velocity`: its mean over the particles about a node.
NodeField share_of_snow(std::span<const float> position, std::span<const float> volume, std::span<const float> carried,
                        const scene::Domain& domain, const SurfaceShape& shape);

// Throws std::runtime_error in a build without OpenVDB.
scene::TriangleMesh snow_surface(const NodeField& share, const SurfaceShape& shape);

// Unit vectors out of the mesh, at its points: the mean over the faces there, by their areas.
std::vector<std::array<float, 3>> outward_normals(const scene::TriangleMesh& mesh);

}  // namespace firn::stages
