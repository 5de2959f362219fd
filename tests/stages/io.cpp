// Pictures and films on the disk: what is written reads back, and what cannot be written is said.

#include <fmt/format.h>
#include <png.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "stages/process.h"
#include "tests/catch.h"
#include "tests/small_disk.h"
#include "tests/stages/render_shot.h"

using namespace firn::test;
namespace fs = std::filesystem;

namespace {

const std::string small_image = "64x36";

std::string frames_pipeline(const std::string& last) { return "[render.background, render.particles, " + last + "]"; }

// Rows from bottom to top, as the device has them.
Picture read_png(const fs::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) throw std::runtime_error(image.message);
  image.format = PNG_FORMAT_RGBA;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), std::vector<std::byte>(PNG_IMAGE_SIZE(image))};
  if (png_image_finish_read(&image, nullptr, picture.rgba.data(), -static_cast<int>(PNG_IMAGE_ROW_STRIDE(image)), nullptr) == 0)
    throw std::runtime_error(image.message);
  return picture;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

template <typename Work>
std::string complaint(Work work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

// PATH with another value while it lives.
class Path {
 public:
  explicit Path(const std::string& value) : before_(std::getenv("PATH")) { setenv("PATH", value.c_str(), 1); }
  ~Path() { setenv("PATH", before_.c_str(), 1); }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

 private:
  std::string before_;
};

// A program in `folder` that does what the shell lines say.
void write_program(const Folder& folder, const std::string& name, const std::string& lines) {
  fs::permissions(folder.write(name, "#!/bin/sh\n" + lines), fs::perms::owner_all);
}

bool without(const char* program) {
  if (!firn::stages::find_program(program).empty()) return false;
  WARN(program << " is not installed: not tested");
  return true;
}

std::string probe(const fs::path& film, const std::string& entries) {
  Folder folder;
  const fs::path said = folder.path() / "said";
  firn::stages::Process(firn::stages::find_program("ffprobe"),
                        {"-v", "error", "-count_frames", "-show_entries", "stream=" + entries, "-of", "csv=p=0", film.string()},
                        said, "")
      .finish();
  return text_of(said);
}

}  // namespace

TEST_CASE("every frame is a PNG file that reads back equal to the picture") {
  Folder folder;
  const std::string compression = GENERATE("0", "3", "9");
  Shot shot(SceneText{}, frames_pipeline("{io.frames: {compression: " + compression + "}}"), small_image, folder.path().string());
  for (const char* name : {"frame_0000.png", "frame_0001.png"}) {
    const Picture picture = shot.frame();
    shot.execution().flush();  // pictures are written in the background
    CHECK(read_png(folder.path() / "frames" / name) == picture);
    std::vector<float> position = shot.read("position");
    for (std::size_t i = 1; i < position.size(); i += 3) position[i] += 0.2f;
    shot.write("position", position);
  }
  CHECK(names_in(folder.path() / "frames") == std::vector<std::string>{"frame_0000.png", "frame_0001.png"});
}

TEST_CASE("pictures are the smaller the more they are compressed") {
  std::vector<std::uintmax_t> sizes;
  for (const char* compression : {"0", "1", "9"}) {
    Folder folder;
    Shot shot(SceneText{}, frames_pipeline(std::string("{io.frames: {compression: ") + compression + "}}"), "320x180",
              folder.path().string());
    shot.frame();
    shot.execution().finish();
    sizes.push_back(fs::file_size(folder.path() / "frames/frame_0000.png"));
  }
  CHECK(sizes[0] > sizes[1]);
  CHECK(sizes[1] > sizes[2]);
}

TEST_CASE("without an output folder nothing is written") {
  Folder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  Shot shot(SceneText{}, frames_pipeline("io.frames, io.video"), small_image);
  shot.frame();
  shot.execution().finish();
  fs::current_path(before);
  CHECK(names_in(folder.path()).empty());
}

TEST_CASE("a full disk is an error that names the file, and leaves no half file") {
  Folder folder;
  Shot shot(SceneText{}, frames_pipeline("{io.frames: {compression: 0}}"), small_image, folder.path().string());
  std::string said;
  {
    const SmallDisk disk(1000);
    said = complaint([&] {
      shot.frame();
      shot.execution().finish();
    });
  }
  INFO(said);
  CHECK(said.find((folder.path() / "frames" / "frame_0000.png").string()) != std::string::npos);
  CHECK(said.find("File too large") != std::string::npos);
  CHECK(names_in(folder.path() / "frames").empty());
}

TEST_CASE("a folder that cannot be made is an error that names it") {
  Folder folder;
  folder.write("frames", "a file where the folder should be");
  Shot shot(SceneText{}, frames_pipeline("io.frames"), small_image, folder.path().string());
  const std::string said = complaint([&] {
    shot.frame();
    shot.execution().finish();
  });
  INFO(said);
  CHECK(said.find((folder.path() / "frames").string()) != std::string::npos);
}

TEST_CASE("the film has the pictures' size, number and rate, whether sizes are even or odd") {
  if (without("ffmpeg") || without("ffprobe")) return;
  Folder folder;
  const auto [size, film_size] = GENERATE(std::pair{"64x36", "64,36"}, std::pair{"65x37", "66,38"});
  Shot shot(SceneText{}, frames_pipeline("io.video"), size, folder.path().string());
  for (int i = 0; i < 5; ++i) shot.frame();
  shot.execution().finish();
  CHECK(probe(folder.path() / "video.mp4", "width,height,r_frame_rate,nb_read_frames") == std::string(film_size) + ",25/1,5\n");
  CHECK(names_in(folder.path()) == std::vector<std::string>{"video.mp4"});
}

TEST_CASE("the film shows the pictures, right way up and in their colours") {
  if (without("ffmpeg")) return;
  Folder folder;
  SceneText scene;
  scene.bodies = "[{sphere: {radius: 0.6}, position: [0, 0.5, -0.5], color: [0.9, 0.2, 0.1]}]";
  scene.camera = "{from: [0, 0.5, 2], to: [0, 1.2, 0], fov: 60}";
  scene.snow = "[0.8, -0.8, 0.8]";
  Shot shot(scene, "[render.background, {io.video: {loss: 1}}]", "128x72", folder.path().string());
  const Picture picture = shot.frame();
  shot.execution().finish();
  const fs::path still = folder.path() / "still.rgba";
  firn::stages::Process(firn::stages::find_program("ffmpeg"),
                        {"-loglevel", "error", "-i", (folder.path() / "video.mp4").string(), "-vf", "vflip", "-pix_fmt", "rgba",
                         "-f", "rawvideo", still.string()},
                        "", "")
      .finish();
  const std::string film = text_of(still);
  REQUIRE(film.size() == picture.rgba.size());
  double difference = 0;
  for (std::size_t i = 0; i < film.size(); ++i)
    difference += std::abs(static_cast<unsigned char>(film[i]) - static_cast<int>(picture.rgba[i]));
  CHECK(difference / static_cast<double>(film.size()) < 3);
}

TEST_CASE("without ffmpeg a run goes on without a film") {
  Folder folder;
  const Path empty("");
  Shot shot(SceneText{}, frames_pipeline("io.frames, io.video"), small_image, folder.path().string());
  shot.frame();
  shot.frame();
  shot.execution().finish();
  CHECK(names_in(folder.path()) == std::vector<std::string>{"frames"});
}

TEST_CASE("an ffmpeg that fails ends the run with an error that names its log, not with a signal") {
  Folder folder, programs;
  const std::string lines = GENERATE("echo no encoder >&2; exit 7\n", "head -c 100 >/dev/null; echo no encoder >&2; exit 7\n");
  write_program(programs, "ffmpeg", lines);
  const Path path(programs.path().string() + ":" + std::getenv("PATH"));
  const std::string size = GENERATE("64x36", "1280x720");  // small enough to fit into the pipe, and not
  Shot shot(SceneText{}, frames_pipeline("io.video"), size, folder.path().string());
  const std::string said = complaint([&] {
    shot.frame();
    shot.execution().finish();
  });
  INFO(said);
  CHECK(said.find("status 7") != std::string::npos);
  CHECK(said.find((folder.path() / "ffmpeg.log").string()) != std::string::npos);
  CHECK(text_of(folder.path() / "ffmpeg.log") == "no encoder\n");
  CHECK_FALSE(fs::exists(folder.path() / "video.mp4"));
}

TEST_CASE("a run that ends in an error keeps the film up to there") {
  if (without("ffmpeg") || without("ffprobe")) return;
  Folder folder;
  {
    Shot shot(SceneText{}, frames_pipeline("io.video"), small_image, folder.path().string());
    shot.frame();
    shot.frame();
  }
  CHECK(probe(folder.path() / "video.mp4", "nb_read_frames") == "2\n");
}

TEST_CASE("a program gets its input, and its end is told") {
  Folder folder, programs;
  write_program(programs, "program", "cat; echo \"$1\" >&2; exit 3\n");
  firn::stages::Process process(programs.path() / "program", {"two words; $HOME"}, folder.path() / "out", folder.path() / "err");
  const std::string text(300000, 'x');
  CHECK(process.feed(std::as_bytes(std::span(text))));
  CHECK(process.finish() == 3);
  CHECK(process.finish() == 3);
  CHECK(text_of(folder.path() / "out") == text);
  CHECK(text_of(folder.path() / "err") == "two words; $HOME\n");
  CHECK(complaint([&] { firn::stages::Process(programs.path() / "none", {}, "", ""); }).find("none") != std::string::npos);
}
