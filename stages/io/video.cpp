#include "stages/io/video.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "stages/png.h"
#include "stages/process.h"
#include "stages/view_ports.h"
#include "stages/writer.h"

namespace firn::stages::io {
namespace {

namespace fs = std::filesystem;

// Whether this ffmpeg has libx264: some distributions leave it out.
bool has_x264(const fs::path& ffmpeg, const fs::path& scratch) {
  Process(ffmpeg, {"-hide_banner", "-encoders"}, scratch, "").finish();
  std::ifstream stream(scratch);
  const std::string list((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  std::error_code error;
  fs::remove(scratch, error);
  return list.find("libx264 ") != std::string::npos;
}

// A film is one file as long as nothing asks for more. Where checkpoints are written, each ends a part in video.parts/, so that a
// run which goes on from one loses no picture; the parts are joined without being encoded again.
class Video final : public graph::HostStage {
 public:
  Video(std::shared_ptr<const Problem> problem, int loss) : problem_(std::move(problem)), loss_(loss), folder_(problem_->output) {}

  // A run that ended in an error leaves the film up to there.
  ~Video() override {
    if (!encoder_ && parts_.empty()) return;
    try {
      finish();
    } catch (const std::exception& error) {
      spdlog::warn("{}", error.what());
    }
  }
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  void run(graph::HostContext& context) override {
    if (folder_.empty() || without_ffmpeg_) return;
    const graph::PortView view = context.view("image");
    if (!encoder_) start(view.width, view.height);
    if (!encoder_) return;
    last_ = context.clock().frame;
    if (!first_) first_ = last_;
    std::vector<std::byte> texels = context.read("image");
    const std::size_t bytes = texels.size();
    told([&] {
      writer_.add(bytes, [this, texels = std::move(texels), width = view.width, height = view.height] {
        const Picture picture = picture_of(texels, width, height);
        if (!encoder_->feed(std::as_bytes(std::span(picture.rgb)))) throw EncoderGone{};
      });
    });
  }

  void flush() override {
    if (!encoder_) return;
    end_encoder();
    const fs::path name = parts_folder() / fmt::format("frames_{:08}_{:08}.mp4", *first_, last_);
    first_.reset();
    std::error_code error;
    fs::create_directories(parts_folder(), error);
    rename(part(), name);
    parts_.push_back(name);
  }

  void resume(const graph::Clock& clock) override {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(parts_folder(), error)) {
      unsigned long long first = 0;
      if (std::sscanf(entry.path().filename().c_str(), "frames_%llu_", &first) != 1) continue;
      if (first < clock.frame)
        parts_.push_back(entry.path());
      else
        fs::remove(entry.path(), error);
    }
    std::ranges::sort(parts_);
  }

  void finish() override {
    if (parts_.empty()) {
      if (!encoder_) return;
      end_encoder();
    } else {
      flush();
      join_parts();
    }
    rename(part(), file());
    std::error_code error;
    if (fs::is_empty(log(), error) && !error) fs::remove(log(), error);
  }

 private:
  [[nodiscard]] fs::path file() const { return folder_ / "video.mp4"; }
  [[nodiscard]] fs::path part() const { return folder_ / "video.part.mp4"; }
  [[nodiscard]] fs::path parts_folder() const { return folder_ / "video.parts"; }
  [[nodiscard]] fs::path log() const { return folder_ / "ffmpeg.log"; }

  void start(int width, int height) {
    const fs::path ffmpeg = find_program("ffmpeg");
    without_ffmpeg_ = ffmpeg.empty();
    if (without_ffmpeg_) {
      spdlog::warn("no video: the program ffmpeg is not in PATH; the pictures of io.frames can be put together later");
      return;
    }
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw std::runtime_error(fmt::format("cannot make the folder {}: {}", folder_.string(), error.message()));
    fs::remove(log(), error);

    // H.264 with halved chroma needs even sizes. Colours: HD players expect BT.709.
    std::vector<std::string> arguments{"-hide_banner",
                                       "-loglevel",
                                       "warning",
                                       "-nostats",
                                       "-xerror",  // else a film that a full disk has cut off counts as done
                                       "-y",
                                       "-f",
                                       "rawvideo",
                                       "-pix_fmt",
                                       "rgb24",
                                       "-video_size",
                                       fmt::format("{}x{}", width, height),
                                       "-framerate",
                                       fmt::format("{}", problem_->scene.time.fps),
                                       "-i",
                                       "pipe:0",
                                       "-vf",
                                       "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
                                       "-pix_fmt",
                                       "yuv420p",
                                       "-colorspace",
                                       "bt709",
                                       "-color_primaries",
                                       "bt709",
                                       "-color_trc",
                                       "bt709"};
    if (!x264_) x264_ = has_x264(ffmpeg, folder_ / "encoders.txt");
    if (*x264_)
      for (const std::string& word : {std::string("-c:v"), std::string("libx264"), std::string("-crf"), fmt::format("{}", loss_)})
        arguments.push_back(word);
    for (const std::string& word : {std::string("-movflags"), std::string("+faststart"), part().string()})
      arguments.push_back(word);
    encoder_.emplace(ffmpeg, arguments, "", log());
  }

  // Pictures are handed to the encoder in the background, where nothing else is done with it: what becomes of it is decided here.
  struct EncoderGone {};
  template <class Call>
  void told(Call call) {
    try {
      call();
    } catch (const EncoderGone&) {
      fail(encoder_->finish());
    }
  }

  void end_encoder() {
    told([&] { writer_.finish(); });
    if (const int status = encoder_->finish(); status != 0) fail(status);
    encoder_.reset();
  }

  void join_parts() {
    const fs::path ffmpeg = find_program("ffmpeg"), list = parts_folder() / "list.txt";
    std::ofstream names(list);
    for (const fs::path& each : parts_) names << "file " << each.filename().string() << '\n';
    names.close();
    std::error_code error;
    if (!names) {
      fs::remove(list, error);
      throw std::runtime_error(fmt::format("cannot write {}", list.string()));
    }
    encoder_.emplace(ffmpeg,
                     std::vector<std::string>{"-hide_banner", "-loglevel", "warning", "-nostats", "-xerror", "-y", "-f", "concat",
                                              "-i", list.string(), "-c", "copy", "-movflags", "+faststart", part().string()},
                     "", log());
    end_encoder();
    fs::remove(list, error);
  }

  static void rename(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) throw std::runtime_error(fmt::format("cannot write {}: {}", to.string(), error.message()));
  }

  [[noreturn]] void fail(int status) {
    encoder_.reset();
    std::error_code error;
    fs::remove(part(), error);
    throw std::runtime_error(fmt::format("cannot write {}: ffmpeg {} {}; what it said is in {}", file().string(),
                                         status < 0 ? "was ended by signal" : "ended with status", std::abs(status),
                                         log().string()));
  }

  std::shared_ptr<const Problem> problem_;
  int loss_;
  fs::path folder_;
  bool without_ffmpeg_ = false;
  std::optional<bool> x264_;  // whether ffmpeg has it, once that is known
  std::optional<Process> encoder_;
  std::optional<std::uint64_t> first_;  // frame of the part that is being written; none: it has no picture yet
  std::uint64_t last_ = 0;
  std::vector<fs::path> parts_;  // that are whole, in their order
  Writer writer_;                // last, so that it ends first
};

}  // namespace

graph::StageSpec video() {
  return {.name = "io.video",
          .doc = "All pictures as video.mp4 in the output folder, by the program ffmpeg; without it, a message",
          .equation = "",
          .ports = {view::image(graph::Access::read, graph::Usage::host)},
          .parameters = {{.name = "loss",
                          .kind = graph::ParameterKind::integer,
                          .initial = std::int64_t{18},
                          .min = 0,
                          .max = 51,
                          .unit = "1",
                          .doc = "the CRF of x264: 0 loses nothing, 18 nothing that one sees, 51 nearly everything"}},
          .work = {graph::HostWork{}}};
}

graph::HostFactory writing_video(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues& parameters) {
    return std::make_unique<Video>(problem, static_cast<int>(std::get<std::int64_t>(parameters.at("loss"))));
  };
}

}  // namespace firn::stages::io
