#include "stages/io/frames.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "stages/png.h"
#include "stages/view_ports.h"

namespace firn::stages::io {
namespace {

namespace fs = std::filesystem;

class FrameFiles {
 public:
  struct Snapshot {
    int width = 0, height = 0;
    std::vector<std::byte> texels;
    [[nodiscard]] std::size_t bytes() const { return texels.size(); }
  };

  FrameFiles(const std::shared_ptr<const Problem>& problem, const graph::ParameterValues& parameters)
      : folder_(fs::path(problem->output) / "frames"), compression_(integer(parameters, "compression")) {}

  static Snapshot take(graph::HostContext& context) {
    const graph::PortView view = context.view("image");
    return {view.width, view.height, context.read("image")};
  }

  void write(const Snapshot& snapshot, std::uint64_t frame, double) const {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw std::runtime_error(fmt::format("cannot make the folder {}: {}", folder_.string(), error.message()));
    write_png(folder_ / fmt::format("frame_{:04}.png", frame), picture_of(snapshot.texels, snapshot.width, snapshot.height),
              compression_);
  }

 private:
  fs::path folder_;
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

graph::HostFactory writing_frames(const Exports& exports) { return exporting<FrameFiles>(exports); }

}  // namespace firn::stages::io
