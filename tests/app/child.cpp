#include "tests/app/child.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

extern char** environ;

namespace firn::test {
namespace {

namespace fs = std::filesystem;

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> list;
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  return list;
}

std::vector<std::string> variables_with(const Variables& added) {
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    bool replaced = false;
    for (const auto& [name, value] : added) replaced |= text.starts_with(name + "=");
    if (!replaced) all.push_back(text);
  }
  for (const auto& [name, value] : added) all.push_back(name + "=" + value);
  return all;
}

pid_t start(const Words& words, const Variables& variables, const std::string& out, const std::string& err) {
  std::vector<std::string> arguments{FIRN_PROGRAM}, surroundings = variables_with(variables);
  arguments.insert(arguments.end(), words.begin(), words.end());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const int problem =
      posix_spawn(&child, FIRN_PROGRAM, &actions, nullptr, pointers(arguments).data(), pointers(surroundings).data());
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) throw std::runtime_error("cannot start " FIRN_PROGRAM);
  return child;
}

// Sends `signal`, unless 0, once stderr holds `cue` and `wait` seconds are over.
Outcome run(const Words& words, const Variables& variables, const std::string& cue, int signal, double wait = 0) {
  const Folder folder;
  const std::string out = folder / "out", err = folder / "err";
  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = start(words, variables, out, err);
  int state = 0;
  struct rusage usage {};
  if (signal != 0) {
    constexpr auto patience = std::chrono::seconds(60);
    const auto passed = [&] { return std::chrono::steady_clock::now() - begin; };
    const std::chrono::duration<double> least(wait);
    while ((read_file(err).find(cue) == std::string::npos || passed() < least) && passed() < patience &&
           waitid(P_PID, static_cast<id_t>(child), nullptr, WEXITED | WNOHANG | WNOWAIT) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    kill(child, signal);
  }
  if (wait4(child, &state, 0, &usage) != child) throw std::runtime_error("cannot wait for " FIRN_PROGRAM);
  Outcome outcome;
  outcome.status = WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  outcome.out = read_file(out);
  outcome.err = read_file(err);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  outcome.peak_kilobytes = usage.ru_maxrss;
  return outcome;
}

}  // namespace

Folder::Folder() {
  std::string name = (fs::temp_directory_path() / "firn-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder " + name);
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  const std::string file = *this / name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

Outcome run_firn(const Words& words, const Variables& variables) { return run(words, variables, "", 0); }

Outcome run_firn_signalled(const Words& words, const std::string& cue, int signal) { return run(words, {}, cue, signal); }

Outcome run_firn_killed(const Words& words, double seconds) { return run(words, {}, "", SIGKILL, seconds); }

}  // namespace firn::test
