#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "app/verbs.h"

namespace firn::app {

void add_test(CLI::App& program, Action& action) {
  const auto filter = std::make_shared<std::string>();
  CLI::App* verb = program.add_subcommand("test", "All tests, through ctest, whose summary ends the output");
  verb->add_option("-R,--only", *filter, "Only tests whose name matches this regular expression");
  verb->callback([&action, filter] {
    action = [filter]() -> int {
      const std::filesystem::path build = FIRN_BUILD_DIR;
      if (!std::filesystem::exists(build / "CTestTestfile.cmake"))
        throw std::runtime_error(
            fmt::format("no tests in {}: they are part of a build tree, not of an installation", build.string()));
      std::vector<std::string> words{"ctest",      "--test-dir", build.string(), "--output-on-failure", "--no-tests=error",
                                     "--parallel", "2"};
      if (!filter->empty()) words.insert(words.end(), {"--tests-regex", *filter});
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execvp("ctest", arguments.data());
      throw std::runtime_error(fmt::format("ctest cannot be started: {}", std::strerror(errno)));
    };
  });
}

}  // namespace firn::app
