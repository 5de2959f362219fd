#include "stages/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace firn::stages {
namespace {

namespace fs = std::filesystem;

// The two halves of what posix_spawn is told, freed together.
struct Instructions {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  Instructions() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
  }
  ~Instructions() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  Instructions(const Instructions&) = delete;
  Instructions& operator=(const Instructions&) = delete;

  void redirect(int descriptor, const fs::path& file) {
    const char* name = file.empty() ? "/dev/null" : file.c_str();
    posix_spawn_file_actions_addopen(&files, descriptor, name, O_WRONLY | O_CREAT | O_APPEND, 0666);
  }
};

}  // namespace

fs::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path candidate = fs::path(rest.substr(0, end)) / name;
    if (end > 0 && fs::is_regular_file(candidate) && access(candidate.c_str(), X_OK) == 0) return candidate;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

Process::Process(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& output,
                 const fs::path& errors) {
  // A pair of sockets rather than a pipe: what a broken one does to us can be said per write (MSG_NOSIGNAL), not only per program.
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::runtime_error(fmt::format("cannot start {}: {}", program.string(), std::strerror(errno)));
  Instructions instructions;
  posix_spawn_file_actions_adddup2(&instructions.files, ends[0], 0);
  instructions.redirect(1, output);
  instructions.redirect(2, errors);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&instructions.attributes, &none);
  posix_spawnattr_setsigdefault(&instructions.attributes, &all);
  posix_spawnattr_setpgroup(&instructions.attributes, 0);
  posix_spawnattr_setflags(&instructions.attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int error =
      posix_spawn(&process_, program.c_str(), &instructions.files, &instructions.attributes, pointers.data(), environ);
  close(ends[0]);
  input_ = ends[1];
  if (error == 0) return;
  close(input_);
  throw std::runtime_error(fmt::format("cannot start {}: {}", program.string(), std::strerror(error)));
}

Process::~Process() { finish(); }

bool Process::feed(std::span<const std::byte> data) {
  while (!data.empty()) {
    const ssize_t sent = send(input_, data.data(), data.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    data = data.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

int Process::finish() {
  if (input_ >= 0) close(input_);
  input_ = -1;
  if (process_ <= 0) return status_;
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  status_ = WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  return status_;
}

}  // namespace firn::stages
