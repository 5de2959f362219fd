#include "app/run_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "app/files.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string in_utc(std::chrono::system_clock::time_point time) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(time - whole).count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(whole)), rest);
}

// A process that was killed may have left half a line.
void cut_after_last_line(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream || text.empty() || text.back() == '\n') return;
  const std::size_t last = text.rfind('\n');
  fs::resize_file(file, last == std::string::npos ? 0 : last + 1);
}

}  // namespace

// Others that log are not to fail for this file: what it does not take is told by the next event, or at the end.
class RunLog::Sink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit Sink(const fs::path& file) : file_(file) {}

  void write(const ordered_json& line) {
    const std::lock_guard hold(mutex_);
    if (!error_.empty()) throw std::runtime_error(std::exchange(error_, ""));
    put(line);
  }
  void tell() const {
    if (!error_.empty()) spdlog::error("{}", error_);
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const auto level = spdlog::level::to_string_view(message.level);
    try {
      put({{"time", in_utc(message.time)},
           {"event", "message"},
           {"level", std::string(level.data(), level.size())},
           {"text", std::string(message.payload.data(), message.payload.size())}});
    } catch (const std::runtime_error& error) {
      error_ = error.what();
    }
  }
  void flush_() override {}

 private:
  void put(const ordered_json& line) { file_.add(line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n"); }

  LineFile file_;
  std::string error_;  // that nobody was told
};

RunLog::RunLog(const fs::path& run) {
  const fs::path file = run / "log.jsonl";
  cut_after_last_line(file);
  sink_ = std::make_shared<Sink>(file);
  spdlog::default_logger()->sinks().push_back(sink_);
}

RunLog::~RunLog() {
  std::erase(spdlog::default_logger()->sinks(), sink_);
  sink_->tell();
}

void RunLog::event(const std::string& name, const nlohmann::json& facts) {
  ordered_json line{{"time", in_utc(std::chrono::system_clock::now())}, {"event", name}};
  for (const auto& [key, value] : facts.items()) line[key] = value;
  sink_->write(line);
}

}  // namespace firn::app
