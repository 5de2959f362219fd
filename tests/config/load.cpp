#include <filesystem>
#include <fstream>
#include <string>

#include "config/node.h"
#include "tests/config/support.h"

using namespace firn::config;
using namespace firn::test;

namespace {

// A folder of its own that goes away with the test; the working directory is there meanwhile.
class Folder {
 public:
  Folder() : before_(std::filesystem::current_path()) {
    path_ = std::filesystem::temp_directory_path() / ("firn-config-" + std::to_string(std::random_device{}()));
    std::filesystem::create_directories(path_);
    std::filesystem::current_path(path_);
  }
  ~Folder() {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

 private:
  std::filesystem::path before_;
  std::filesystem::path path_;
};

void write(const std::string& name, const std::string& text) { std::ofstream(name, std::ios::binary) << text; }

std::vector<std::string> errors_of_file(const std::string& name) {
  Diagnostics diagnostics;
  load(name, diagnostics);
  return texts(diagnostics);
}

}  // namespace

TEST_CASE("a file is read, and its name in places stays as it was given") {
  const Folder folder;
  std::filesystem::create_directory("scenes");
  write("scenes/ball.yaml", "gravity: [0, -9.81, 0]\n");
  Diagnostics diagnostics;
  const Node root = load("scenes/ball.yaml", diagnostics);
  CHECK(diagnostics.all().empty());
  REQUIRE(root.find("gravity") != nullptr);
  CHECK(to_string(root.find("gravity")->place) == "scenes/ball.yaml:1:10");
}

TEST_CASE("a file that is not there is an error that names a near one") {
  const Folder folder;
  CHECK(errors_of_file("ball.yaml") == std::vector<std::string>{"ball.yaml: error: there is no such file"});
  CHECK(errors_of_file("no/ball.yaml") == std::vector<std::string>{"no/ball.yaml: error: there is no such file"});
  write("ball.yaml", "a: 1\n");
  CHECK(errors_of_file("bal.yaml") ==
        std::vector<std::string>{"bal.yaml: error: there is no such file; did you mean 'ball.yaml'?"});
  CHECK(errors_of_file("ball.yaml/x").size() == 1);
  CHECK(errors_of_file("").size() == 1);
}

TEST_CASE("a directory and an empty file are errors") {
  const Folder folder;
  std::filesystem::create_directory("scenes");
  CHECK(errors_of_file("scenes") == std::vector<std::string>{"scenes: error: this is a directory, not a file"});
  write("empty.yaml", "");
  CHECK(errors_of_file("empty.yaml") == std::vector<std::string>{"empty.yaml: error: the file is empty"});
  write("comments.yaml", "# nothing\n\n");
  CHECK(errors_of_file("comments.yaml") == std::vector<std::string>{"comments.yaml: error: the file is empty"});
}

TEST_CASE("a file over 64 MiB is an error, at once") {
  const Folder folder;
  write("large.yaml", "a: 1\n");
  std::filesystem::resize_file("large.yaml", (64U << 20U) + 1);
  CHECK(errors_of_file("large.yaml") == std::vector<std::string>{"large.yaml: error: the file is larger than 64 MiB"});
  std::filesystem::resize_file("large.yaml", 64U << 20U);
  const auto errors = errors_of_file("large.yaml");
  REQUIRE(errors.size() == 1);
  CHECK(contains(errors[0], "byte 0x00"));
}

TEST_CASE("a file that may not be read is an error with the reason") {
  const Folder folder;
  write("secret.yaml", "a: 1\n");
  std::filesystem::permissions("secret.yaml", std::filesystem::perms::none);
  if (std::ifstream("secret.yaml")) return;  // the superuser may read everything
  CHECK(errors_of_file("secret.yaml") ==
        std::vector<std::string>{"secret.yaml: error: the file cannot be opened: Permission denied"});
}
