#pragma once

// The option --export: stages that write files, without a change of the pipeline.

#include "app/load.h"

namespace firn::app {

void add_export(CLI::App& verb, Inputs& inputs);

// "particles:vtp" as the stage io.particles with this format; "particles" with its usual one.
config::Node read_exports(const std::vector<std::string>& words, config::Diagnostics& diagnostics);

}  // namespace firn::app
