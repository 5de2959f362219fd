// The form of a scene as scene/read_*.cpp reads it; tests/app/schema.cpp holds the two together.

#include <optional>

#include "app/schema.h"
#include "scene/materials.h"

namespace firn::app {
namespace {

using nlohmann::json;

struct Limits {
  std::optional<double> min, max, above, below;
};
constexpr Limits positive{{}, {}, 0.0, {}}, not_negative{0.0, {}, {}, {}}, any{};

json number(const char* doc, const Limits& limits = any) {
  json schema = {{"type", "number"}};
  if (doc[0] != '\0') schema["description"] = doc;
  if (limits.min) schema["minimum"] = *limits.min;
  if (limits.max) schema["maximum"] = *limits.max;
  if (limits.above) schema["exclusiveMinimum"] = *limits.above;
  if (limits.below) schema["exclusiveMaximum"] = *limits.below;
  return schema;
}

json integer(const char* doc, const Limits& limits) {
  json schema = number(doc, limits);
  schema["type"] = "integer";
  return schema;
}

json numbers(std::size_t count, const char* doc, const Limits& limits = any) {
  json schema = {{"type", "array"}, {"minItems", count}, {"maxItems", count}, {"items", number("", limits)}};
  if (doc[0] != '\0') schema["description"] = doc;
  return schema;
}
json vector(const char* doc, const Limits& limits = any) { return numbers(3, doc, limits); }

json text(const char* doc) { return {{"type", "string"}, {"description", doc}}; }

json map(const json& properties, const std::vector<std::string>& required = {}) {
  json schema = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

// For oneOf and anyOf: that one of the keys is there.
json one_of_keys(const std::vector<std::string>& keys) {
  json choices = json::array();
  for (const std::string& key : keys) choices.push_back({{"required", {key}}});
  return choices;
}

json list_of(const json& items, const char* doc) { return {{"type", {"array", "null"}}, {"items", items}, {"description", doc}}; }

json orientation() {
  return {{"anyOf", json::array({numbers(4, "unit quaternion [x, y, z, w]"),
                                 map({{"axis", vector("")}, {"degrees", number("")}}, {"axis", "degrees"})})}};
}

json color() { return vector("sRGB, each from 0 to 1", {0.0, 1.0, {}, {}}); }

// Shapes; of snow, spheres and boxes say where they are, bodies may have their place beside the shape.
json sphere(bool placed) {
  return map({{"center", vector("m")}, {"radius", number("m", positive)}},
             placed ? std::vector<std::string>{"center", "radius"} : std::vector<std::string>{"radius"});
}
json box(bool placed) {
  const json by_corners = map({{"min", vector("m")}, {"max", vector("m")}}, {"min", "max"});
  const json by_size = map({{"center", vector("m")}, {"size", vector("m, along x, y and z", positive)}},
                           placed ? std::vector<std::string>{"center", "size"} : std::vector<std::string>{"size"});
  return {{"anyOf", json::array({by_size, by_corners})}};
}
json capsule() {
  return map({{"from", vector("m")}, {"to", vector("m")}, {"radius", number("m", positive)}}, {"from", "to", "radius"});
}
json mesh() {
  return map(
      {{"file", text(".obj, .ply or .stl, relative to this file")}, {"scale", number("metres per unit of the file", positive)}},
      {"file"});
}

json material() {
  const Limits density{{}, 2000.0, 0.0, {}}, fraction{{}, {}, 0.0, 1.0};
  return map({{"preset", {{"enum", scene::preset_names()}}},
              {"density", number("kg/m3, at first", density)},
              {"young", number("Young's modulus, Pa", positive)},
              {"poisson", number("Poisson's ratio", {0.0, {}, {}, 0.5})},
              {"hardening", number("how much stiffer pressed snow is", not_negative)},
              {"critical_compression", number("compression that lasts", fraction)},
              {"critical_stretch", number("stretch that lasts", fraction)},
              {"min_density", number("kg/m3; height field: less dense snow is pressed only", density)},
              {"max_density", number("kg/m3; height field: denser it cannot be pressed", density)},
              {"slope", number("m/m; height field: the steepest that stands", not_negative)},
              {"color", color()}});
}

json snow() {
  const json points = map({{"file", text(".npy, N x 3 or N x 6 with velocities")}, {"mass", number("kg per particle", positive)}},
                          {"file", "mass"});
  json solid_mesh = mesh();
  solid_mesh["properties"]["rotate"] = orientation();
  solid_mesh["properties"]["translate"] = vector("m, after scale and rotate");
  json schema = map({{"sphere", sphere(true)},
                     {"box", box(true)},
                     {"capsule", capsule()},
                     {"mesh", solid_mesh},
                     {"points", points},
                     {"material", text("one of the materials above, or a preset")},
                     {"velocity", vector("m/s")},
                     {"spin", vector("rad/s")},
                     {"orientation", orientation()},
                     {"per_cell", integer("particles per cell of the grid", {1.0, 64.0, {}, {}})},
                     {"sampling", {{"enum", {"jittered", "poisson"}}, {"description", "poisson: particles keep a distance"}}}},
                    {"material"});
  schema["oneOf"] = one_of_keys({"sphere", "box", "capsule", "mesh", "points"});
  return schema;
}

json span(json properties) {
  properties["from"] = number("s", not_negative);
  properties["until"] = number("s", not_negative);
  return properties;
}

json emitter() {
  const json snowfall = map({{"center", vector("m, of a level rectangle")},
                             {"size", numbers(2, "m, along x and z", positive)},
                             {"rate", number("kg/(m2 s)", not_negative)},
                             {"velocity", vector("m/s")}},
                            {"center", "size", "rate"});
  const json gun = map({{"position", vector("m, centre of the nozzle")},
                        {"direction", vector("the way it points")},
                        {"speed", number("m/s", positive)},
                        {"spread", number("degrees, from the direction to the outermost flakes", {0.0, 90.0, {}, {}})},
                        {"radius", number("m, of the nozzle", positive)},
                        {"rate", number("kg/s", not_negative)}},
                       {"position", "direction", "speed", "radius", "rate"});
  json schema = map(span({{"snowfall", snowfall},
                          {"gun", gun},
                          {"material", text("one of the materials above, or a preset")},
                          {"per_cell", integer("decides the mass of a particle, as of snow", {1.0, 64.0, {}, {}})}}),
                    {"material"});
  schema["oneOf"] = one_of_keys({"snowfall", "gun"});
  return schema;
}

json sink() { return map(span({{"box", box(true)}}), {"box"}); }

// A number for all cells, or a picture of it.
json source(const char* key, const char* doc, const Limits& limits) {
  return {{"description", doc},
          {"anyOf", json::array({number("", limits), map({{"image", text(".png or .npy, relative to this file")},
                                                          {key, number("where the image is white", limits)}},
                                                         {"image"})})}};
}

json field() {
  return map({{"size", numbers(2, "m, along x and z", positive)},
              {"cells", {{"type", "array"}, {"minItems", 2}, {"maxItems", 2}, {"items", integer("", {1.0, 1048576.0, {}, {}})}}},
              {"origin", numbers(2, "lowest corner, x and z, m")},
              {"material", text("one of the materials above, or a preset")},
              {"ground", source("metres", "height of the ground, m", any)},
              {"depth", source("metres", "depth of the snow, m", not_negative)},
              {"density", source("density", "kg/m3 (default: the material's)", positive)}},
             {"size", "cells", "material", "depth"});
}

json body() {
  const json plane = map({{"point", vector("m")}, {"normal", vector("points out of the body")}}, {"normal"});
  const json key_frame =
      map({{"t", number("s", not_negative)}, {"position", vector("m")}, {"orientation", orientation()}}, {"t", "position"});
  json schema = map({{"plane", plane},
                     {"sphere", sphere(false)},
                     {"box", box(false)},
                     {"capsule", capsule()},
                     {"mesh", mesh()},
                     {"name", text("")},
                     {"position", vector("m")},
                     {"orientation", orientation()},
                     {"velocity", vector("m/s")},
                     {"spin", vector("rad/s")},
                     {"mass", number("kg; without it the body moves as told", positive)},
                     {"friction", number("Coulomb coefficient", not_negative)},
                     {"color", color()},
                     {"path", list_of(key_frame, "where the body is when")}});
  schema["oneOf"] = one_of_keys({"plane", "sphere", "box", "capsule", "mesh"});
  schema["not"] = {{"required", {"plane", "mass"}}};
  return schema;
}

json time() {
  const json step = {{"description", "s, or auto: by cfl"},
                     {"anyOf", json::array({number("", positive), json{{"const", "auto"}}})}};
  return map({{"dt", step},
              {"cfl", number("share of a cell that waves cross in an automatic step", {{}, 1.0, 0.0, {}})},
              {"fps", number("pictures per second", positive)},
              {"end", number("s", positive)}});
}

}  // namespace

json scene_schema() {
  json schema = map(
      {{"firn", {{"const", 1}, {"description", "version of the format"}}},
       {"name", text("the scene's name (default: the file's)")},
       {"doc", text("what happens, in a line")},
       {"seed", integer("of everything random", not_negative)},
       {"time", time()},
       {"gravity", vector("m/s2")},
       {"domain", map({{"min", vector("m")},
                       {"max", vector("m")},
                       {"cell", number("m", positive)},
                       {"blocks", integer("blocks of 4 x 4 x 4 nodes that snow may reach at once", {1.0, {}, {}, {}})}},
                      {"min", "max", "cell"})},
       {"materials", {{"type", {"object", "null"}}, {"additionalProperties", material()}}},
       {"snow", list_of(snow(), "shapes that are filled with particles")},
       {"emitters", list_of(emitter(), "snow that comes while time passes")},
       {"sinks", list_of(sink(), "boxes that particles vanish in")},
       {"max_particles", integer("that there may be at once; needed with emitters", {1.0, 2147483648.0, {}, {}})},
       {"field", field()},
       {"bodies", list_of(body(), "rigid bodies")},
       {"camera", map({{"from", vector("m")}, {"to", vector("m")}, {"fov", number("degrees, vertical", {{}, {}, 1.0, 170.0})}})},
       {"light", map({{"sun", vector("the way the light goes")}})}},
      {"firn"});
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "Firn scene";
  schema["anyOf"] = one_of_keys({"snow", "emitters", "field"});
  return schema;
}

}  // namespace firn::app
