#pragma once

// What is asked of whole buffers once all stages are bound: checks, and how long each lives.

#include <map>
#include <string>
#include <vector>

#include "config/diagnostics.h"
#include "graph/plan.h"
#include "graph/registry.h"

namespace firn::graph {

enum class Phase { setup, step, frame };

// One piece of work, or the end of a repeat, on one buffer.
struct BufferUse {
  Place place;
  std::string label;
  Access access = Access::read;       // of this piece of work
  Access port_access = Access::read;  // of the stage as a whole: it may mean to read what it left there in the step before
  Usage usage = Usage::storage;
  Phase phase = Phase::setup;
  bool writes_all = false;  // every element, whenever the phase runs: nothing of what was there before is left
};
using BufferUses = std::map<int, std::vector<BufferUse>>;  // by buffer; uses in the order of execution

// Errors: a buffer that is read but never written; a picture drawn into that nobody began; an image used as a buffer. Warnings: a
// read before the first write; writes that nobody reads.
void check_buffers(const Plan& plan, const BufferUses& uses, const Registry& registry, config::Diagnostics& diagnostics);

// Whether a piece of work leaves nothing of a port's former content: it writes, and has one invocation for every element, or for
// every so many that belong together ("particles*3" over "particles").
// Dispatches over groups that are counted on the device, or over something else, are taken to write only a part.
bool writes_all(const Work& work, const Port& port, Access access);

// Lifetimes and storage of all buffers, and the plan's bytes.
void lay_out_memory(Plan& plan, const BufferUses& uses, bool share);

}  // namespace firn::graph
