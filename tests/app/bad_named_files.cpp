// Files that a scene, a stage on arrays or a run names, and that are not what they should be: the program ends with status 2 and a
// sentence that has the file's name, and takes no more memory than the file is long.

#include <algorithm>
#include <filesystem>

#include "tests/app/inputs.h"
#include "tests/catch.h"
#include "tests/scene/bad_file_table.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

constexpr long some_memory = 40000;  // kB, beyond what the same words need where nothing is wrong

const char* const field_pipeline = "firn: 1\nname: field\nscene: scene.yaml\nsetup: [heightfield.init]\n";

// Looked at as `firn check` does; a field's pictures are read by the stage that lays it, so one step is run.
Words words_for(const Folder& folder, Use use) {
  if (use == Use::depth) return {"run", folder / "pipeline.yaml", "--steps", "1", "--out", folder / "out", "-q"};
  return {"check", folder / "pipeline.yaml"};
}

void write_pipeline(const Folder& folder, Use use) {
  folder.write("pipeline.yaml", use == Use::depth ? field_pipeline : small_pipeline);
}

long peak_without_mistakes(Use use) {
  const Folder folder;
  write_pipeline(folder, use);
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  folder.write("a.npy", npy("(2, 3)", std::string(24, '\0')));
  folder.write("a.f32", std::string(16, '\0'));
  const char* name = use == Use::points ? "a.npy" : use == Use::depth ? "a.f32" : "a.obj";
  folder.write("scene.yaml", scene_with(use, name));
  const Outcome outcome = run_firn(words_for(folder, use));
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  return outcome.peak_kilobytes;
}

// Whether the words are refused with a sentence that has this in it.
void check_refused(const Words& words, const std::string& name, const std::string& fragment, long peak) {
  const Outcome outcome = run_firn(words);
  INFO("expected: " << name << " ... " << fragment);
  INFO(outcome.err);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find(": error: ") != std::string::npos);
  CHECK(outcome.err.find(name) != std::string::npos);
  CHECK(outcome.err.find(fragment) != std::string::npos);
  CHECK(outcome.err.size() < 4000);
  CHECK(outcome.peak_kilobytes < peak + some_memory);
}

}  // namespace

TEST_CASE("whatever is wrong with a file that a scene names, the program says which and what, and takes no memory for it",
          "[app]") {
  const long most = std::max({peak_without_mistakes(Use::snow), peak_without_mistakes(Use::body),
                              peak_without_mistakes(Use::points), peak_without_mistakes(Use::depth)});
  for (const BadFile& bad : bad_files()) {
    CAPTURE(bad.what);
    const Folder folder;
    write_pipeline(folder, bad.use);
    folder.write("scene.yaml", scene_with(bad.use, bad.name));
    folder.write(bad.name, bad.bytes);
    check_refused(words_for(folder, bad.use), folder / bad.name, bad.says, most);
  }
}

TEST_CASE("links in a circle, folders, devices and nothing at all are no files, whatever names them", "[app]") {
  const Folder folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  fs::create_directory(folder / "folder");
  for (const std::string ending : {".obj", ".ply", ".stl", ".npy", ".png", ".f32"}) {
    const bool mesh = ending <= ".obj" ? ending == ".obj" : ending == ".ply" || ending == ".stl";
    const Use use = mesh ? Use::snow : ending == ".npy" ? Use::points : Use::depth;
    fs::create_symlink("loop_b" + ending, folder / ("loop" + ending));
    fs::create_symlink("loop" + ending, folder / ("loop_b" + ending));
    fs::create_directory(folder / ("folder" + ending));
    fs::create_symlink("/dev/zero", folder / ("device" + ending));
    write_pipeline(folder, use);
    for (const std::string& name : {"loop" + ending, "folder" + ending, "device" + ending, "none" + ending}) {
      CAPTURE(name);
      folder.write("scene.yaml", scene_with(use, name));
      check_refused(words_for(folder, use), name, "", 400000);
    }
  }
  check_refused({"check", folder / "a", "-q"}, folder / "a", "there is no such file; its symbolic links go in a circle", 100000);
  check_refused({"check", "mpm_snow", "--scene", folder / "a", "-q"}, folder / "a", "its symbolic links go in a circle", 100000);
  for (const std::string& name : {folder / "a", folder / "folder", folder / "none", std::string("/dev/null")}) {
    CAPTURE(name);
    check_refused({"run", "--from", name, "-q"}, name, "", 100000);
    check_refused({"run", "--resume", name, "-q"}, name, "", 100000);
    check_refused({"check", name}, name, "", 100000);
  }
}

TEST_CASE("a broken array given to a single stage is refused by name", "[app]") {
  for (const BadFile& bad : bad_files()) {
    if (bad.use != Use::points || std::string(bad.says) == "finite" || std::string(bad.says) == "no points") continue;
    CAPTURE(bad.what);
    const Folder folder;
    const std::string file = folder.write(bad.name, bad.bytes);
    check_refused({"try", "mpm.advect", "--in", "position=" + file, "--out", "position=" + (folder / "out.npy")}, file, "", 200000);
  }
}

TEST_CASE("a manifest that is none, or tells of something else, is not repeated", "[app]") {
  const std::string inputs =
      R"({"pipeline": "mpm_snow", "scene": "", "set": [], "disable": [], "replace": [], "image": "64x64", "share_memory": true, )"
      R"("repeats": "auto", "device": "auto", "barriers": "derived", "dump": [], "checkpoint_every": 0, "keep_checkpoints": 3, )"
      R"("started_in": "/"})";
  const auto manifest = [&](const std::string& from, const std::string& to) {
    std::string text = R"({"inputs": )" + inputs + R"(, "outputs": {"metrics.csv": "00"}, "pipeline": {"stages": []}})";
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
  };
  const std::string nested = std::string(300000, '[') + std::string(300000, ']');
  const struct {
    const char* what;
    std::string text, says;
  } table[] = {
      {"nothing", "", "no manifest"},
      {"half a manifest", manifest("", "").substr(0, 100), "no manifest"},
      {"a picture", "\x89PNG\r\n\x1a\n" + std::string(100, '\0'), "no manifest"},
      {"a list", "[]", "no manifest"},
      {"no UTF-8", manifest("mpm_snow", "mpm_\xff\xfe"), "no manifest"},
      {"values nested without end", manifest("{\"stages\": []}", nested), "no manifest"},
      {"inputs that are no object", manifest(inputs, "3"), "no manifest"},
      {"no outputs", manifest("{\"metrics.csv\": \"00\"}", "{}"), "no hashes"},
      {"a pipeline that is a number", manifest("\"mpm_snow\"", "3"), "does not tell"},
      {"a name that no file system takes", manifest("mpm_snow", std::string(300, 'a')), "no such file"},
      {"steps before the first", manifest("\"checkpoint_every\": 0", "\"checkpoint_every\": -1"), "a whole number from 0"},
      {"more steps than can be counted", manifest("\"checkpoint_every\": 0", "\"checkpoint_every\": 1e300"),
       "a whole number from 0"},
      {"half a checkpoint", manifest("\"keep_checkpoints\": 3", "\"keep_checkpoints\": 0.5"), "a whole number from 0"},
      {"a missing key", manifest("\"repeats\": \"auto\", ", ""), "does not tell"},
  };
  for (const auto& bad : table) {
    CAPTURE(bad.what);
    const Folder folder;
    const std::string file = folder.write("manifest.json", bad.text);
    const Words words{"run", "--from", file, "--out", folder / "out", "-q"};
    const bool names_pipeline = bad.says == "no such file";
    check_refused(words, names_pipeline ? std::string(100, 'a') : file, bad.says, 100000);
    CHECK_FALSE(fs::exists(folder / "out"));
  }
}
