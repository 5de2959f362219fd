#include <string>

#include "tests/catch.h"
#include "tests/graph/loaded.h"

namespace firn::test {
namespace {

constexpr const char* base_text =
    "firn: 1\nname: base\nscene: scenes/one.yaml\ndoc: The base\nparameters: {k: 8, m: 1}\nsetup: [a.init]\n"
    "step:\n  - group: displace\n    stages: [a.push]\n  - a.move: {k: \"${k}\", m: \"${m}\"}\nframe: [a.draw]\n";

TEST_CASE("an included pipeline gives what the including one does not say") {
  const Folder folder;
  folder.write("lib/base.yaml", base_text);
  folder.write("p.yaml", "firn: 1\ninclude: lib/base.yaml\nname: mine\nframe: [a.other]\n");
  const auto [pipeline, lines] = loaded(folder, "p.yaml");
  CHECK(lines == Lines{});
  CHECK(pipeline.name == "mine");
  CHECK(pipeline.doc == "The base");
  CHECK(text_of(pipeline.setup) == "a.init");
  CHECK(text_of(pipeline.step) == "a.push a.move(k=8 m=1)");
  CHECK(text_of(pipeline.frame) == "a.other");
}

TEST_CASE("paths are relative to the file that names them") {
  const Folder folder;
  folder.write("lib/base.yaml", "firn: 1\nscene: scenes/one.yaml\nstep: [{stage: ./blur.comp}]\n");
  folder.write("lib/blur.comp", "/*\nfirn: 1\nname: base_blur\ndoc: a stage\nports: {}\nover: points\n*/\n");
  folder.write("lib/deep/middle.yaml", "firn: 1\ninclude: ../base.yaml\n");
  folder.write("p.yaml", "firn: 1\ninclude: lib/deep/middle.yaml\n");
  folder.write("q.yaml", "firn: 1\ninclude: lib/deep/middle.yaml\nscene: mine.yaml\n");
  CHECK(folder.shortened(loaded(folder, "p.yaml").pipeline.scene) == "lib/scenes/one.yaml");
  CHECK(text_of(loaded(folder, "p.yaml").pipeline.step) == "base_blur");
  CHECK(loaded(folder, "p.yaml").messages == Lines{});
  CHECK(folder.shortened(loaded(folder, "q.yaml").pipeline.scene) == "mine.yaml");
}

TEST_CASE("parameters are merged one by one, and the including file wins") {
  const Folder folder;
  folder.write("base.yaml", base_text);
  folder.write("p.yaml", "firn: 1\ninclude: base.yaml\nparameters: {m: 5, extra: 2}\n");
  const auto [pipeline, lines] = loaded(folder, "p.yaml");
  CHECK(flow(pipeline.parameters) == "{k: 8, m: 5, extra: 2}");
  CHECK(text_of(pipeline.step) == "a.push a.move(k=8 m=5)");
}

TEST_CASE("replace reaches the groups of an included file") {
  const Folder folder;
  folder.write("base.yaml", base_text);
  folder.write("p.yaml", "firn: 1\ninclude: base.yaml\nreplace: {displace: [b.one, {b.two: {k: \"${k}\"}}]}\n");
  const auto [pipeline, lines] = loaded(folder, "p.yaml");
  CHECK(lines == Lines{});
  CHECK(text_of(pipeline.step) == "b.one b.two(k=8) a.move(k=8 m=1)");
}

TEST_CASE("a file that includes itself is an error, directly or through others") {
  const Folder folder;
  folder.write("self.yaml", "firn: 1\ninclude: self.yaml\nstep: [a]\n");
  CHECK(loaded(folder, "self.yaml").messages ==
        Lines{"self.yaml:2:10: error: 'self.yaml' includes itself, directly or through others"});
  folder.write("one.yaml", "firn: 1\ninclude: sub/two.yaml\nstep: [a]\n");
  folder.write("sub/two.yaml", "firn: 1\ninclude: ../one.yaml\nstep: [b]\n");
  CHECK(loaded(folder, "one.yaml").messages ==
        Lines{"sub/two.yaml:2:10: error: '../one.yaml' includes itself, directly or through others"});
}

TEST_CASE("a file that includes itself under another name is found out") {
  const Folder folder;
  folder.write("real/self.yaml", "firn: 1\ninclude: self.yaml\nstep: [a]\n");
  std::filesystem::create_directory_symlink(folder.path() / "real", folder.path() / "link");
  CHECK(loaded(folder, "link/self.yaml").messages ==
        Lines{"link/self.yaml:2:10: error: 'self.yaml' includes itself, directly or through others"});
}

TEST_CASE("a missing include is an error at its name") {
  const Folder folder;
  folder.write("p.yaml", "firn: 1\ninclude: lib/bsae.yaml\nstep: [a]\n");
  CHECK(loaded(folder, "p.yaml").messages == Lines{"p.yaml:2:10: error: no such file: 'lib/bsae.yaml'"});
  folder.write("p.yaml", "firn: 1\ninclude: [a.yaml]\nstep: [a]\n");
  CHECK(loaded(folder, "p.yaml").messages == Lines{"p.yaml:2:10: error: include must be a text, not a list"});
}

TEST_CASE("errors inside an included file name that file") {
  const Folder folder;
  folder.write("lib/base.yaml", "firn: 1\nstep:\n  - a: {every: 0}\n  - 3: 4: 5\n");
  folder.write("p.yaml", "firn: 1\ninclude: lib/base.yaml\n");
  const Lines lines = loaded(folder, "p.yaml").messages;
  REQUIRE_FALSE(lines.empty());
  CHECK(lines.front().starts_with("lib/base.yaml:4:"));
  folder.write("lib/base.yaml", "firn: 1\nstep:\n  - a: {every: 0}\n");
  CHECK(loaded(folder, "p.yaml").messages == Lines{"lib/base.yaml:3:16: error: every must be between 1 and 1000000000, not 0"});
}

}  // namespace
}  // namespace firn::test
