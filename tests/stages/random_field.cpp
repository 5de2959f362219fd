#include "tests/stages/random_field.h"

namespace firn::test {

Cells single(const Cells& cells) { return cells.cast<float>().cast<double>(); }

std::vector<float> flat(const Cells& cells) {
  std::vector<float> values;
  for (int z = 0; z < cells.rows(); ++z)
    for (int x = 0; x < cells.cols(); ++x) values.push_back(static_cast<float>(cells(z, x)));
  return values;
}
std::vector<std::int32_t> flat(const Owners& owners) { return {owners.data(), owners.data() + owners.size()}; }

RandomField::RandomField(std::uint64_t seed, int rows, int columns, int balls) : random(seed) {
  const double h = single(random.uniform(0.05, 0.2));
  field = reference::random_field(random, rows, columns, h);
  field.origin = field.origin.cast<float>().cast<double>();
  field.ground = single(Cells(0.3 * field.ground));
  field.snow = single(field.snow);
  field.density = single(field.density);
  // Bare cells and shallow ones too.
  for (int i = 0; i < rows * columns / 20; ++i)
    field.snow(random.integer(0, rows - 1), random.integer(0, columns - 1)) = random.uniform(0, 1) < 0.5 ? 0.0 : single(1e-3);
  underside = reference::nothing_above(rows, columns);
  for (int b = 0; b < balls; ++b) {
    velocity.push_back(single(random.vector(3)));
    const Vector3d center(field.origin.x() + h * random.uniform(0, columns), random.uniform(0.4, 1.4),
                          field.origin.y() + h * random.uniform(0, rows));
    reference::add_ball(underside, field, b, center, random.uniform(2, 8) * h);
  }
  underside.height = single(underside.height);
  overlap = single(reference::overlap(field, underside));
}

graph::Environment field_environment(int rows, int columns, double cell, std::uint64_t bodies, const reference::Vector2d& origin) {
  using graph::ElementType;
  graph::Environment result;
  const auto grid = [](int width, int height) {
    const auto w = static_cast<std::uint64_t>(width), h = static_cast<std::uint64_t>(height);
    return graph::DomainSize{w * h, width, height, {h, w}};
  };
  result.domains = {{"cells", grid(columns, rows)}, {"tiles", grid((columns + 15) / 16, (rows + 15) / 16)},
                    {"bodies", {bodies}},           {"facets", {0}},
                    {"swept_facets", {0}},          {"key_frames", {0}}};
  result.constants = {{"field_min", ElementType::vec3, graph::Vector3{origin.x(), 0, origin.y()}, "m", ""},
                      {"field_cell", ElementType::float1, cell, "m", ""},
                      {"min_density", ElementType::float1, 30.0, "kg/m3", ""},
                      {"max_density", ElementType::float1, 500.0, "kg/m3", ""},
                      {"material_slope", ElementType::float1, 0.6, "m/m", ""},
                      {"gravity", ElementType::vec3, graph::Vector3{0, -9.81, 0}, "m/s2", ""}};
  return result;
}

graph::Environment RandomField::environment() const {
  return field_environment(field.rows(), field.columns(), field.h, velocity.size(), field.origin);
}

Arrays RandomField::arrays(std::initializer_list<const char*> ports) const {
  Arrays result;
  for (const std::string port : ports) {
    if (port == "ground")
      result.floats[port] = flat(field.ground);
    else if (port == "depth")
      result.floats[port] = flat(field.snow);
    else if (port == "density")
      result.floats[port] = flat(field.density);
    else if (port == "underside")
      result.floats[port] = flat(underside.height);
    else if (port == "overlap")
      result.floats[port] = flat(overlap);
    else if (port == "body_velocity")
      result.floats[port] = flat(velocity);
    else if (port == "owner")
      result.integers[port] = flat(underside.owner);
    else
      throw std::logic_error("no random array " + port);
  }
  return result;
}

}  // namespace firn::test
