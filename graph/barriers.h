#pragma once

// Memory barriers from declared accesses.
//
// Writes by shaders to storage and images are incoherent: what comes after sees them only past a glMemoryBarrier whose bits name
// how it looks at the data (OpenGL 4.3, 7.12.2). Later shader writes must also wait for earlier accesses of any kind (write after
// read, write after write). Writes by the API and by draws to framebuffers are ordered by OpenGL itself.

#include <string>
#include <vector>

#include "graph/plan.h"

namespace firn::graph {

// The bit that makes shader writes visible to an access of this usage (of a texture where `texture`).
Bits consumer_bit(Usage usage, bool texture);
// Whether an access writes through a shader, and so needs barriers after it.
bool is_shader_write(const BufferAccess& access);

// Puts barriers into the three phases, which come without any. Phases run as: setup, then steps and frames in any order.
// The step's barriers are those of a step that follows a step; what the first step or a frame needs besides stands at the end of
// the phase before it.
void place_barriers(Plan& plan);

}  // namespace firn::graph
