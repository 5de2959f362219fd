#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/mesh_solid.h"
#include "scene/read.h"

namespace firn::scene {
namespace {

struct Edge {
  int low, high;  // corners
  int face;
  bool forward;                                   // the face goes from low to high
  auto operator<=>(const Edge&) const = default;  // NOLINT(modernize-use-nullptr): what the compiler makes of it
};

std::vector<Edge> edges_of(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (int f = 0; f < static_cast<int>(mesh.triangles.size()); ++f) {
    const std::array<int, 3>& t = mesh.triangles[static_cast<std::size_t>(f)];
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = t[i], to = t[(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), f, from < to});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

struct Neighbour {
  int face;
  bool opposed;  // the two look different ways
};

double area_of(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const Vector3d &a = mesh.points[static_cast<std::size_t>(t[0])], &b = mesh.points[static_cast<std::size_t>(t[1])],
                 &c = mesh.points[static_cast<std::size_t>(t[2])];
  return 0.5 * (b - a).cross(c - a).norm();
}

// Faces of the part that `start` belongs to; `turned` says of each whether it looks another way than `start`.
std::vector<int> part_of(int start, const std::vector<std::vector<Neighbour>>& neighbours, std::vector<signed char>& turned) {
  std::vector<int> part{start};
  turned[static_cast<std::size_t>(start)] = 0;
  for (std::size_t i = 0; i < part.size(); ++i)
    for (const Neighbour& next : neighbours[static_cast<std::size_t>(part[i])]) {
      signed char& known = turned[static_cast<std::size_t>(next.face)];
      if (known >= 0) continue;
      known = static_cast<signed char>(turned[static_cast<std::size_t>(part[i])] ^ (next.opposed ? 1 : 0));
      part.push_back(next.face);
    }
  return part;
}

}  // namespace

MeshFindings repair(TriangleMesh& mesh) {
  MeshFindings findings;
  findings.without_area = mesh.without_area;
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangles.size());
  const std::vector<Edge> edges = edges_of(mesh);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    const Vector3d& at = mesh.points[static_cast<std::size_t>(edges[i].low)];
    if (end - i == 1 && findings.open_edges++ == 0) findings.open_at = at;
    if (end - i > 2 && findings.crowded_edges++ == 0) findings.crowded_at = at;
    if (end - i == 2) {
      const bool opposed = edges[i].forward == edges[i + 1].forward;
      neighbours[static_cast<std::size_t>(edges[i].face)].push_back({edges[i + 1].face, opposed});
      neighbours[static_cast<std::size_t>(edges[i + 1].face)].push_back({edges[i].face, opposed});
    }
    i = end;
  }
  std::vector<signed char> turned(mesh.triangles.size(), -1);
  for (std::size_t start = 0; start < turned.size(); ++start) {
    if (turned[start] >= 0) continue;
    const std::vector<int> part = part_of(static_cast<int>(start), neighbours, turned);
    double area[2] = {};
    for (const int face : part)
      area[turned[static_cast<std::size_t>(face)]] += area_of(mesh, mesh.triangles[static_cast<std::size_t>(face)]);
    const signed char wrong = area[1] > area[0] ? 0 : 1;
    for (const int face : part) {
      std::array<int, 3>& t = mesh.triangles[static_cast<std::size_t>(face)];
      if (turned[static_cast<std::size_t>(face)] != wrong) continue;
      if (findings.flipped++ == 0) findings.flipped_at = mesh.points[static_cast<std::size_t>(t[0])];
      std::swap(t[1], t[2]);
    }
  }
  return findings;
}

std::string to_string(const MeshFindings& findings) {
  std::vector<std::string> parts;
  const auto add = [&](std::size_t count, const char* one, const char* several, const Vector3d* at) {
    if (count == 0) return;
    parts.push_back(fmt::format("{} {}", count, count == 1 ? one : several));
    if (at != nullptr) parts.back() += fmt::format(" ({} at {})", count == 1 ? "it is" : "one is", detail::to_text(*at));
  };
  add(findings.open_edges, "open edge", "open edges", &findings.open_at);
  add(findings.crowded_edges, "edge of more than two faces", "edges of more than two faces", &findings.crowded_at);
  add(findings.flipped, "face that looks the wrong way", "faces that look the wrong way", &findings.flipped_at);
  add(findings.without_area, "face without area", "faces without area", nullptr);
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace firn::scene
