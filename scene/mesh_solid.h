#pragma once

// What is inside of a triangle mesh, be it with holes, with faces the wrong way round, or passing through itself: a point is inside
// where the generalised winding number of the mesh about it is at least a half (Jacobson et al. 2013), summed over a tree whose far
// branches count as dipoles (Barill et al. 2018).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/mesh.h"
#include "scene/solid.h"

namespace firn::scene {

// What was found wrong with a mesh. Places are one of several, in the mesh's own axes.
struct MeshFindings {
  std::size_t open_edges = 0;     // with a face on one side only
  std::size_t crowded_edges = 0;  // shared by more than two faces
  std::size_t flipped = 0;        // faces turned, so that they look the same way as their neighbours
  std::size_t without_area = 0;   // faces left out
  Vector3d open_at{0, 0, 0}, crowded_at{0, 0, 0}, flipped_at{0, 0, 0};
};
std::string to_string(const MeshFindings& findings);  // empty: nothing is wrong

// Turns faces so that those that share an edge look the same way: in each connected part as most of its area does already. Counts
// what else is wrong.
MeshFindings repair(TriangleMesh& mesh);

class MeshSolid {
 public:
  explicit MeshSolid(TriangleMesh mesh);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] Bounds bounds() const;
  [[nodiscard]] double winding_number(const Vector3d& point) const;
  // A part that is inside out as a whole has an inside too.
  [[nodiscard]] bool inside(const Vector3d& point) const;
  // To the nearest face, m; at least `most` where none is nearer than that.
  [[nodiscard]] double distance(const Vector3d& point, double most) const;
  // For a whole ball: all of it inside, none of it, or nothing where that is not plain.
  [[nodiscard]] std::optional<bool> inside(const Vector3d& center, double radius) const;

 private:
  struct Node {
    Vector3d min, max;
    Vector3d center, normal;   // mean place of the area, and sum of the faces' normals times their areas
    double reach = 0;          // of the farthest corner from the centre
    int first = 0, count = 0;  // triangles, where it is a leaf
    int left = -1, right = -1;
  };
  int build(int first, int count);
  [[nodiscard]] double winding_number(int node, const Vector3d& point) const;
  void nearest(int node, const Vector3d& point, double& squared) const;

  TriangleMesh mesh_;
  std::vector<Node> nodes_;
};

}  // namespace firn::scene
