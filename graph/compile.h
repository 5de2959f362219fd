#pragma once

#include "config/diagnostics.h"
#include "graph/plan.h"
#include "graph/registry.h"

namespace firn::graph {

struct PlanOptions {
  bool share_memory = false;      // between scratch buffers whose lives do not meet
  bool decide_on_device = false;  // the ends of repeats, where that is possible (repeats.h)
};

// Pipeline + stages + environment -> plan. Needs no device. All errors go to `diagnostics` at once; the plan may be executed only
// if there are none. Warnings do not hinder.
Plan compile(const PipelineSpec& pipeline, const Registry& registry, const Environment& environment,
             config::Diagnostics& diagnostics, const PlanOptions& options = {});

}  // namespace firn::graph
