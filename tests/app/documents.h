#pragma once

// Documents for users, followed to the letter.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/app/child.h"
#include "tests/catch.h"

namespace firn::test {

// What stands between fences, and what the text before says where it belongs.
struct Block {
  std::string language, file, text;
};

inline std::vector<Block> blocks_of(const std::string& markdown) {
  std::vector<Block> blocks;
  std::istringstream lines(markdown);
  std::string line, before;
  const std::regex named("`([a-z_/.]+)`[^`]*:$");
  while (std::getline(lines, line)) {
    if (!line.starts_with("```")) {
      if (!line.empty()) before = line;
      continue;
    }
    Block block{line.substr(3), "", ""};
    std::smatch found;
    if (std::regex_search(before, found, named)) block.file = found[1];
    while (std::getline(lines, line) && line != "```") block.text += line + "\n";
    blocks.push_back(block);
    before.clear();
  }
  return blocks;
}

// Runs what a reader would type in a folder that holds ./firn, which is on the path; lines that end in a backslash go on.
inline void run_commands(const std::string& text, const Folder& clone) {
  std::istringstream lines(text);
  for (std::string line, command; std::getline(lines, line);) {
    command += line + "\n";
    if (line.ends_with("\\")) continue;
    std::smatch found;
    const int expected = std::regex_search(command, found, std::regex("# ends with status ([0-9])")) ? std::stoi(found[1]) : 0;
    const std::string script = clone.write("command.sh", "cd '" + clone / "" + "'\nPATH=\"$PWD:$PATH\"\n" + command),
                      log = clone / "command.log";
    const int state = std::system(("bash '" + script + "' > '" + log + "' 2>&1 < /dev/null").c_str());
    INFO(command << read_file(log));
    REQUIRE(WIFEXITED(state));
    REQUIRE(WEXITSTATUS(state) == expected);
    command.clear();
  }
}

}  // namespace firn::test
