#pragma once

#include "config/diagnostics.h"
#include "graph/plan.h"
#include "graph/registry.h"

namespace firn::graph {

// Pipeline + stages + environment -> plan. Needs no device. All errors go to `diagnostics` at once; the plan may be executed only
// if there are none. Warnings do not hinder.
Plan compile(const PipelineSpec& pipeline, const Registry& registry, const Environment& environment,
             config::Diagnostics& diagnostics);

}  // namespace firn::graph
