#pragma once

// The problem a pipeline runs on, as the scene file gives it (docs/scenes.md). SI units: m, kg, s, Pa. y is up.
// Plain data: who simulates it, and how, is the pipeline's business.
//
// Orientations turn a body's own axes into the world's: p_world = position + orientation * p_own. In the file they are a unit
// quaternion [x, y, z, w] or {axis: [x, y, z], degrees: a}, which turns counter-clockwise for a viewer whom the axis points at.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/node.h"

namespace firn::scene {

using config::Place;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

// --- materials (scene/materials.h has the presets) ---------------------------------------------------------------------

struct Material {
  std::string name;
  std::string preset;    // the preset it started from; empty: none
  double density = 400;  // kg/m3, initial
  double young = 1.4e5;  // Pa
  double poisson = 0.2;
  double hardening = 10;                 // xi of [M 29-32]
  double critical_compression = 2.5e-2;  // theta_c
  double critical_stretch = 7.5e-3;      // theta_s
  // Height-field model (part H):
  double min_density = 30;   // kg/m3: rho_min of [H 3.9]
  double max_density = 500;  // kg/m3: rho_max
  double slope = 0.6;        // phi, m/m: steepest slope that stands
  Vector3d color{0.95, 0.97, 1.0};
  Place place;
};

// --- shapes -------------------------------------------------------------------------------------------------------------

struct Plane {
  Vector3d point{0, 0, 0};
  Vector3d normal{0, 1, 0};
};  // half-space below; normal is unit length
struct Sphere {
  Vector3d center{0, 0, 0};
  double radius = 0;
};
struct Box {
  Vector3d center{0, 0, 0};
  Vector3d half_size{0, 0, 0};
};  // file: center + size, or min + max
struct Capsule {
  Vector3d start{0, 0, 0};
  Vector3d end{0, 0, 0};
  double radius = 0;
};  // file: from, to, radius
struct Mesh {
  std::string file;
  double scale = 1;
};  // absolute or relative to the working directory
class MeshSolid;
using Shape = std::variant<Plane, Sphere, Box, Capsule, Mesh>;

// --- snow that is filled with particles -----------------------------------------------------------------------------------

struct PointFile {
  std::string file;
  double mass = 0;
};  // kg per particle; file: N x 3 or N x 6 (with velocity)
// A mesh where it lies in the scene: translate + rotate (scale p_file).
struct SolidMesh {
  Mesh mesh;
  std::shared_ptr<const MeshSolid> solid;  // scene/mesh_solid.h
};
enum class Sampling { jittered, poisson };
struct Snow {
  std::variant<Sphere, Box, Capsule, SolidMesh, PointFile> what;
  int material = 0;                                   // index into Scene::materials
  Vector3d velocity{0, 0, 0};                         // added to the velocities of a file of points
  Vector3d spin{0, 0, 0};                             // rad/s about the shape's centre; points: about their mean
  Quaterniond orientation = Quaterniond::Identity();  // boxes and capsules turn about their centre
  int per_cell = 8;
  Sampling sampling = Sampling::jittered;  // of shapes
  Place place;
};

// --- snow that comes and goes while time passes (scene/emission.h) -----------------------------------------------------------

struct Span {  // s
  double from = 0, until = std::numeric_limits<double>::infinity();
};
struct Snowfall {  // out of a level rectangle
  Vector3d center{0, 0, 0};
  Vector2d size{1, 1};          // m, along x and z
  double rate = 0;              // kg/(m2 s)
  Vector3d velocity{0, -1, 0};  // m/s
};
struct SnowGun {
  Vector3d position{0, 0, 0};   // centre of the nozzle
  Vector3d direction{1, 0, 0};  // unit length
  double speed = 0;             // m/s
  double spread = 0;            // degrees, between the direction and the outermost flakes
  double radius = 0;            // m, of the nozzle
  double rate = 0;              // kg/s
};
struct Emitter {
  std::variant<Snowfall, SnowGun> what;
  int material = 0;  // index into Scene::materials
  int per_cell = 8;  // as of Snow: decides the mass of a particle
  Span span;
  Place place;
};
struct Sink {
  Box box;
  Span span;
  Place place;
};

// --- the field that the height-field model works on -------------------------------------------------------------------------

// A number for the whole field, or an image (scene/image.h) with the value of white in `unit_value` (file key: metres, or density).
struct FieldSource {
  double value = 0;
  std::string image;      // empty: `value` everywhere
  double unit_value = 1;  // value where the image is white (.npy: where the array holds 1)
  Place place;            // of the number or the map; of the field where the file gives neither
};
struct Field {
  Vector2d size{10, 10};  // m, along x and z
  Vector2d origin{0, 0};  // m, x and z of the field's lowest corner
  int cells_x = 256, cells_z = 256;
  FieldSource ground, depth, density;
  int material = 0;
  Place place;
};

// --- rigid bodies ---------------------------------------------------------------------------------------------------------

struct KeyFrame {
  double time = 0;
  Vector3d position{0, 0, 0};
  Quaterniond orientation = Quaterniond::Identity();
};
// The shape is in the body's own axes with its centre at the origin (a plane: point 0; a mesh: as its file says), so that
// p_world = position + orientation * p_own places it. The file may give a place inside the shape instead of `position`.
struct Body {
  Shape shape;
  std::string name;            // optional in the file; "body 3" else
  Vector3d position{0, 0, 0};  // of the shape's origin (its centre); a plane's point where none is given
  Quaterniond orientation = Quaterniond::Identity();
  Vector3d velocity{0, 0, 0};
  Vector3d spin{0, 0, 0};      // rad/s, world axes
  std::optional<double> mass;  // kg; none: moves as told, nothing stops it
  double friction = 0;         // Coulomb
  std::vector<KeyFrame> path;  // times ascending
  Vector3d color{0.55, 0.42, 0.30};
  Place place;
};

// Whether anything in the scene can change the body's orientation: a mass, a spin, or a path that turns it.
bool may_turn(const Body& body);

// --- all of it --------------------------------------------------------------------------------------------------------------

struct Domain {
  Vector3d min{0, 0, 0}, max{1, 1, 1};
  double cell = 0.05;                  // m
  std::optional<std::int64_t> blocks;  // of 4 x 4 x 4 nodes that snow may reach at once; none: by the particles
  // Nodes per axis: both ends included. Nodes lie at min + cell (i, j, k).
  [[nodiscard]] Eigen::Vector3i nodes() const;
  Place place;
};
// Particles stay this many cells away from the domain's faces: the cubic kernel's stencil [M 17-20] reaches that far.
inline constexpr int stencil_margin = 2;

struct Time {
  std::optional<double> dt;  // none: auto
  double cfl = 0.4;
  double fps = 30;
  double end = 1;  // s
};
struct Camera {
  Vector3d from{4, 3, 6}, to{0, 0.5, 0};
  double fov = 40;  // degrees, vertical
};
struct Light {
  Vector3d sun{-0.4, -1, -0.3};  // direction the light travels
};

struct Scene {
  std::string file, name, doc;
  std::uint64_t seed = 1;
  Time time;
  Vector3d gravity{0, -9.81, 0};
  std::optional<Domain> domain;
  std::vector<Material> materials;
  std::vector<Snow> snow;
  std::vector<Emitter> emitters;
  std::vector<Sink> sinks;
  std::uint64_t max_particles = 0;  // that there may be at once; 0: none declared, as many as `snow` makes
  Place max_particles_place;
  std::optional<Field> field;
  std::vector<Body> bodies;
  Camera camera;
  Light light;

  [[nodiscard]] bool has_particles() const { return domain && !(snow.empty() && emitters.empty()); }
};

// Reads a scene out of its YAML tree (after --set edits). All errors go to `diagnostics`; the scene is usable only if there are
// none. File names in the scene are taken relative to the scene file. Checks what the file alone can tell: ranges, names, existing
// files, shapes inside the domain, a scene with nothing to simulate.
Scene read_scene(const config::Node& root, config::Diagnostics& diagnostics);

}  // namespace firn::scene
