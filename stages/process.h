#pragma once

// Other programs, run without a shell.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace firn::stages {

// The program of this name in the folders of PATH; empty: none.
std::filesystem::path find_program(const std::string& name);

// A running program that we feed. It is in a process group of its own, so that Ctrl-C reaches us alone and we end it in order.
class Process {
 public:
  // Its standard input comes from feed(), its outputs go to the ends of these files ("" and /dev/null alike: nowhere).
  // Throws std::runtime_error where it cannot be started.
  Process(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& output,
          const std::filesystem::path& errors);
  ~Process();  // as finish()
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // False where the program does not listen any more.
  bool feed(std::span<const std::byte> data);
  // Ends its input and waits for it. 0: well; above 0: its exit status; below 0: the signal that ended it.
  int finish();

 private:
  int input_ = -1;
  int process_ = -1;
  int status_ = 0;
};

}  // namespace firn::stages
