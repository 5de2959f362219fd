#include "app/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "app/sha256.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* particle_columns =
    ",mass,momentum_x,momentum_y,momentum_z,kinetic_energy,potential_energy,max_speed,min_jp,max_jp";
constexpr const char* flow_columns = ",particles,emitted_mass,removed_mass";
constexpr const char* field_columns = ",snow_mass,max_depth,min_density,max_density";

bool has(const graph::Plan& plan, const char* name, graph::ElementType type, const char* domain) {
  const int index = plan.buffer(name);
  if (index < 0) return false;
  const graph::PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(index)];
  return buffer.type == type && buffer.domain == domain && !buffer.texture && buffer.count > 0;
}

// Scalars as they lie on the device: four per vec3.
std::vector<float> floats(const execution::Execution& execution, const char* name) {
  const std::vector<std::byte> bytes = execution.read(name);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

// Lines of frames before `first_frame`, with the header; nothing where there is none, or another.
std::string lines_before(const fs::path& file, const std::string& header, std::uint64_t first_frame) {
  std::ifstream stream(file);
  std::string text, line;
  if (!std::getline(stream, line) || line != header) return "";
  text = line + "\n";
  while (std::getline(stream, line) && !stream.eof() && std::strtoull(line.c_str(), nullptr, 10) < first_frame) text += line + "\n";
  return text;
}

}  // namespace

Metrics::Metrics(const fs::path& run, const Loaded& loaded, const graph::Clock& start) : step_before_(start.step) {
  using enum graph::ElementType;
  const graph::Plan& plan = loaded.plan;
  has_particles_ = has(plan, "position", vec3, "particles") && has(plan, "velocity", vec3, "particles") &&
                   has(plan, "mass", float1, "particles") && has(plan, "plastic_det", float1, "particles");
  has_flow_ = has_particles_ && (plan.buffer("emitted_mass") >= 0 || plan.buffer("removed_mass") >= 0);
  has_field_ = has(plan, "depth", float1, "cells") && has(plan, "density", float1, "cells");
  const scene::Scene& scene = loaded.problem->scene;
  for (int axis = 0; axis < 3; ++axis) gravity_[static_cast<std::size_t>(axis)] = scene.gravity[axis];
  if (scene.field) cell_area_ = scene.field->size.x() / scene.field->cells_x * scene.field->size.y() / scene.field->cells_z;
  const std::string header = fmt::format("frame,step,time,dt{}{}{},steps_per_second", has_particles_ ? particle_columns : "",
                                         has_flow_ ? flow_columns : "", has_field_ ? field_columns : "");
  const fs::path file = run / "metrics.csv";
  std::string text = lines_before(file, header, start.frame);
  if (text.empty()) text = header + "\n";
  replace_file(file, text);
  file_ = std::make_unique<LineFile>(file);
}

std::string Metrics::particles(const execution::Execution& execution) const {
  const std::vector<float> position = floats(execution, "position"), velocity = floats(execution, "velocity"),
                           mass = floats(execution, "mass"), plastic = floats(execution, "plastic_det");
  double total = 0, kinetic = 0, potential = 0, fastest = 0;
  std::array<double, 3> momentum{};
  for (std::size_t i = 0; i < mass.size(); ++i) {
    double square = 0, height = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double v = velocity[4 * i + axis];
      square += v * v;
      momentum[axis] += mass[i] * v;
      height -= gravity_[axis] * position[4 * i + axis];
    }
    total += mass[i];
    kinetic += 0.5 * mass[i] * square;
    potential += mass[i] * height;
    fastest = std::max(fastest, square);
  }
  const auto [low, high] =
      plastic.empty() ? std::pair(1.0F, 1.0F) : std::pair(std::ranges::min(plastic), std::ranges::max(plastic));
  return fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", total, momentum[0], momentum[1],
                     momentum[2], kinetic, potential, std::sqrt(fastest), low, high);
}

// So many digits that what came less what went is what there is, to the last one.
std::string Metrics::flow(const execution::Execution& execution) {
  const graph::Plan& plan = execution.plan();
  const auto sum = [&](const char* name) {
    double total = 0;
    if (plan.buffer(name) >= 0)
      for (const float part : floats(execution, name)) total += part;
    return total;
  };
  return fmt::format(",{},{:.9g},{:.9g}", plan.environment.domains.at("particles").count, sum("emitted_mass"), sum("removed_mass"));
}

std::string Metrics::field(const execution::Execution& execution) const {
  const std::vector<float> depth = floats(execution, "depth"), density = floats(execution, "density");
  double mass = 0;
  float deepest = 0, lightest = std::numeric_limits<float>::max(), heaviest = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    mass += static_cast<double>(depth[i]) * density[i];
    deepest = std::max(deepest, depth[i]);
    if (!(depth[i] > 0)) continue;  // the density of no snow says nothing
    lightest = std::min(lightest, density[i]);
    heaviest = std::max(heaviest, density[i]);
  }
  return fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g}", mass * cell_area_, deepest, std::min(lightest, heaviest), heaviest);
}

void Metrics::add(execution::Execution& execution) {
  const auto begin = std::chrono::steady_clock::now();
  const graph::Clock& clock = execution.clock();
  const double passed = std::chrono::duration<double>(begin - time_before_).count();
  const double rate = passed > 0 ? static_cast<double>(clock.step - step_before_) / passed : 0;
  file_->add(fmt::format("{},{},{:.12g},{:.9g}{}{}{},{:.6g}\n", clock.frame - 1, clock.step, clock.time, clock.dt,
                         has_particles_ ? particles(execution) : "", has_flow_ ? flow(execution) : "",
                         has_field_ ? field(execution) : "", rate));
  step_before_ = clock.step;
  time_before_ = std::chrono::steady_clock::now();
  seconds_ += std::chrono::duration<double>(time_before_ - begin).count();
}

std::string hash_of_metrics(const fs::path& file) {
  std::ifstream stream(file);
  std::string results;
  for (std::string line; std::getline(stream, line);) results += line.substr(0, line.rfind(',')) + "\n";
  return sha256(results);
}

}  // namespace firn::app
