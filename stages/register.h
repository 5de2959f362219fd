#pragma once

#include <memory>

#include "graph/registry.h"
#include "stages/problem.h"

namespace firn::stages {

// Every stage there is, one line each (register.cpp). Host stages work on `problem`; for listing and checking it may be null.
graph::Registry all_stages(const std::shared_ptr<const Problem>& problem);

}  // namespace firn::stages
