#include "tests/fuzz/inputs.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "app/explain.h"
#include "app/load.h"
#include "config/node.h"
#include "graph/glsl.h"
#include "tests/graph/executions.h"

namespace firn::fuzz {
namespace {

namespace fs = std::filesystem;

// Refuses what needs more than a moment to sample.
constexpr double memory = 32 << 20;

bool leads_out(const std::string& text) { return text.starts_with('/') || text.find("..") != std::string::npos; }

bool leads_out(const config::Node& node) {
  return leads_out(node.scalar) || std::ranges::any_of(node.items, [](const config::Node& item) { return leads_out(item); }) ||
         std::ranges::any_of(node.entries,
                             [](const config::Entry& entry) { return leads_out(entry.key) || leads_out(entry.value); });
}

bool stays_inside(std::string_view text) {
  config::Diagnostics told_later;
  return !leads_out(config::parse(text, "input", told_later));
}

std::optional<app::Loaded> check(const fs::path& pipeline, const fs::path& scene) {
  app::Inputs inputs;
  inputs.pipeline = pipeline.string();
  inputs.scene = scene.string();
  inputs.memory = memory;
  try {
    return app::load(inputs, "");
  } catch (const config::InputError& error) {
    for (const config::Diagnostic& diagnostic : error.diagnostics().all())
      if (diagnostic.text.empty()) throw std::logic_error("an error without a text");
    return std::nullopt;
  }
}

// Setup, two steps with a frame between them and one more frame, every repeat at one turn or two.
void check_barriers(const graph::Plan& plan) {
  std::vector<const graph::Repeat*> repeats;
  for (const std::vector<graph::Op>* phase : {&plan.setup, &plan.step, &plan.frame}) test::collect_repeats(*phase, repeats);
  for (const std::int64_t most : {1, 2}) {
    if (most == 2 && repeats.size() > 8) return;  // those in one another would double the turns again and again
    const test::Choices choices{[&](const graph::Repeat& repeat) { return std::min(repeat.max, most); }, [](int) { return true; }};
    if (const auto hazard = test::first_hazard(plan, {test::trace(plan, "sfsf", choices)}))
      throw std::logic_error(test::describe(plan, *hazard));
  }
}

void look_at(const app::Loaded& loaded) {
  check_barriers(loaded.plan);
  if (app::explain_as_text(loaded.plan, loaded.pipeline.doc).empty() || app::explain_as_dot(loaded.plan, "").empty() ||
      app::explain_as_json(loaded.plan).dump(-1, ' ', false, nlohmann::json::error_handler_t::strict).empty())
    throw std::logic_error("a plan without an explanation");
}

void generate_kernels(const graph::Plan& plan) {
  for (int s = 0; s < static_cast<int>(plan.stages.size()); ++s) {
    const std::vector<graph::Work>& work = plan.stages[static_cast<std::size_t>(s)].spec.work;
    for (int w = 0; w < static_cast<int>(work.size()); ++w)
      if (std::holds_alternative<graph::Dispatch>(work[static_cast<std::size_t>(w)]) &&
          graph::compute_prelude(plan, s, w, {}).empty())
        throw std::logic_error("a kernel without declarations");
    graph::parameter_block(plan, s);
  }
}

}  // namespace

void check_pipeline(const Sandbox& sandbox, std::string_view text) {
  if (!stays_inside(text)) return;
  if (const auto loaded = check(sandbox.put("input.yaml", text), "")) look_at(*loaded);
}

void check_scene(const Sandbox& sandbox, std::string_view text) {
  if (!stays_inside(text)) return;
  const bool has_field = text.find("\nfield") != std::string_view::npos;
  check(sandbox.path() / (has_field ? "heightfield_contour.yaml" : "snow.yaml"), sandbox.put("scenes/input.yaml", text));
}

void check_stage(const Sandbox& sandbox, std::string_view text) {
  sandbox.put("input.comp", text);
  if (const auto loaded = check(sandbox.path() / "stage.yaml", "")) {
    look_at(*loaded);
    generate_kernels(loaded->plan);
  }
}

}  // namespace firn::fuzz
