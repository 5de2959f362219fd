// Forms of kernels for other devices than the one at hand: they give what the plain ones give, repeat to the bit, and are chosen or
// refused by what the device has.

#include <fmt/format.h>

#include <fstream>

#include "graph/execution/kernels.h"
#include "stages/forms.h"
#include "stages/mpm/gather_velocities.h"
#include "stages/process.h"
#include "tests/stages/ball_scene.h"
#include "tests/stages/simulation.h"
#include "tests/stages/stored_blocks.h"

using namespace firn;
using namespace firn::test;
namespace ref = firn::reference;

namespace {

constexpr const char* sort_line = "  - mpm.sort: {nodes: active}\n";

std::string gather_line(const std::string& options, const std::string& stage = "mpm.gather_velocities") {
  return "  - " + stage + ": {" + options + "}\n";
}

Arrays inputs(const RandomSnow& snow) {
  Arrays in = snow.arrays({"position", "velocity", "mass"});
  in.floats["stress"] = flat(symmetric_stress(snow));
  return in;
}

// All in a few cells, hundreds in each: many times what a group takes at once.
RandomSnow crowd(std::uint64_t seed) {
  RandomSnow snow = lumps(seed, 1500);
  for (std::size_t p = 0; p < snow.particles.position.size(); ++p)
    snow.particles.position[p] = single(Vector3d(snow.grid.h * Vector3d(9.7, 10.2, 11.9) + 0.1 * snow.particles.position[p]));
  return snow;
}

// A plan of mpm_snow with this form, never run.
app::Loaded loaded_with(const std::string& form, const std::string& scene) {
  app::Inputs inputs;
  inputs.pipeline = pipeline_file("mpm_snow");
  inputs.scene = scene;
  inputs.set = {"mpm.gather_velocities.form=" + form};
  return app::load(inputs, "");
}

}  // namespace

TEST_CASE("every form of gathering gives the reference's sums, also where a cell holds hundreds of particles") {
  INFO("seed " << seed());
  const RandomSnow snow = crowd(seed());
  ref::GridState expected = ref::particles_to_grid(snow.particles, snow.grid, ref::Kernel::cubic);
  expected.force = ref::grid_forces(snow.particles, symmetric_stress(snow), snow.grid, ref::Kernel::cubic);
  ref::grid_update(expected, Vector3d(0, -9.81, 0), block_dt);
  const auto momentum = [](const std::vector<float>& mass, std::vector<float> velocity) {
    for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] *= mass[i / 3];
    return velocity;
  };
  const std::vector<float> mass = flat(expected.mass);
  for (const char* form : {"texture", "shared"}) {
    CAPTURE(form);
    const Arrays out = run(snow, sort_line + gather_line(std::string("form: ") + form), inputs(snow));
    CHECK(relative_error(whole(out, "grid_mass", snow.grid.nodes), mass) <= 1e-5);
    CHECK(relative_error(momentum(mass, whole(out, "grid_velocity_before", snow.grid.nodes)),
                         momentum(mass, flat(expected.velocity_before))) <= 1e-5);
    CHECK(relative_error(momentum(mass, whole(out, "grid_velocity", snow.grid.nodes)), momentum(mass, flat(expected.velocity))) <=
          1e-5);
  }
}

TEST_CASE("forms in shared memory repeat to the bit, however blocks are numbered") {
  INFO("seed " << seed());
  const RandomSnow snow = lumps(seed(), 3000);
  for (const char* kernel : {"cubic", "quadratic"}) {
    CAPTURE(kernel);
    const std::string with = std::string("kernel: ") + kernel;
    const auto once = [&] {
      return run(snow,
                 sort_line + gather_line(with + ", form: shared") + "  - mpm.grid_to_particles: {nodes: by_block, " + with + "}\n",
                 inputs(snow));
    };
    const Arrays one = once(), other = once();
    for (const char* buffer : {"velocity", "velocity_gradient"}) CHECK(one.floats.at(buffer) == other.floats.at(buffer));
    for (const char* buffer : {"grid_mass", "grid_velocity_before", "grid_velocity"})
      CHECK(whole(one, buffer, snow.grid.nodes) == whole(other, buffer, snow.grid.nodes));
  }
}

TEST_CASE("the form for subgroups does what the one for groups does, to the bit") {
  INFO("seed " << seed());
  graph::StageSpec by_subgroups = stages::mpm::gather_velocities();
  by_subgroups.name = "test.gather_by_subgroups";
  for (graph::Work& work : by_subgroups.work)
    if (auto& dispatch = std::get<graph::Dispatch>(work); dispatch.kernel == "mpm/gather_block_sums.comp")
      dispatch.kernel = std::string(FIRN_SOURCE_DIR) + "/tests/stages/shaders/gather_by_subgroups.comp";
  for (const RandomSnow& snow : {lumps(seed(), 3000), crowd(seed())}) {
    const auto gathered = [&](const std::string& stage) {
      graph::Registry registry = stages::all_stages(nullptr);
      registry.add(by_subgroups);
      graph::Environment environment = grid_environment(snow.setup());
      environment.provided = {"position", "velocity", "mass", "stress"};
      return run_pipeline("firn: 1\nstep:\n" + std::string(sort_line) + gather_line("form: shared", stage), environment, registry,
                          inputs(snow), block_dt, 1);
    };
    const Arrays groups = gathered("mpm.gather_velocities"), subgroups = gathered(by_subgroups.name);
    for (const char* buffer : {"grid_mass", "grid_velocity_before", "grid_velocity"})
      CHECK(whole(groups, buffer, snow.grid.nodes) == whole(subgroups, buffer, snow.grid.nodes));
  }
}

TEST_CASE("a whole run by the forms for GPUs stays beside one by those for software renderers") {
  Simulation plain("mpm_snow", ball_text),
      shared("mpm_snow", ball_text, {"mpm.gather_velocities.form=shared", "mpm.grid_to_particles.nodes=by_block"});
  for (Simulation* simulation : {&plain, &shared}) simulation->steps(60);
  const std::vector<Vector3d> a = plain.vectors("position"), b = shared.vectors("position");
  REQUIRE(a.size() > 500);
  double apart = 0;
  for (std::size_t p = 0; p < a.size(); ++p) apart = std::max(apart, (a[p] - b[p]).norm());
  CHECK(apart <= 1e-4 * 0.0625);
  CHECK(apart > 0);  // else both would be the same kernels
}

TEST_CASE("a form whose extension the device lacks is refused by name, before anything runs") {
  const SceneFile scene(ball_text);
  const app::Loaded loaded = loaded_with("subgroup", scene.path);
  const auto missing = [&](int size) { return execution::missing_extensions(loaded.plan, {.subgroup_size = size}); };
  CHECK(missing(32).empty());
  CHECK(missing(16).empty());
  REQUIRE(missing(0).size() == 2);  // in setup and step
  CHECK(missing(0).front() ==
        "mpm.gather_velocities with 'form: subgroup' needs GL_KHR_shader_subgroup_basic, which the device has not; 'form: shared' "
        "needs no extension");
  CHECK(missing(8).front().find("subgroups of 16 invocations; the device's have 8") != std::string::npos);
  if (execution::traits_of(device()).subgroup_size >= 16) return;
  CHECK_THROWS_AS(execution::Execution(device(), loaded.plan, loaded.registry, {shader_folders(), false, false}), gpu::DeviceError);
}

TEST_CASE("the kernel for subgroups is valid GLSL with the extension") {
  const std::filesystem::path validator = stages::find_program("glslangValidator");
  if (validator.empty()) return;  // no device here has the extension
  const SceneFile scene(ball_text);
  const app::Loaded loaded = loaded_with("subgroup", scene.path);
  int checked = 0;
  for (int s = 0; s < static_cast<int>(loaded.plan.stages.size()); ++s) {
    const graph::PlannedStage& stage = loaded.plan.stages[static_cast<std::size_t>(s)];
    for (int w = 0; w < static_cast<int>(stage.spec.work.size()); ++w) {
      const auto* dispatch = std::get_if<graph::Dispatch>(&stage.spec.work[static_cast<std::size_t>(w)]);
      if (!graph::needs_subgroups(stage) || dispatch == nullptr) continue;
      const std::string source =
          execution::kernel_source(loaded.plan, s, w, dispatch->kernel, gpu::ShaderKind::compute,
                                   {.version_directive = "#version 450 core", .float_atomics = false, .subgroup_size = 32},
                                   shader_folders())
              .text;
      CHECK(source.find("#extension GL_KHR_shader_subgroup_basic : require") != std::string::npos);
      const std::filesystem::path file = std::filesystem::temp_directory_path() / fmt::format("firn-{}.comp", getpid()),
                                  log = file.string() + ".log";
      std::ofstream(file) << source;
      stages::Process process(validator, {file.string()}, log, log);
      const int status = process.finish();
      std::ifstream stream(log);
      INFO(dispatch->kernel << "\n" << std::string(std::istreambuf_iterator<char>(stream), {}));
      CHECK(status == 0);
      std::filesystem::remove(file);
      std::filesystem::remove(log);
      ++checked;
    }
  }
  CHECK(checked == 4);
}

TEST_CASE("auto takes the form that the device calls for, and says why") {
  graph::Environment environment = grid_environment(RandomSnow(1).setup());
  const auto chosen = [&](const stages::DeviceProfile& device) {
    const stages::Forms forms = stages::forms_for(device, environment);
    CHECK(forms.reason.size() > 20);
    return forms.choices.at("form") + " " + forms.choices.at("nodes");
  };
  stages::DeviceProfile gpu = stages::assumed_hardware(true);
  CHECK(chosen({}) == "texture by_cell");
  CHECK(chosen(gpu) == "subgroup by_block");
  gpu.subgroup_size = 8;
  CHECK(chosen(gpu) == "shared by_block");
  CHECK(chosen(stages::assumed_hardware(false)) == "shared by_block");
  // Sums of all blocks must fit one storage block.
  environment.domains["grid_blocks"].count = 300'000;
  CHECK(chosen(gpu) == "texture by_block");
  CHECK(stages::forms_for(gpu, environment).reason.find("300000 blocks would take 2748 MiB") != std::string::npos);
}
