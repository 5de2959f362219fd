#pragma once

// How read_scene is put together: one function per section of the file. Internal to scene/.

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/reader.h"
#include "scene/scene.h"

namespace firn::scene::detail {

using config::Diagnostics;
using config::Node;
using config::Range;
using config::Reader;

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr Range positive{0, infinity, true, false};
inline constexpr Range not_negative{0, infinity, false, false};
inline constexpr double most_particles = 2147483648.0;  // 2^31: particles are counted in 32 bits on the device

// --- read_values.cpp: kinds of values that several sections share ---------------------------------------------------------

Vector3d vector3(Reader& reader, std::string_view key, const Vector3d& fallback, const Range& range = {});
std::optional<Vector3d> required_vector3(Reader& reader, std::string_view key, const Range& range = {});
// A list of exactly `count` numbers.
std::optional<std::vector<double>> read_numbers(const Node& node, std::string_view what, std::size_t count, const Range& range,
                                                Diagnostics& diagnostics);
// A unit quaternion [x, y, z, w], or {axis, degrees}.
Quaterniond orientation(Reader& reader, const Quaterniond& fallback, std::string_view key = "orientation");
// The items of a list; a key with nothing behind it is an empty one.
const std::vector<Node>& list(Reader& reader, std::string_view key);
// An existing file, relative to `folder`.
std::optional<std::string> required_file(Reader& reader, std::string_view key, const std::filesystem::path& folder);
// The one key of `kinds` that the map has, with its value; none and several are errors.
struct Kind {
  std::string name;
  const Node* node = nullptr;
};
std::optional<Kind> one_of(Reader& reader, const std::vector<std::string>& kinds, const std::string& what);

std::string to_text(const Vector3d& vector);  // "[1, 2.5, 3]"

// --- read_shapes.cpp: shapes as the file writes them; nothing where an error was reported -----------------------------------

std::optional<Plane> read_plane(const Node& node, Diagnostics& diagnostics);
std::optional<Sphere> read_sphere(const Node& node, bool center_required, Diagnostics& diagnostics);
std::optional<Box> read_box(const Node& node, bool center_required, Diagnostics& diagnostics);
std::optional<Capsule> read_capsule(const Node& node, Diagnostics& diagnostics);
std::optional<Mesh> read_mesh(const Node& node, const std::filesystem::path& folder, Diagnostics& diagnostics);
// Keys that place snow of a mesh, where they stand at or in the mesh of a body: errors that name the body's own keys.
void tell_placement_of_snow(Reader& reader);
// Keys of a mesh that stand beside it: errors that tell the right place.
void tell_keys_of_mesh(Reader& reader, const std::vector<const char*>& keys);
// With `rotate` and `translate` besides; reads the file. What is wrong with the mesh, but can be borne, is a warning.
std::optional<SolidMesh> read_solid_mesh(const Node& node, const std::filesystem::path& folder, Diagnostics& diagnostics);

// --- the sections -------------------------------------------------------------------------------------------------------

std::vector<Material> read_materials(const Node& node, Diagnostics& diagnostics);
// The material or preset that `key` names; a preset is added to `materials` on its first use.
std::optional<int> required_material(Reader& reader, std::string_view key, std::vector<Material>& materials);

std::optional<Domain> read_domain(const Node& node, Diagnostics& diagnostics);
std::optional<Snow> read_snow(const Node& node, const std::filesystem::path& folder, std::vector<Material>& materials,
                              Diagnostics& diagnostics);
std::optional<Emitter> read_emitter(const Node& node, std::vector<Material>& materials, Diagnostics& diagnostics);
std::optional<Sink> read_sink(const Node& node, Diagnostics& diagnostics);
std::optional<Field> read_field(const Node& node, const std::filesystem::path& folder, std::vector<Material>& materials,
                                Diagnostics& diagnostics);
// `number` counts bodies from 1, for the name of one that has none.
std::optional<Body> read_body(const Node& node, const std::filesystem::path& folder, std::size_t number, Diagnostics& diagnostics);

// --- check.cpp: what needs more than one section ---------------------------------------------------------------------------

void check_snow(const std::vector<Snow>& snow, const Domain& domain, Diagnostics& diagnostics);
void check_emitters(const Scene& scene, Diagnostics& diagnostics);
void check_bodies(const std::vector<Body>& bodies, const Domain& domain, const Time& time, const Vector3d& gravity,
                  Diagnostics& diagnostics);

}  // namespace firn::scene::detail
