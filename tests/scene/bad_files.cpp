// Files that are not what they should be: an error with the file's name and a sentence, and no more memory than the file is long.

#include <sys/resource.h>

#include "scene/field.h"
#include "scene/mesh.h"
#include "scene/sampling.h"
#include "tests/scene/bad_file_table.h"
#include "tests/scene/support.h"

namespace firn::test {
namespace {

// Everything that is said of a scene, by reading it and whatever files it names.
std::string said_of(const std::string& text, const std::filesystem::path& file) {
  ReadResult read = read_text(text, file);
  if (read.diagnostics.has_errors()) return read.text();
  try {
    static_cast<void>(scene::estimate_particles(read.scene));
    static_cast<void>(scene::sample(read.scene));
    static_cast<void>(scene::body_meshes(read.scene));
    if (read.scene.field) static_cast<void>(scene::sample_field(read.scene));
  } catch (const config::InputError& error) {
    return error.what();
  }
  return "";
}

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

}  // namespace

TEST_CASE("every bad file is an error that names it and says what is wrong, without much memory") {
  static_cast<void>(said_of("firn: 1\n", "scene.yaml"));
  const long before = peak_kilobytes();
  for (const BadFile& bad : bad_files()) {
    INFO(bad.what);
    const TemporaryFolder folder;
    folder.write(bad.name, bad.bytes);
    const std::string said = said_of(scene_with(bad.use, bad.name), folder / "scene.yaml");
    INFO(said);
    CHECK(said.find("scene.yaml:") != std::string::npos);
    CHECK(said.find(": error: ") != std::string::npos);
    CHECK(said.find((folder / bad.name).string()) != std::string::npos);
    CHECK(said.find(bad.says) != std::string::npos);
  }
  CHECK(peak_kilobytes() - before < 64 * 1024);
}

TEST_CASE("links that lead in a circle, folders and names that are not there are errors at their place") {
  const TemporaryFolder folder;
  std::filesystem::create_symlink(folder / "b.obj", folder / "a.obj");
  std::filesystem::create_symlink(folder / "a.obj", folder / "b.obj");
  std::filesystem::create_directory(folder / "folder.obj");
  for (const char* name : {"a.obj", "folder.obj", "none.obj"})
    for (const Use use : {Use::snow, Use::body, Use::points, Use::depth}) {
      const std::string said = said_of(scene_with(use, name), folder / "scene.yaml");
      INFO(name << ": " << said);
      CHECK(said.find(": error: ") != std::string::npos);
      CHECK(said.find(name) != std::string::npos);
      const bool circle = said.find("; its symbolic links go in a circle") != std::string::npos;
      CHECK(circle == (std::string(name) == "a.obj"));
    }
}

TEST_CASE("a name that is no UTF-8 is an error of the scene file") {
  const std::string said = said_of(scene_with(Use::snow, "snow\xff\xfe.obj"), "scene.yaml");
  INFO(said);
  CHECK(said.find("UTF-8") != std::string::npos);
}

}  // namespace firn::test
