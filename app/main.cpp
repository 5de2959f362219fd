#include <fmt/color.h>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "app/usage_errors.h"
#include "app/verbs.h"
#include "app/version.h"
#include "config/diagnostics.h"
#include "gpu/device.h"
#include "gpu/program.h"
#include "graph/execution/execution.h"

namespace {

using firn::app::Status;

int guarded(const firn::app::Action& action) {
  try {
    return action();
  } catch (const firn::config::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return Status::bad_input;
  } catch (const firn::gpu::DeviceError& error) {
    spdlog::error("{}", error.what());
    return Status::device_lacks;
  } catch (const firn::execution::NumbersError& error) {
    spdlog::error("{}", error.what());
    return Status::numbers_broke;
  } catch (const firn::gpu::ShaderError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return Status::failed;
  } catch (const std::bad_alloc&) {
    spdlog::error("this machine's memory does not suffice; a larger cell or fewer particles need less");
    return Status::failed;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return Status::failed;
  }
}

// What was printed may still be on its way when a verb is done: a full disk tells only now.
int printed(int status) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  const std::string reason = errno != 0 ? fmt::format(": {}", std::strerror(errno)) : "";
  fmt::print(stderr, "error: the output is not complete, stdout cannot be written{}\n", reason);
  return status == Status::done ? static_cast<int>(Status::failed) : status;
}

void set_up_log(bool verbose, bool quiet) {
  const bool plain = std::getenv("NO_COLOR") != nullptr || isatty(STDERR_FILENO) == 0;
  auto log = spdlog::stderr_color_mt("firn", plain ? spdlog::color_mode::never : spdlog::color_mode::always);
  log->set_pattern("%^%l%$: %v");
  log->set_level(quiet ? spdlog::level::err : verbose ? spdlog::level::debug : spdlog::level::info);
  spdlog::set_default_logger(log);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{
      "Firn simulates snow on the GPU. A pipeline (YAML) lists stages; Firn checks it, binds buffers, places memory barriers, runs "
      "and times it.",
      "firn"};
  program.set_version_flag("--version", firn::app::version_line());
  program.require_subcommand(1);
  program.fallthrough();
  bool verbose = false, quiet = false;
  program.add_flag("-v,--verbose", verbose, "Say more on stderr");
  program.add_flag("-q,--quiet", quiet, "Say only errors");
  program.footer(
      "firn VERB --help tells more. Exit status: 0 done, 1 failed while running, 2 bad usage or input, 3 the device cannot do it,\n"
      "4 the numbers broke, 130 interrupted.");

  firn::app::Action action;
  firn::app::add_run(program, action);
  firn::app::add_bench(program, action);
  firn::app::add_profile(program, action);
  firn::app::add_check(program, action);
  firn::app::add_explain(program, action);
  firn::app::add_compare(program, action);
  firn::app::add_inspect(program, action);
  firn::app::add_list(program, action);
  firn::app::add_try(program, action);
  firn::app::add_completion(program, action);
  firn::app::add_doctor(program, action);
  firn::app::add_schema(program, action);
  firn::app::add_test(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return printed(program.exit(success));
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "{}", firn::app::usage_error(program, error));
    return Status::bad_input;
  }
  set_up_log(verbose, quiet);
  return printed(guarded(action));
}
