#include "tests/stages/harness.h"

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "app/arrays.h"
#include "stages/forms.h"
#include "stages/mpm_ports.h"

namespace firn::test {
namespace {

template <typename T>
std::vector<T> typed(std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::string temporary_file(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / ("firn-test-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(path) << text;
  return path.string();
}

}  // namespace

gpu::Device& device() {
  static const std::unique_ptr<gpu::Device> one = gpu::Device::open();
  return *one;
}

std::vector<std::filesystem::path> shader_folders() { return {std::filesystem::path(FIRN_SOURCE_DIR) / "shaders"}; }

Arrays run_pipeline(const std::string& yaml, const graph::Environment& environment, const graph::Registry& registry,
                    const Arrays& in, double dt, int steps, bool barriers_all) {
  config::Diagnostics diagnostics;
  const std::string file = temporary_file(yaml);
  const graph::PipelineSpec pipeline = graph::load_pipeline(file, {}, diagnostics);
  std::filesystem::remove(file);
  const graph::Plan plan = graph::compile(pipeline, registry, environment, diagnostics);
  config::throw_if_errors(diagnostics);
  execution::Execution execution(device(), plan, registry, {shader_folders(), barriers_all, false});
  for (const auto& [name, values] : in.floats) app::fill_buffer(execution, name, std::as_bytes(std::span(values)));
  for (const auto& [name, values] : in.integers) app::fill_buffer(execution, name, std::as_bytes(std::span(values)));
  execution.setup();
  for (int i = 0; i < steps; ++i) {
    execution.clock().dt = dt;
    execution.step();
  }
  execution.check_faults();
  Arrays out;
  for (const graph::PlannedBuffer& buffer : plan.buffers) {
    if (buffer.texture) continue;
    const std::vector<std::byte> bytes = app::read_buffer(execution, buffer.name);
    if (graph::scalar(buffer.type) == graph::Scalar::real)
      out.floats[buffer.name] = typed<float>(bytes);
    else
      out.integers[buffer.name] = typed<std::int32_t>(bytes);
  }
  return out;
}

Arrays run_stage(const StageRun& run) {
  graph::Environment environment = run.environment;
  const graph::Registry registry = stages::all_stages(nullptr);
  if (const graph::StageType* type = registry.find(run.stage))
    for (const graph::Port& port : type->spec.ports) environment.provided.insert(port.name);
  return run_pipeline("firn: 1\nstep:\n  - " + run.stage + ": " + run.options + "\n", environment, registry, run.in, run.dt, 1);
}

graph::Environment grid_environment(const GridSetup& setup) {
  using graph::ElementType;
  graph::Environment result;
  const auto count = [](std::uint64_t n) { return graph::DomainSize{n}; };
  const auto [nx, ny, nz] = setup.nodes;
  const auto n = [](int value) { return static_cast<std::uint64_t>(value); };
  const stages::mpm::BlockRoom room = stages::mpm::block_room(setup.nodes, setup.particles);
  result.domains = {{"particles", count(setup.particles)},   {"materials", count(setup.materials)},
                    {"bodies", count(setup.bodies)},         {"key_frames", count(setup.key_frames)},
                    {"nodes", count(n(nx) * n(ny) * n(nz))}, {"grid_rows", count(n(ny) * n(nz))},
                    {"grid_blocks", count(room.blocks)},     {"block_table", count(room.table)}};
  result.listed_by = {{"grid_blocks", "active_blocks"}, {"block_table", "active_blocks"}};
  const auto scale = [](double bound) { return std::exp2(std::floor(std::log2(2147483647.0 / bound))); };
  result.constants = {{"grid_min", ElementType::vec3, setup.grid_min, "m", ""},
                      {"grid_cell", ElementType::float1, setup.cell, "m", ""},
                      {"grid_nodes", ElementType::ivec3, graph::Vector3{double(nx), double(ny), double(nz)}, "1", ""},
                      {"gravity", ElementType::vec3, setup.gravity, "m/s2", ""},
                      {"mass_scale", ElementType::float1, scale(setup.mass_bound), "1/kg", ""},
                      {"momentum_scale", ElementType::float1, scale(setup.momentum_bound), "s/(kg m)", ""},
                      {"crowd", ElementType::float1, setup.crowd, "1", ""}};
  result.choices = stages::forms_for({}, result).choices;
  return result;
}

}  // namespace firn::test
