#pragma once

// GLSL in the file of a stage is its author's: what is wrong with it is an error of the input, not of Firn.

#include <string>
#include <string_view>

#include "config/diagnostics.h"
#include "gpu/program.h"

namespace firn::execution {

// Whether a kernel is the file of a stage: such a one goes by its whole path, Firn's own by one below shaders/.
bool is_stage_file(const std::string& kernel);

// What a gpu::ShaderError says of `source`, the whole text of the stage at `file`, each message at its file and line. A name that
// is not declared is told with the nearest that is: a port, parameter, constant or helper, or a variable of the file itself.
config::Diagnostics stage_file_errors(std::string_view what, const gpu::ShaderSource& source, const std::string& file);

}  // namespace firn::execution
