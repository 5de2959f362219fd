#pragma once

// What OpenVDB does for us: .vdb files, and triangles round dense regions. A build without that library has these functions too,
// but they throw std::runtime_error saying so.

#include <span>
#include <string>

#include "scene/mesh.h"
#include "stages/node_field.h"

namespace firn::stages {

bool has_openvdb();

// A file with the grids `density` (fog volume, kg/m3) and `velocity` (m/s), float, active where there is snow. Index (i, j, k) of
// both lies at origin + cell (i, j, k).
std::string vdb_of(const NodeField& field, double time);

// The closed surface within which the density is above `level`, kg/m3; after `smoothing` passes that take the mean over each node
// and its 26 neighbours.
scene::TriangleMesh surface_of(const NodeField& field, double level, int smoothing);

}  // namespace firn::stages
