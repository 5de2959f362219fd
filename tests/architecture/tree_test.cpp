#include <string>

#include "tests/architecture/rules.h"
#include "tests/catch.h"

namespace firn::architecture {
namespace {

void check_none(const Violations& violations) {
  std::string all;
  for (const std::string& violation : violations) all += violation + "\n";
  INFO(all);
  CHECK(violations.empty());
}

bool has_file(const std::vector<SourceFile>& files, const std::string& path) {
  for (const SourceFile& file : files) {
    if (file.path == path) return !file.text.empty();
  }
  return false;
}

TEST_CASE("the whole tree is read, results of builds and runs are not") {
  const std::vector<SourceFile> files = read_tree(FIRN_SOURCE_DIR);
  CHECK(has_file(files, "tests/architecture/rules.cpp"));
  CHECK(has_file(files, "config/node.h"));
  CHECK(has_file(files, "CMakeLists.txt"));
  CHECK(has_file(files, ".ci/run"));
  CHECK(has_file(files, "firn"));
  for (const SourceFile& file : files) {
    INFO(file.path);
    CHECK_FALSE(file.path.starts_with("build"));
    CHECK_FALSE(file.path.starts_with(".git/"));
  }
}

TEST_CASE("every room includes only the rooms that it may know") { check_none(check_includes(read_tree(FIRN_SOURCE_DIR))); }

TEST_CASE("no file of source is too long to be read in one sitting") { check_none(check_lengths(read_tree(FIRN_SOURCE_DIR))); }

TEST_CASE("no file names a place of one machine") { check_none(check_machine_paths(read_tree(FIRN_SOURCE_DIR))); }

TEST_CASE("every test case has a name that ctest can run it by") { check_none(check_test_names(read_tree(FIRN_SOURCE_DIR))); }

}  // namespace
}  // namespace firn::architecture
