#pragma once

// Repeats whose end the device finds itself, so that nothing is read back and nobody waits.
//
// A kernel at the end of each turn compares what `until` watches with the limit. Once all of it is below, the kernel sets the group
// counts of the body's dispatches to zero: the turns that are left run without a single invocation. With the last turn it sets them
// back. The kernel is a stage of the plan like any other, with accesses and barriers.

#include <array>
#include <cstdint>

#include "graph/plan.h"

namespace firn::graph {

// Of a dispatch over so many elements; folded into two axes where one is too short (65,535 is all that OpenGL promises).
std::array<std::uint32_t, 3> group_counts(std::uint64_t elements, int group);

// Whole numbers are below a limit where they are at most this.
std::int64_t largest_below(double limit);

// What the deciding kernel keeps, and may be read at any time: elements of the buffer PlannedUntil::progress.
enum Progress { progress_turn, progress_reached, progress_turns, progress_rounds, progress_size };

// Lets the device decide wherever every command of the body is a dispatch, save in repeats that hold another one with an end of its
// own. Dispatches with group counts of their own (indirect) are stopped by zeroing those, so they must be made anew by every turn,
// and not matter outside; else, or where there are more than four such buffers, the host goes on reading back.
void decide_on_device(Plan& plan);

}  // namespace firn::graph
