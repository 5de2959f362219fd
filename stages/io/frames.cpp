#include "stages/io/frames.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "stages/png.h"
#include "stages/view_ports.h"

namespace firn::stages::io {
namespace {

namespace fs = std::filesystem;

class Frames final : public graph::HostStage {
 public:
  Frames(std::shared_ptr<const Problem> problem, int compression) : problem_(std::move(problem)), compression_(compression) {}

  void run(graph::HostContext& context) override {
    if (problem_->output.empty()) return;
    const fs::path folder = fs::path(problem_->output) / "frames";
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw std::runtime_error(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
    const graph::PortView view = context.view("image");
    const Picture picture = picture_of(context.read("image"), view.width, view.height);
    write_png(folder / fmt::format("frame_{:04}.png", context.clock().frame), picture, compression_);
  }

 private:
  std::shared_ptr<const Problem> problem_;
  int compression_;
};

}  // namespace

graph::StageSpec frames() {
  return {.name = "io.frames",
          .doc = "Every picture as a PNG file: frames/frame_0000.png and so on in the output folder",
          .equation = "",
          .ports = {view::image(graph::Access::read, graph::Usage::host)},
          .parameters = {{.name = "compression",
                          .kind = graph::ParameterKind::integer,
                          .initial = std::int64_t{3},
                          .min = 0,
                          .max = 9,
                          .unit = "1",
                          .doc = "0: fast and large; 9: slow and a little smaller"}},
          .work = {graph::HostWork{}}};
}

graph::HostFactory writing_frames(std::shared_ptr<const Problem> problem) {
  return [problem = std::move(problem)](const graph::ParameterValues& parameters) {
    return std::make_unique<Frames>(problem, static_cast<int>(std::get<std::int64_t>(parameters.at("compression"))));
  };
}

}  // namespace firn::stages::io
