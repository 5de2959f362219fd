#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace firn::app {

// What is wrong with a command line that could not be read: every word that is unknown, with the nearest that is not.
std::string usage_error(const CLI::App& program, const CLI::ParseError& error);

}  // namespace firn::app
