#pragma once

// A use of a stage by itself, before anything is bound; and what all uses together write and read.

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graph/plan.h"
#include "graph/registry.h"

namespace firn::graph {

// Of a stage that is a file, or of one of the registry's. nullptr: there is none.
const StageSpec* spec_of(const StageUse& use, const PipelineSpec& pipeline, const Registry& registry);

// Every parameter of the spec: as given, else its default. What cannot be read is told.
ParameterValues parameter_values(const StageUse& use, const StageSpec& spec, config::Diagnostics& diagnostics);

// The value by which a choice parameter leaves the choice to the environment, which has it under the parameter's name.
inline constexpr const char* automatic = "auto";

// Puts what the environment has chosen in the place of `auto`, then takes out the ports and work whose conditions do not hold.
void keep_what_holds(PlannedStage& stage, const Environment& environment);

// Parameters still at `auto` that decide about ports or work of the spec: nothing here chooses for them.
std::vector<std::string> undecided(const PlannedStage& stage, const StageSpec& spec);

// Parameters that the environment would choose for, in the order of the pipeline, with what they are.
struct AutomaticChoice {
  std::string stage, parameter, value;  // stage: label
  bool chosen = true;                   // by the environment; else the pipeline says so
};
std::vector<AutomaticChoice> automatic_choices(const PipelineSpec& pipeline, const Registry& registry,
                                               const Environment& environment);

// The buffer that a port is to have, and where the pipeline says so (nowhere: its own name).
std::pair<std::string, std::optional<Place>> bound_name(const Port& port, const StageUse& use);

// Which buffers a pipeline writes and reads at all, wherever: optional ports are bound by that. Whoever only goes on from what an
// optional port finds is no reader; the end of a repeat is one.
struct Traffic {
  std::set<std::string> written, read;
};
Traffic survey(const PipelineSpec& pipeline, const Registry& registry, const Environment& environment);

}  // namespace firn::graph
