// docs/references.md has every tag and every work that stages, shaders and scenes name.

#include <algorithm>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/architecture/rules.h"
#include "tests/catch.h"

namespace firn::architecture {
namespace {

// [M 21, 22], [H 3.9-3.11], [M 3.4 step 7], [H tab. 3.1]: a thesis, a kind of number ("", "tab.", "alg.") and the numbers from one
// to another.
struct Tag {
  std::string kind;  // "M", "H tab."
  std::pair<int, int> first, last;
};

std::pair<int, int> number(const std::string& text) {
  const std::size_t point = text.find('.');
  return {std::stoi(text), point == std::string::npos ? 0 : std::stoi(text.substr(point + 1))};
}

std::vector<Tag> tags_in(const std::string& text) {
  static const std::regex brackets(R"(\[([MH] (tab\. |alg\. )?[0-9][^\]]*)\])");
  static const std::regex part(
      R"(^(?:([MH]) )?(?:(tab\.|alg\.) )?([0-9]+(?:\.[0-9]+)?)(?:-([0-9]+(?:\.[0-9]+)?))?(?: steps? [0-9]+)?$)");
  std::vector<Tag> tags;
  for (auto found = std::sregex_iterator(text.begin(), text.end(), brackets); found != std::sregex_iterator(); ++found) {
    std::string thesis;
    bool steps = false;
    std::istringstream parts((*found)[1]);
    for (std::string one; std::getline(parts >> std::ws, one, ',');) {
      if (steps && one.find_first_not_of("0123456789") == std::string::npos) continue;  // [M 3.4 steps 1, 3]
      std::smatch match;
      INFO((*found)[0]);
      REQUIRE(std::regex_match(one, match, part));
      if (match[1].matched) thesis = match[1];
      steps = one.find("steps") != std::string::npos;
      tags.push_back({thesis + (match[2].matched ? " " + match[2].str() : ""), number(match[3]),
                      number(match[4].matched ? match[4].str() : match[3].str())});
    }
  }
  return tags;
}

bool covers(const std::vector<Tag>& entries, const std::string& kind, std::pair<int, int> number) {
  return std::ranges::any_of(entries,
                             [&](const Tag& entry) { return entry.kind == kind && entry.first <= number && number <= entry.last; });
}

std::vector<SourceFile> tree() { return read_tree(FIRN_SOURCE_DIR); }

std::string references(const std::vector<SourceFile>& files) {
  const auto file = std::ranges::find(files, "docs/references.md", &SourceFile::path);
  REQUIRE(file != files.end());
  return file->text;
}

bool is_read(const SourceFile& file) {
  return file.path.starts_with("stages/") || file.path.starts_with("shaders/") || file.path.starts_with("scene/");
}

TEST_CASE("every tag of an equation has an entry among the references") {
  const std::vector<SourceFile> files = tree();
  std::vector<Tag> entries;
  std::istringstream lines(references(files));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("| ["))
      for (const Tag& tag : tags_in(line.substr(0, line.find(']') + 1))) entries.push_back(tag);
  CHECK(entries.size() > 15);
  int tags = 0;
  for (const SourceFile& file : files)
    if (is_read(file))
      for (const Tag& tag : tags_in(file.text)) {
        ++tags;
        CAPTURE(file.path, tag.kind, tag.first.first, tag.first.second, tag.last.second);
        CHECK((covers(entries, tag.kind, tag.first) && covers(entries, tag.kind, tag.last)));
      }
  CHECK(tags > 50);
}

TEST_CASE("every work and method that sources name is among the references") {
  const std::vector<SourceFile> files = tree();
  const std::string text = references(files);
  const std::regex work("\\b[A-Z][A-Za-z]+ (?:et al\\. )?(?:19|20)[0-9][0-9]\\b"),
      method("\\b(?:MLS-MPM|APIC|FLIP|PIC|CFL|Sobel|OpenVDB)\\b");
  std::set<std::string> named;
  for (const SourceFile& file : files)
    if (is_read(file))
      for (const std::regex& what : {work, method})
        for (auto found = std::sregex_iterator(file.text.begin(), file.text.end(), what); found != std::sregex_iterator(); ++found)
          named.insert((*found)[0]);
  CHECK(named.size() > 8);
  for (const std::string& name : named) {
    CAPTURE(name);
    const std::size_t space = name.find(' ');  // "Stomakhin 2013" is "Stomakhin et al. 2013"
    CHECK((text.find(name + "**") != std::string::npos ||
           (space != std::string::npos &&
            text.find(name.substr(0, space) + " et al." + name.substr(space) + "**") != std::string::npos)));
  }
}

}  // namespace
}  // namespace firn::architecture
