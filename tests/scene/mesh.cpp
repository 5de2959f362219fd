#include "scene/mesh.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "scene/inertia.h"
#include "tests/scene/support.h"

namespace firn::test {

using scene::TriangleMesh;
using scene::Vector3d;

namespace {

// A box from low to high as OBJ, faces as quadrilaterals seen from outside.
std::string box_obj(const Vector3d& low, const Vector3d& high, bool inside_out = false) {
  std::ostringstream text;
  for (int i = 0; i < 8; ++i)
    text << "v " << (i & 1 ? high : low).x() << " " << (i & 2 ? high : low).y() << " " << (i & 4 ? high : low).z() << "\n";
  const int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
  for (const auto& f : faces) {
    text << "f";
    for (int i = 0; i < 4; ++i) text << " " << f[inside_out ? 3 - i : i];
    text << "\n";
  }
  return text.str();
}

std::string corners_of(const char* style) {
  std::ostringstream text;
  const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  if (std::string(style) == "ply") {
    text << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
            "property list uchar int vertex_indices\nend_header\n";
    for (const auto& c : corners) text << c[0] << " " << c[1] << " " << c[2] << "\n";
    for (const auto& f : faces) text << "3 " << f[0] << " " << f[1] << " " << f[2] << "\n";
  } else if (std::string(style) == "stl") {
    text << "solid t\n";
    for (const auto& f : faces) {
      text << "facet normal 0 0 0\nouter loop\n";
      for (const int i : f) text << "vertex " << corners[i][0] << " " << corners[i][1] << " " << corners[i][2] << "\n";
      text << "endloop\nendfacet\n";
    }
    text << "endsolid t\n";
  } else {
    for (const auto& c : corners) text << "v " << c[0] << " " << c[1] << " " << c[2] << "\n";
    for (const auto& f : faces) text << "f " << f[0] + 1 << " " << f[1] + 1 << " " << f[2] + 1 << "\n";
  }
  return text.str();
}

struct Files {
  TemporaryFolder folder;
  [[nodiscard]] TriangleMesh mesh(const std::string& name, const std::string& text, double scale = 1) const {
    folder.write(name, text);
    return scene::read_mesh((folder / name).string(), scale);
  }
  [[nodiscard]] std::string error(const std::string& name, const std::string& text) const {
    try {
      static_cast<void>(mesh(name, text));
    } catch (const std::runtime_error& caught) {
      CHECK(std::string(caught.what()).find((folder / name).string() + ": ") == 0);
      return caught.what();
    }
    return "";
  }
};

// A ball of `rings` by 2 `rings` facets.
TriangleMesh ball(int rings, double radius) {
  TriangleMesh mesh;
  const int around = 2 * rings;
  mesh.points.push_back({0, radius, 0});
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / around;
      mesh.points.emplace_back(radius * std::sin(polar) * std::cos(turn), radius * std::cos(polar),
                               -radius * std::sin(polar) * std::sin(turn));
    }
  mesh.points.push_back({0, -radius, 0});
  const auto at = [&](int ring, int j) { return 1 + (ring - 1) * around + j % around; };
  const int last = static_cast<int>(mesh.points.size()) - 1;
  for (int j = 0; j < around; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    mesh.triangles.push_back({at(rings - 1, j), last, at(rings - 1, j + 1)});
  }
  return mesh;
}

bool near(const Vector3d& a, const Vector3d& b, double tolerance = 1e-9) { return (a - b).norm() <= tolerance; }

}  // namespace

TEST_CASE("OBJ, PLY and STL give the same closed mesh") {
  const char* const kind = GENERATE("obj", "ply", "stl");
  CAPTURE(kind);
  const Files files;
  const TriangleMesh mesh = files.mesh(std::string("t.") + kind, corners_of(kind), 2);
  CHECK(mesh.points.size() == 4);
  CHECK(mesh.triangles.size() == 4);
  CHECK(scene::is_closed(mesh));
  const scene::MassProperties properties = scene::mass_properties(mesh);
  CHECK(properties.closed);
  CHECK(properties.volume == Approx(8.0 / 6));
  CHECK(near(properties.center, {0.5, 0.5, 0.5}));
}

TEST_CASE("a box as a mesh weighs and turns like the box, wherever it stands and whichever way its faces are") {
  const bool inside_out = GENERATE(false, true);
  const Files files;
  const Vector3d low(1, -2, 3), high(1.5, -1, 5), size = high - low;
  const TriangleMesh mesh = files.mesh("box.obj", box_obj(low, high, inside_out));
  CHECK(mesh.triangles.size() == 12);
  const scene::MassProperties properties = scene::mass_properties(mesh);
  CHECK(properties.closed);
  CHECK(properties.volume == Approx(1.0));
  CHECK(near(properties.center, 0.5 * (low + high), 1e-6));
  const scene::Inertia expected = scene::inertia_of(scene::Box{{0, 0, 0}, 0.5 * size}, properties.volume);
  CHECK(near(properties.inertia.diagonal(), expected.moments, 1e-6));
  CHECK(std::abs(properties.inertia(0, 1)) < 1e-6);
  double outward = 0;  // the faces look outward
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.points[t[0]], normal = (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a);
    outward += normal.dot(a - properties.center) > 0 ? 1 : 0;
  }
  CHECK(outward == 12);
}

TEST_CASE("triangles without area are dropped and points in one place joined") {
  const Files files;
  const std::string text = corners_of("obj") + "v 0 0 0\nv 0.5 0 0\nf 1 2 6\nf 1 1 5\nf 1 5 3\n";
  const TriangleMesh mesh = files.mesh("t.obj", text);
  CHECK(mesh.triangles.size() == 4);
  CHECK(scene::is_closed(mesh));
}

TEST_CASE("a mesh that is not closed is weighed as the box round it, and says so") {
  const Files files;
  std::string text = box_obj({0, 0, 0}, {1, 2, 3});
  text.erase(text.rfind("f "));
  const TriangleMesh mesh = files.mesh("open.obj", text);
  const scene::MassProperties properties = scene::mass_properties(mesh);
  CHECK_FALSE(properties.closed);
  CHECK(properties.volume == Approx(6));
  CHECK(near(properties.center, {0.5, 1, 1.5}));
  CHECK(near(properties.inertia.diagonal(), {6.0 / 12 * 13, 6.0 / 12 * 10, 6.0 / 12 * 5}));
}

TEST_CASE("a mesh that cannot be is an error that names the file and what is wrong") {
  const Files files;
  CHECK(files.error("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").find("no triangles with an area") != std::string::npos);
  CHECK_FALSE(files.error("b.obj", "v 0 0 0\n").empty());
  CHECK_FALSE(files.error("c.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n").empty());
  CHECK_FALSE(files.error("d.ply", "ply\nformat ascii 1.0\nelement vertex 3\n").empty());
  CHECK_FALSE(files.error("e.stl", "").empty());
  CHECK(files.error("f.fbx", "x").find(".obj, .ply or .stl") != std::string::npos);
  CHECK_THROWS_AS(scene::read_mesh((files.folder / "gone.obj").string(), 1), std::runtime_error);
  CHECK_THROWS_AS(scene::read_mesh(files.folder.operator/("").string(), 1), std::runtime_error);
}

TEST_CASE("a mesh file cut off anywhere is an error or a smaller mesh, and never blocks") {
  const std::string kind = GENERATE("obj", "ply", "stl", "box.obj");
  const Files files;
  const std::string good = kind == "box.obj" ? box_obj({0, 0, 0}, {1, 1, 1}) : corners_of(kind.c_str());
  for (std::size_t length = 0; length < good.size(); length += 2) {
    INFO(kind << " " << length);
    const std::string name = "cut." + kind;
    files.folder.write(name, good.substr(0, length));
    try {
      const TriangleMesh mesh = scene::read_mesh((files.folder / name).string(), 1);
      CHECK(mesh.triangles.size() <= 12);
    } catch (const std::runtime_error& error) {
      CHECK(std::string(error.what()).find(name) != std::string::npos);
    }
  }
}

TEST_CASE("the meshes of a scene's bodies are read, bad ones reported together at their bodies") {
  const Files files;
  files.folder.write("box.obj", box_obj({0, 0, 0}, {1, 1, 1}));
  files.folder.write("bad.obj", "nothing\n");
  const std::string head = "firn: 1\nfield: {size: [1, 1], cells: [8, 8], depth: 1, material: sand}\nbodies:\n";
  const scene::Scene good = good_scene(
      head + "  - {mesh: {file: box.obj, scale: 2}, mass: 1}\n  - {sphere: {radius: 1}}\n  - {mesh: {file: box.obj, scale: 2}}\n",
      files.folder / "s.yaml");
  const std::vector<TriangleMesh> meshes = scene::body_meshes(good);
  REQUIRE(meshes.size() == 3);
  CHECK(meshes[0].triangles.size() == 12);
  CHECK(meshes[1].triangles.empty());
  CHECK(meshes[2].triangles.size() == 12);
  Vector3d farthest = Vector3d::Zero();
  for (const Vector3d& point : meshes[2].points) farthest = farthest.cwiseMax(point);
  CHECK(near(farthest, {2, 2, 2}));

  const scene::Scene bad =
      good_scene(head + "  - {mesh: {file: bad.obj}}\n  - {mesh: {file: bad.obj, scale: 3}}\n", files.folder / "s.yaml");
  try {
    scene::body_meshes(bad);
    FAIL("no error");
  } catch (const config::InputError& error) {
    REQUIRE(error.diagnostics().all().size() == 2);
    CHECK(error.diagnostics().all()[0].place.line == 4);
    CHECK(error.diagnostics().all()[1].place.line == 5);
  }
}

TEST_CASE("a fine ball as a mesh weighs and turns like a sphere") {
  const TriangleMesh mesh = ball(64, 0.5);
  REQUIRE(scene::is_closed(mesh));
  const scene::MassProperties properties = scene::mass_properties(mesh);
  CHECK(properties.volume == Approx(4.0 / 3 * std::numbers::pi * 0.125).epsilon(5e-3));
  const scene::Inertia sphere = scene::inertia_of(scene::Sphere{{0, 0, 0}, 0.5}, 3), round = scene::inertia_of(mesh, 3);
  for (int i = 0; i < 3; ++i) CHECK(round.moments[i] == Approx(sphere.moments[i]).epsilon(5e-3));
}

// Moments of a shape by summing small cubes: knows nothing of the formulas.
template <typename InsideOf>
Vector3d summed_moments(double reach, double mass, const InsideOf& inside) {
  const int n = 120;
  const double h = 2 * reach / n;
  Vector3d sum = Vector3d::Zero();
  double count = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vector3d p = Vector3d(i + 0.5, j + 0.5, k + 0.5) * h - Vector3d::Constant(reach);
        if (!inside(p)) continue;
        sum += Vector3d::Constant(p.squaredNorm()) - p.cwiseProduct(p);
        ++count;
      }
  return mass / count * sum;
}

TEST_CASE("moments of sphere, box and capsule are what summing small cubes gives") {
  const double mass = 7;
  const auto agree = [&](const Vector3d& formula, const Vector3d& summed) {
    for (int i = 0; i < 3; ++i) CHECK(formula[i] == Approx(summed[i]).epsilon(0.01));
  };
  agree(scene::inertia_of(scene::Sphere{{0, 0, 0}, 0.4}, mass).moments,
        summed_moments(0.41, mass, [](const Vector3d& p) { return p.norm() <= 0.4; }));
  agree(scene::inertia_of(scene::Box{{0, 0, 0}, {0.1, 0.2, 0.3}}, mass).moments,
        summed_moments(0.3, mass, [](const Vector3d& p) { return std::abs(p.x()) <= 0.1 && std::abs(p.y()) <= 0.2; }));
  // Its axis, own z, is the first principal axis.
  const scene::Inertia capsule = scene::inertia_of(scene::Capsule{{0, 0, -0.25}, {0, 0, 0.25}, 0.15}, mass);
  CHECK(near(capsule.axes * Vector3d::UnitX(), {0, 0, 1}));
  const Vector3d summed = summed_moments(0.4, mass, [](const Vector3d& p) {
    const double along = std::clamp(p.z(), -0.25, 0.25);
    return (p - Vector3d(0, 0, along)).norm() <= 0.15;
  });
  agree(capsule.moments, {summed.z(), summed.x(), summed.y()});
}

TEST_CASE("a capsule hardly longer than a point turns like a sphere") {
  const scene::Inertia capsule = scene::inertia_of(scene::Capsule{{0, 0, 0}, {1e-9, 0, 0}, 0.3}, 2);
  for (int i = 0; i < 3; ++i) CHECK(capsule.moments[i] == Approx(0.4 * 2 * 0.09));
}

TEST_CASE("principal axes of a turned mesh are those of what it was turned from") {
  TriangleMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 4}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const scene::Inertia straight = scene::inertia_of(mesh, 5);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()));
  for (Vector3d& point : mesh.points) point = turn * point + Vector3d(10, 0, -3);
  const scene::Inertia turned = scene::inertia_of(mesh, 5);
  CHECK(near(turned.center, turn * straight.center + Vector3d(10, 0, -3)));
  CHECK(near(turned.moments, straight.moments, 1e-8));
  const auto tensor = [](const scene::Inertia& inertia) -> Eigen::Matrix3d {
    const Eigen::Matrix3d axes = inertia.axes.toRotationMatrix();
    return axes * inertia.moments.asDiagonal() * axes.transpose();
  };
  const Eigen::Matrix3d rotation = turn.toRotationMatrix();
  CHECK((tensor(turned) - rotation * tensor(straight) * rotation.transpose()).norm() < 1e-8);
}

TEST_CASE("half-spaces and bodies without a mass do not turn") {
  CHECK(std::isinf(scene::inertia_of(scene::Plane{}, 1).moments.minCoeff()));
  scene::Body body;
  body.shape = scene::Sphere{{0, 0, 0}, 1};
  CHECK(std::isinf(scene::inertia_of(body).moments.minCoeff()));
  body.mass = 10;
  CHECK(scene::inertia_of(body).moments.x() == Approx(4));
}

}  // namespace firn::test
