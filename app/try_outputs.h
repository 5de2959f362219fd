#pragma once

#include "app/arrays.h"

namespace firn::app {

// What a stage has left in its outputs: smallest, largest and sum of all numbers, and how many are none; to stdout.
void print_outputs(const execution::Execution& execution, bool json);

}  // namespace firn::app
