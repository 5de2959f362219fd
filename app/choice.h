#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace firn::app {

// An option's value is one of `choices`; the error names them, and the nearest.
CLI::Validator one_of(const std::vector<std::string>& choices);
CLI::Validator at_least(double least);
// The choices of an option that has such a validator; none where it has no.
std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace firn::app
