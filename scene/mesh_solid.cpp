#include "scene/mesh_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace firn::scene {
namespace {

constexpr int leaf_size = 8;
constexpr double far = 3;  // a branch is far where it is so many times its own reach away; errors of the whole are below 0.05 then

// Solid angle of a triangle seen from the origin, over 4 pi (van Oosterom and Strackee 1983).
double solid_angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double over = a.dot(b.cross(c)), under = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return std::atan2(over, under) / (2 * std::numbers::pi);
}

double squared_distance(const Vector3d& p, const Vector3d& low, const Vector3d& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0).squaredNorm();
}

// Of a point from a triangle: from its plane where it lies over the triangle, else from the nearest edge.
double squared_distance_to_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  double nearest = std::numeric_limits<double>::infinity();
  bool over = true;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const Vector3d edge = to - from, own = p - from;
    over = over && normal.cross(edge).dot(own) >= 0;
    const double length = edge.squaredNorm();
    const double along = length > 0 ? std::clamp(own.dot(edge) / length, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (own - along * edge).squaredNorm());
  }
  const double area = normal.squaredNorm();
  if (!over || !(area > 0)) return nearest;
  const double height = normal.dot(p - a);
  return height * height / area;
}

}  // namespace

MeshSolid::MeshSolid(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  nodes_.reserve(2 * mesh_.triangles.size() / leaf_size * 2 + 1);
  build(0, static_cast<int>(mesh_.triangles.size()));
}

// Halves the triangles [first, first + count) at the middle one along the longest axis.
int MeshSolid::build(int first, int count) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const int index = static_cast<int>(nodes_.size());
  Node node;
  node.first = first;
  node.count = count;
  node.min.setConstant(infinity);
  node.max.setConstant(-infinity);
  node.center.setZero();
  node.normal.setZero();
  double area = 0;
  const auto corner = [&](const std::array<int, 3>& t, std::size_t i) -> const Vector3d& {
    return mesh_.points[static_cast<std::size_t>(t[i])];
  };
  const auto begin = mesh_.triangles.begin() + first, end = begin + count;
  for (auto t = begin; t != end; ++t) {
    const Vector3d &a = corner(*t, 0), &b = corner(*t, 1), &c = corner(*t, 2);
    node.min = node.min.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    node.max = node.max.cwiseMax(a).cwiseMax(b).cwiseMax(c);
    const Vector3d own = 0.5 * (b - a).cross(c - a);
    node.normal += own;
    node.center += own.norm() / 3 * (a + b + c);
    area += own.norm();
  }
  node.center = area > 0 ? Vector3d(node.center / area) : Vector3d(0.5 * (node.min + node.max));
  for (auto t = begin; t != end; ++t)
    for (std::size_t i = 0; i < 3; ++i) node.reach = std::max(node.reach, (corner(*t, i) - node.center).norm());
  nodes_.push_back(node);
  if (count <= leaf_size) return index;
  int axis = 0;
  (node.max - node.min).maxCoeff(&axis);
  const auto middle = begin + count / 2;
  const auto place = [&](const std::array<int, 3>& t) { return corner(t, 0)[axis] + corner(t, 1)[axis] + corner(t, 2)[axis]; };
  std::nth_element(begin, middle, end, [&](const auto& s, const auto& t) { return place(s) < place(t); });
  const int left = build(first, count / 2);
  const int right = build(first + count / 2, count - count / 2);
  nodes_[static_cast<std::size_t>(index)].left = left;
  nodes_[static_cast<std::size_t>(index)].right = right;
  return index;
}

Bounds MeshSolid::bounds() const { return {nodes_.front().min, nodes_.front().max}; }

double MeshSolid::winding_number(int at, const Vector3d& point) const {
  const Node& node = nodes_[static_cast<std::size_t>(at)];
  const Vector3d away = node.center - point;
  const double distance = away.norm();
  if (distance > far * node.reach) return away.dot(node.normal) / (4 * std::numbers::pi * distance * distance * distance);
  if (node.left >= 0) return winding_number(node.left, point) + winding_number(node.right, point);
  double sum = 0;
  for (int i = node.first; i < node.first + node.count; ++i) {
    const std::array<int, 3>& t = mesh_.triangles[static_cast<std::size_t>(i)];
    sum += solid_angle(mesh_.points[static_cast<std::size_t>(t[0])] - point, mesh_.points[static_cast<std::size_t>(t[1])] - point,
                       mesh_.points[static_cast<std::size_t>(t[2])] - point);
  }
  return sum;
}

double MeshSolid::winding_number(const Vector3d& point) const { return winding_number(0, point); }

bool MeshSolid::inside(const Vector3d& point) const { return std::abs(winding_number(0, point)) >= 0.5; }

void MeshSolid::nearest(int at, const Vector3d& point, double& squared) const {
  const Node& node = nodes_[static_cast<std::size_t>(at)];
  if (squared_distance(point, node.min, node.max) >= squared) return;
  if (node.left >= 0) {
    const Node &left = nodes_[static_cast<std::size_t>(node.left)], &right = nodes_[static_cast<std::size_t>(node.right)];
    const bool left_first = squared_distance(point, left.min, left.max) <= squared_distance(point, right.min, right.max);
    nearest(left_first ? node.left : node.right, point, squared);
    nearest(left_first ? node.right : node.left, point, squared);
    return;
  }
  for (int i = node.first; i < node.first + node.count; ++i) {
    const std::array<int, 3>& t = mesh_.triangles[static_cast<std::size_t>(i)];
    squared = std::min(squared, squared_distance_to_triangle(point, mesh_.points[static_cast<std::size_t>(t[0])],
                                                             mesh_.points[static_cast<std::size_t>(t[1])],
                                                             mesh_.points[static_cast<std::size_t>(t[2])]));
  }
}

double MeshSolid::distance(const Vector3d& point, double most) const {
  double squared = most * most;
  nearest(0, point, squared);
  return std::sqrt(squared);
}

// Away from faces the winding number is a harmonic function: where no face is within twice the ball's radius, and the number is not
// near a half, it does not pass a half within the ball. (In a hole it changes over the hole's width, which is wider than that.)
std::optional<bool> MeshSolid::inside(const Vector3d& center, double radius) const {
  if (distance(center, 2 * radius) < 2 * radius) return std::nullopt;
  const double number = std::abs(winding_number(0, center));
  if (number > 0.25 && number < 0.75) return std::nullopt;
  return number >= 0.5;
}

}  // namespace firn::scene
