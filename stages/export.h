#pragma once

// What the stages that export files share.

#include <memory>
#include <string>

#include "graph/host.h"
#include "graph/registry.h"
#include "stages/problem.h"
#include "stages/series.h"
#include "stages/writer.h"

namespace firn::stages {

// Where exports go: the folder export/ of the problem's output, by the one writer of a run.
struct Exports {
  std::shared_ptr<const Problem> problem;
  std::shared_ptr<Writer> writer;
};

// A port as read back by the host: raw until the background thread has time for it.
class Copy {
 public:
  Copy() = default;  // of a port that is not bound
  Copy(graph::HostContext& context, std::string_view port);
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_.size(); }
  [[nodiscard]] std::vector<float> floats() const;
  [[nodiscard]] std::vector<std::int32_t> integers() const;

 private:
  graph::ElementType type_ = graph::ElementType::float1;
  std::vector<std::byte> bytes_;
};

// A stage that takes copies of its ports, of which files are made in the background. `Snapshot` holds the copies.
//   static Snapshot take(graph::HostContext&);
//   void write(const Snapshot&);      called one after another, on the writer's thread
// and `bytes()` of a snapshot says how much it holds.
template <typename Files>
class Exporting final : public graph::HostStage {
 public:
  Exporting(const Exports& exports, const graph::ParameterValues& parameters) : writer_(exports.writer), problem_(exports.problem) {
    if (!problem_->output.empty()) files_ = std::make_shared<Files>(problem_, parameters);
  }
  void run(graph::HostContext& context) override {
    if (!files_) return;
    auto snapshot = std::make_shared<typename Files::Snapshot>(files_->take(context));
    const std::size_t bytes = snapshot->bytes();
    writer_->add(bytes, [files = files_, snapshot, frame = context.clock().frame, time = context.clock().time] {
      files->write(*snapshot, frame, time);
    });
  }
  void flush() override { writer_->finish(); }
  void finish() override { writer_->finish(); }

 private:
  std::shared_ptr<Writer> writer_;
  std::shared_ptr<const Problem> problem_;
  std::shared_ptr<Files> files_;
};

template <typename Files>
graph::HostFactory exporting(const Exports& exports) {
  return [exports](const graph::ParameterValues& parameters) { return std::make_unique<Exporting<Files>>(exports, parameters); };
}

std::filesystem::path export_folder(const Problem& problem);

// Parameters that several stages share.
graph::ParameterSpec format_parameter(std::vector<std::string> formats, std::string doc);
graph::ParameterSpec compression_parameter();
std::string choice(const graph::ParameterValues& parameters, const char* name);
int integer(const graph::ParameterValues& parameters, const char* name);
double number(const graph::ParameterValues& parameters, const char* name);

// `port` as the host reads it.
graph::Port for_host(graph::Port port, bool optional = false);

}  // namespace firn::stages
