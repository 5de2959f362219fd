#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/emission.h"
#include "scene/materials.h"
#include "scene/mesh_solid.h"
#include "scene/solid.h"
#include "stages/body_distance.h"
#include "stages/forms.h"
#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"
#include "stages/problem.h"

namespace firn::stages {
namespace {

using graph::ElementType;

// The largest power of two that is at most x: scaling by it does not round.
double power_of_two_below(double x) { return std::exp2(std::floor(std::log2(x))); }

// Particles that a cell may hold: as seeded, compressed fourfold, wherever snows overlap twofold. More than this, and a fixed-point
// sum may overflow, which is detected.
double crowd(const scene::Scene& scene) {
  int most = 1;
  for (const scene::Snow& snow : scene.snow) most = std::max(most, snow.per_cell);
  for (const scene::Emitter& emitter : scene.emitters) most = std::max(most, emitter.per_cell);
  return 8.0 * most;
}

// Fixed-point scales (powers of two) from bounds on sums over one node. With at most n particles a cell and per axis sum N <= 5/3
// over one particle per cell: m_i <= (5/3)^3 n max m_p, |(m v)_i| <= that times max |v|.
void add_scales(const Problem& problem, graph::Environment& environment) {
  double heaviest = problem.particles.mass.empty() ? 0.0 : *std::ranges::max_element(problem.particles.mass);
  for (const scene::Emitter& emitter : problem.scene.emitters)
    heaviest = std::max(heaviest, scene::particle_mass(problem.scene, emitter));
  if (heaviest == 0) heaviest = 1;
  const double mass_bound = 125.0 / 27.0 * crowd(problem.scene) * heaviest;
  double fastest = speed_bound(problem.scene);
  for (const scene::Vector3d& v : problem.particles.velocity) fastest = std::max(fastest, 2.0 * v.norm());  // from files of points
  const double momentum_bound = mass_bound * 2.0 * fastest;
  constexpr double range = 2147483647.0;
  environment.constants.push_back(
      {"mass_scale", ElementType::float1, power_of_two_below(range / mass_bound), "1/kg", "fixed-point steps per kg of node mass"});
  environment.constants.push_back({"momentum_scale", ElementType::float1, power_of_two_below(range / momentum_bound), "s/(kg m)",
                                   "fixed-point steps per kg m/s of node momentum"});
  environment.constants.push_back({"crowd", ElementType::float1, crowd(problem.scene), "1", "bound of particles in one cell"});
}

// The farthest point of a shape from its body's origin, m; infinite for half-spaces and meshes.
double extent(const scene::Shape& shape) {
  if (const auto* sphere = std::get_if<scene::Sphere>(&shape)) return sphere->center.norm() + sphere->radius;
  if (const auto* box = std::get_if<scene::Box>(&shape)) return box->center.norm() + box->half_size.norm();
  if (const auto* capsule = std::get_if<scene::Capsule>(&shape))
    return std::max(capsule->start.norm(), capsule->end.norm()) + capsule->radius;
  return std::numeric_limits<double>::infinity();
}

void add_grid(const scene::Domain& domain, std::size_t particles, graph::Environment& environment) {
  const Eigen::Vector3i nodes = domain.nodes();
  const auto count = [](auto n) { return graph::DomainSize{static_cast<std::uint64_t>(n)}; };
  const std::uint64_t nx = static_cast<std::uint64_t>(nodes.x()), ny = static_cast<std::uint64_t>(nodes.y()),
                      nz = static_cast<std::uint64_t>(nodes.z());
  environment.domains["nodes"] = count(nx * ny * nz);
  environment.domains["nodes"].shape = {nz, ny, nx};
  environment.domains["grid_rows"] = count(ny * nz);
  const mpm::BlockRoom room =
      mpm::block_room({nodes.x(), nodes.y(), nodes.z()}, particles, static_cast<std::uint64_t>(domain.blocks.value_or(0)));
  environment.domains["grid_blocks"] = count(room.blocks);
  environment.domains["block_table"] = count(room.table);
  environment.constants.push_back({"grid_min", ElementType::vec3, graph::Vector3{domain.min.x(), domain.min.y(), domain.min.z()},
                                   "m", "position of node (0, 0, 0)"});
  environment.constants.push_back({"grid_cell", ElementType::float1, domain.cell, "m", "distance h of neighbouring nodes"});
  environment.constants.push_back({"grid_nodes", ElementType::ivec3,
                                   graph::Vector3{double(nodes.x()), double(nodes.y()), double(nodes.z())}, "1", "nodes per axis"});
}

void add_field(const scene::Scene& scene, graph::Environment& environment) {
  const scene::Field& field = *scene.field;
  const int tiles_x = (field.cells_x + heightfield::tile_edge - 1) / heightfield::tile_edge;
  const int tiles_z = (field.cells_z + heightfield::tile_edge - 1) / heightfield::tile_edge;
  const auto grid = [](int width, int height) {
    const auto columns = static_cast<std::uint64_t>(width), rows = static_cast<std::uint64_t>(height);
    return graph::DomainSize{columns * rows, width, height, {rows, columns}};
  };
  environment.domains["cells"] = grid(field.cells_x, field.cells_z);
  environment.domains["tiles"] = grid(tiles_x, tiles_z);
  const scene::Material& material = scene.materials[static_cast<std::size_t>(field.material)];
  environment.constants.push_back({"field_min", ElementType::vec3, graph::Vector3{field.origin.x(), 0, field.origin.y()}, "m",
                                   "lowest corner of the field, at height 0"});
  environment.constants.push_back(
      {"field_cell", ElementType::float1, field.size.x() / field.cells_x, "m", "edge h of a cell of the field"});
  environment.constants.push_back(
      {"min_density", ElementType::float1, material.min_density, "kg/m3", "density below which snow is pressed, not pushed away"});
  environment.constants.push_back(
      {"max_density", ElementType::float1, material.max_density, "kg/m3", "density that snow cannot be pressed beyond"});
  environment.constants.push_back({"field_color", ElementType::vec3,
                                   graph::Vector3{material.color.x(), material.color.y(), material.color.z()}, "1",
                                   "colour of the field's material, sRGB"});
  environment.constants.push_back({"material_slope", ElementType::float1, material.slope, "m/m", "steepest slope that stands"});
}

// The box that holds what a picture shows: the domain, the field with its snow, else the bodies.
scene::Bounds visible(const scene::Scene& scene) {
  Eigen::AlignedBox3d box;
  if (scene.domain) {
    box.extend(scene.domain->min);
    box.extend(scene.domain->max);
  }
  const auto top = [](const scene::FieldSource& source) { return source.image.empty() ? source.value : source.unit_value; };
  if (const auto& field = scene.field) {
    const double ground = field->ground.image.empty() ? field->ground.value : std::min(0.0, field->ground.unit_value);
    box.extend(scene::Vector3d(field->origin.x(), ground, field->origin.y()));
    box.extend(scene::Vector3d(field->origin.x() + field->size.x(), top(field->ground) + top(field->depth),
                               field->origin.y() + field->size.y()));
  }
  if (!scene.domain)
    for (const scene::Body& body : scene.bodies)
      if (const auto solid = scene::solid_of(body, body.position, body.orientation)) {
        box.extend(scene::bounds_of(*solid).min);
        box.extend(scene::bounds_of(*solid).max);
      }
  if (box.isEmpty()) return {};
  return {box.min(), box.max()};
}

void add_view(const scene::Scene& scene, graph::Environment& environment) {
  const auto add = [&](const char* name, const scene::Vector3d& v, const char* unit, const char* doc) {
    environment.constants.push_back({name, ElementType::vec3, graph::Vector3{v.x(), v.y(), v.z()}, unit, doc});
  };
  add("camera_from", scene.camera.from, "m", "where the camera stands");
  add("camera_to", scene.camera.to, "m", "what the camera looks at");
  environment.constants.push_back({"camera_fov", ElementType::float1, scene.camera.fov, "degrees", "vertical angle of view"});
  add("sun_direction", scene.light.sun.normalized(), "1", "unit vector along which sunlight travels");
  const scene::Bounds box = visible(scene);
  add("scene_min", box.min, "m", "lowest corner of the box that holds what a picture shows");
  add("scene_max", box.max, "m", "highest corner of that box");
}

void say_what_is_missing(graph::Environment& environment) {
  const char* no_grid = "the scene has no 'domain' with 'snow' in it";
  for (const char* name : {"particles", "emitters", "sinks", "nodes", "grid_rows", "grid_blocks", "block_table", "surface_corners",
                           "grid_min", "grid_cell", "grid_nodes", "mass_scale", "momentum_scale", "crowd"})
    environment.missing[name] = no_grid;
  for (const char* name :
       {"cells", "tiles", "field_min", "field_cell", "min_density", "max_density", "material_slope", "field_color"})
    environment.missing[name] = "the scene has no 'field'";
}

}  // namespace

double speed_bound(const scene::Scene& scene) {
  double fastest = 0, travel = 0;
  for (const scene::Snow& snow : scene.snow) {
    double reach = 0;
    if (const auto* sphere = std::get_if<scene::Sphere>(&snow.what)) reach = sphere->radius;
    if (const auto* box = std::get_if<scene::Box>(&snow.what)) reach = box->half_size.norm();
    if (const auto* capsule = std::get_if<scene::Capsule>(&snow.what))
      reach = (capsule->end - capsule->start).norm() + capsule->radius;
    if (const auto* mesh = std::get_if<scene::SolidMesh>(&snow.what))
      reach = (mesh->solid->bounds().max - mesh->solid->bounds().min).norm();
    fastest = std::max(fastest, snow.velocity.norm() + snow.spin.norm() * reach);
  }
  for (const scene::Emitter& emitter : scene.emitters) fastest = std::max(fastest, scene::largest_speed(emitter));
  for (const scene::Body& body : scene.bodies) {
    // A turning body carries along what it touches, at most as far out as the domain is wide.
    const double reach = scene.domain ? (scene.domain->max - scene.domain->min).norm() : 0;
    fastest = std::max(fastest, body.velocity.norm() + body.spin.norm() * std::min(reach, extent(body.shape)));
    for (std::size_t k = 1; k < body.path.size(); ++k) {
      const double span = body.path[k].time - body.path[k - 1].time;
      if (span > 0) fastest = std::max(fastest, (body.path[k].position - body.path[k - 1].position).norm() / span);
    }
  }
  if (scene.domain) travel = (scene.domain->max - scene.domain->min).norm();
  // Nothing can fall further than the domain is wide; the rest is room for what elastic rebound and squeezing add.
  return 2.0 * (fastest + std::sqrt(2.0 * scene.gravity.norm() * travel)) + 1.0;
}

double stable_time_step(const scene::Scene& scene) {
  double waves = 0, speed = 0;
  for (const scene::Snow& snow : scene.snow) {
    waves = std::max(waves, scene::sound_speed(scene.materials[static_cast<std::size_t>(snow.material)]));
    speed = std::max(speed, snow.velocity.norm());
  }
  for (const scene::Emitter& emitter : scene.emitters) {
    waves = std::max(waves, scene::sound_speed(scene.materials[static_cast<std::size_t>(emitter.material)]));
    speed = std::max(speed, scene::largest_speed(emitter));
  }
  const double h = scene.domain ? scene.domain->cell : 0.0;
  return waves + speed > 0 ? scene.time.cfl * h / (waves + speed) : 0.0;
}

std::shared_ptr<const Problem> make_problem(scene::Scene scene, Image image, std::string output) {
  scene::Particles particles = scene::sample(scene);
  std::vector<scene::TriangleMesh> meshes = scene::body_meshes(scene);
  return std::make_shared<const Problem>(
      Problem{std::move(scene), std::move(particles), std::move(meshes), image, std::move(output)});
}

bool facets_are_swept(const scene::Body& body) {
  return std::holds_alternative<scene::Mesh>(body.shape) ||
         (std::holds_alternative<scene::Box>(body.shape) && scene::may_turn(body));
}

FacetCounts facet_counts(const Problem& problem) {
  FacetCounts counts;
  for (std::size_t b = 0; b < problem.scene.bodies.size(); ++b) {
    const scene::Body& body = problem.scene.bodies[b];
    const std::size_t facets = std::holds_alternative<scene::Box>(body.shape) ? 12 : problem.meshes[b].triangles.size();
    counts.all += facets;
    if (facets_are_swept(body)) counts.swept += facets;
  }
  return counts;
}

graph::Environment environment(const Problem& problem) {
  const scene::Scene& scene = problem.scene;
  graph::Environment result;
  say_what_is_missing(result);
  const auto count = [](std::size_t n) { return graph::DomainSize{n}; };
  result.domains["materials"] = count(scene.materials.size());
  result.domains["bodies"] = count(scene.bodies.size());
  std::size_t key_frames = 0;
  for (const scene::Body& body : scene.bodies) key_frames += body.path.size();
  result.domains["key_frames"] = count(key_frames);
  const FacetCounts facets = facet_counts(problem);
  result.domains["facets"] = count(facets.all);
  result.domains["swept_facets"] = count(facets.swept);
  std::size_t distance_nodes = 0;
  for (const std::optional<DistanceGrid>& grid : distance_grids(problem)) distance_nodes += grid ? grid->count() : 0;
  result.domains["body_distances"] = count(distance_nodes);
  const auto image = [](int width, int height) {
    return graph::DomainSize{static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height), width, height};
  };
  result.domains["image"] = image(problem.image.width, problem.image.height);
  result.domains["shadow_map"] = image(2048, 2048);
  result.constants.push_back({"gravity", ElementType::vec3, graph::Vector3{scene.gravity.x(), scene.gravity.y(), scene.gravity.z()},
                              "m/s2", "acceleration by gravity"});
  add_view(scene, result);
  if (scene.has_particles()) {
    const std::size_t most =
        std::max<std::size_t>(problem.particles.position.size(), scene.emitters.empty() ? 0 : scene.max_particles);
    result.domains["particles"] = count(most);
    result.domains["emitters"] = count(scene.emitters.size());
    result.domains["sinks"] = count(scene.sinks.size());
    add_grid(*scene.domain, most, result);
    add_scales(problem, result);
    // At eight particles a cell whole snow needs far less, and a snowball torn to pieces has needed 0.4 a particle; the rest is for
    // snow of few particles.
    result.domains["surface_corners"] = count(result.domains["particles"].count + 4096);
  }
  if (scene.field) add_field(scene, result);
  result.listed_by = {{"grid_blocks", "active_blocks"}, {"block_table", "active_blocks"}};
  result.choices["snow"] = scene.has_particles() ? "particles" : "none";
  result.choices["emitters"] = scene.emitters.empty() ? "none" : "some";
  result.choices["sinks"] = scene.sinks.empty() || !scene.has_particles() ? "none" : "some";
  result.choices["time_step"] = scene.time.dt ? "fixed" : "auto";
  result.choices.merge(forms_for({}, result).choices);  // until a device is known
  return result;
}

}  // namespace firn::stages
