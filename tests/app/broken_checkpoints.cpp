// What is not as it was written is refused: with status 2, a sentence that names the file, and what else there is to go on from.

#include <fmt/format.h>
#include <zstd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "app/checkpoint.h"
#include "app/checkpoint_files.h"
#include "app/files.h"
#include "app/sha256.h"
#include "scene/npy.h"
#include "tests/app/inputs.h"
#include "tests/catch.h"

using namespace firn::test;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary | std::ios::trunc) << text; }

// A run of two checkpoints, steps 2 and 4; the newer one is to be spoilt.
class Run {
 public:
  Run() {
    const Outcome outcome = run_firn(run_without_pictures("mpm_snow", folder_.write("scene.yaml", small_scene), run(),
                                                          {"--steps", "4", "--checkpoint-every", "2"}));
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    for (const fs::directory_entry& entry : fs::directory_iterator(newer()))
      whole_[entry.path().filename().string()] = read_file(entry.path());
    REQUIRE(whole_.size() > 20);
  }

  [[nodiscard]] std::string run() const { return folder_ / "out"; }
  [[nodiscard]] fs::path newer() const { return fs::path(run()) / "checkpoints/step_00000004"; }
  [[nodiscard]] fs::path older() const { return fs::path(run()) / "checkpoints/step_00000002"; }
  [[nodiscard]] const std::map<std::string, std::string>& whole() const { return whole_; }

  // As it was written.
  void mend() const {
    fs::remove_all(newer());
    fs::create_directories(newer());
    for (const auto& [name, content] : whole_) write(newer() / name, content);
  }

  // The list of hashes as it would be if all files were meant.
  void hash_again() const {
    std::map<std::string, std::string> hashes;
    for (const fs::directory_entry& entry : fs::directory_iterator(newer()))
      if (const std::string name = entry.path().filename().string(); name != firn::app::hash_list && entry.is_regular_file())
        hashes[name] = firn::app::sha256_of(entry.path());
    write(newer() / firn::app::hash_list, firn::app::hash_lines(hashes));
  }

  void change_manifest(const std::function<void(json&)>& change) const {
    json manifest = json::parse(whole_.at("manifest.json"));
    change(manifest);
    write(newer() / "manifest.json", manifest.dump());
  }

  // `plain`: an .npy file
  void put(const std::string& buffer, const std::string& plain) const {
    std::string packed(ZSTD_compressBound(plain.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 1));
    write(newer() / (buffer + ".npy.zst"), packed);
  }
  [[nodiscard]] std::string plain(const std::string& buffer) const {
    const std::string& packed = whole_.at(buffer + ".npy.zst");
    std::string text(ZSTD_getFrameContentSize(packed.data(), packed.size()), '\0');
    REQUIRE(ZSTD_decompress(text.data(), text.size(), packed.data(), packed.size()) == text.size());
    return text;
  }

 private:
  Folder folder_;
  std::map<std::string, std::string> whole_;
};

Outcome refused(const Run& run, const std::string& fragment) {
  const Outcome outcome = run_firn({"run", "--resume", run.run(), "-q"});
  INFO(outcome.err);
  INFO("expected: " << fragment);
  CHECK(outcome.status == 2);
  CHECK(outcome.err.find(fragment) != std::string::npos);
  CHECK(outcome.err.find("error: ") != std::string::npos);
  return outcome;
}

}  // namespace

TEST_CASE("a checkpoint with a byte changed, a file cut short or missing is refused with the name of the file", "[app]") {
  const Run run;
  INFO("seed " << seed());
  std::mt19937_64 random(seed());
  const std::string offer = "; another checkpoint of this run is whole: --resume " + run.older().string();
  const auto refusal = [&]() -> std::string {
    try {
      firn::app::read_checkpoint(run.run());
    } catch (const firn::config::InputError& error) {
      return error.what();
    }
    return "read without a word";
  };
  CHECK(refusal() == "read without a word");
  for (const auto& [name, content] : run.whole()) {
    CAPTURE(name);
    const auto place = [&] { return std::uniform_int_distribution<std::size_t>(0, content.size() - 1)(random); };
    const fs::path file = run.newer() / name;
    const auto check_refused = [&] {
      // Where the list of hashes itself was changed, it may be another file that is not as listed.
      const std::string text = refusal();
      INFO(text);
      CHECK(text.starts_with((name == firn::app::hash_list ? run.newer() : file).string()));
      CHECK(text.ends_with(offer));
    };
    for (int flip = 0; flip < 12; ++flip) {
      std::string changed = content;
      const std::size_t at = place();
      changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
      CAPTURE(at);
      write(file, changed);
      check_refused();
    }
    write(file, content.substr(0, place()));
    check_refused();
    write(file, content + content.back());
    check_refused();
    fs::remove(file);
    check_refused();
    CHECK(refusal().find(file.string() + ": error: this file is missing") == 0);
    write(file, content);
  }
  write(run.newer() / "more.npy.zst", "what is this");
  refused(run, "more.npy.zst: error: does not belong to this checkpoint" + offer);
  fs::remove(run.newer() / "more.npy.zst");
  CHECK(run_firn({"run", "--resume", run.run(), "-q"}).status == 0);
}

TEST_CASE("where no other checkpoint is whole, that is said", "[app]") {
  const Run run;
  write(run.older() / "mass.npy.zst", "");
  write(run.newer() / "mass.npy.zst", "");
  refused(run, "no other checkpoint of this run is whole");
  CHECK(run_firn({"run", "--resume", run.older().string(), "-q"}).status == 2);
}

// With the right hashes, so that it is the contents that must be found wrong.
TEST_CASE("a checkpoint of broken contents is refused, whatever its hashes say, and takes no memory that it does not need",
          "[app]") {
  const Run run;
  const std::string header = firn::scene::npy_header(firn::scene::NpyKind::float32, {237});
  const auto spoilt = [&](const std::string& what, const std::string& fragment, const std::function<void()>& spoil) {
    CAPTURE(what);
    run.mend();
    spoil();
    run.hash_again();
    CHECK(refused(run, fragment).peak_kilobytes < 400000);
  };
  const auto entry = [](json& manifest, const std::string& buffer) -> json& {
    for (json& each : manifest["buffers"])
      if (each["name"] == buffer) return each;
    throw std::runtime_error("no buffer " + buffer);
  };
  REQUIRE(run.plain("mass").starts_with(header));

  spoilt("a huge count in an array's header", "mass.npy.zst: error: ", [&] {
    run.put("mass", firn::scene::npy_header(firn::scene::NpyKind::float32, {std::uint64_t{1} << 60}) +
                        run.plain("mass").substr(header.size()));
  });
  spoilt("16 GiB of zeros in a few bytes", "mass.npy.zst: error: ", [&] {
    // A frame whose header claims the size, with blocks of one repeated byte each (RFC 8878).
    std::string frame("\x28\xb5\x2f\xfd\xe0", 5);
    for (int byte = 0; byte < 8; ++byte) frame += static_cast<char>((std::uint64_t{1} << 34) >> (8 * byte) & 0xff);
    for (int block = 0; block < 1000; ++block) frame += std::string("\x02\x00\x10\x00", 4);
    write(run.newer() / "mass.npy.zst", frame);
  });
  spoilt("no array at all", "mass.npy.zst: error: ", [&] { run.put("mass", "NUMPY" + run.plain("mass").substr(5)); });
  spoilt("wrong magic of the compression", "mass.npy.zst: error: is not what Zstandard makes",
         [&] { write(run.newer() / "mass.npy.zst", "PK" + run.whole().at("mass.npy.zst").substr(2)); });
  spoilt("an array of another type", "is no NumPy array of shape (237,) and type float32", [&] {
    run.put("mass", firn::scene::npy_header(firn::scene::NpyKind::int32, {237}) + run.plain("mass").substr(header.size()));
  });
  spoilt("a value that is no number", "position.npy.zst: error: 1 of its values are NaN, where the manifest says 0", [&] {
    std::string plain = run.plain("position");
    plain.replace(plain.size() - 4, 4, std::string("\x00\x00\xc0\x7f", 4));
    run.put("position", plain);
  });
  spoilt("a huge count in the manifest", "\"count\" of the buffer 'position' is 4611686018427387904, but must be 237",
         [&] { run.change_manifest([&](json& m) { entry(m, "position")["count"] = std::uint64_t{1} << 62; }); });
  spoilt("more particles than there is room for", "the number of particles in \"sizes\" must be a whole number up to 237",
         [&] { run.change_manifest([](json& m) { m["sizes"]["particles"] = std::uint64_t{1} << 40; }); });
  spoilt("fewer particles than there were", "\"count\" of the buffer",
         [&] { run.change_manifest([](json& m) { m["sizes"]["particles"] = 200; }); });
  spoilt("a file outside the checkpoint", "\"file\" of the buffer 'position' is \"../../../../../dev/zero\"",
         [&] { run.change_manifest([&](json& m) { entry(m, "position")["file"] = "../../../../../dev/zero"; }); });
  spoilt("a buffer's name that is no UTF-8", "manifest.json: error: is no JSON object", [&] {
    std::string text = run.whole().at("manifest.json");
    text.replace(text.find("\"position\""), 10, "\"posi\xff\xfeon\"");
    write(run.newer() / "manifest.json", text);
  });
  spoilt("a time that is no number", "manifest.json: error: is no JSON object", [&] {
    std::string text = run.whole().at("manifest.json");
    text.replace(text.find("\"time\": 0.0"), 8, "\"time\": NaN, \"t\": ");
    write(run.newer() / "manifest.json", text);
  });
  spoilt("a step before the first", "\"step\" must be a number from 0",
         [&] { run.change_manifest([](json& m) { m["step"] = -4; }); });
  spoilt("a missing buffer", "has no buffer 'position', which this run needs",
         [&] { run.change_manifest([](json& m) { m["buffers"] = json::array(); }); });
  spoilt("a format of the future", "has format version 2; this program reads version 1",
         [&] { run.change_manifest([](json& m) { m["version"] = 2; }); });
  spoilt("a manifest of something else", "its \"format\" must be \"firn checkpoint\"",
         [&] { run.change_manifest([](json& m) { m.erase("format"); }); });
  spoilt("lists nested without end", "manifest.json: error: is no JSON object",
         [&] { write(run.newer() / "manifest.json", std::string(200000, '[')); });
  spoilt("inputs of another kind", "does not tell what the run was asked for", [&] {
    run.change_manifest([](json& m) { m["inputs"] = {{"pipeline", 3}}; });
  });

  run.mend();
  fs::remove(run.newer() / "mass.npy.zst");
  fs::create_symlink("mass.npy.zst", run.newer() / "mass.npy.zst");
  refused(run, "mass.npy.zst: error: cannot be read: Too many levels of symbolic links");
  run.mend();
  fs::remove(run.newer() / "mass.npy.zst");
  fs::create_directory(run.newer() / "mass.npy.zst");
  refused(run, "mass.npy.zst: error: this is no file");
  run.mend();
  write(run.newer() /
            "a\xff"
            "b",
        "");
  refused(run, "a\\xffb: error: does not belong to this checkpoint");
  fs::remove_all(run.newer());
  fs::create_symlink("step_00000004", run.newer());
  refused(run, "step_00000004/SHA256SUMS: error: cannot be read: Too many levels of symbolic links");
}
