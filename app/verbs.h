#pragma once

// The words of the command `firn`, one file per verb.

#include <CLI/CLI.hpp>
#include <functional>

namespace firn::app {

// Exit status of the program, as documented for users.
enum Status : int {
  done = 0,
  failed = 1,         // while running
  bad_input = 2,      // usage, or an input file
  device_lacks = 3,   // the device cannot do it
  numbers_broke = 4,  // NaN, overflow, out of the domain
  interrupted = 130,
};

// What a verb does once the command line is read; returns a Status.
using Action = std::function<int()>;

// Each adds its verb to the program; when it is called, `action` is set.
void add_bench(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_compare(CLI::App& program, Action& action);
void add_completion(CLI::App& program, Action& action);
void add_doctor(CLI::App& program, Action& action);
void add_explain(CLI::App& program, Action& action);
void add_inspect(CLI::App& program, Action& action);
void add_list(CLI::App& program, Action& action);
void add_profile(CLI::App& program, Action& action);
void add_run(CLI::App& program, Action& action);
void add_schema(CLI::App& program, Action& action);
void add_test(CLI::App& program, Action& action);
void add_try(CLI::App& program, Action& action);

}  // namespace firn::app
