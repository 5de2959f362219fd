#include "app/run_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <mutex>

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

class RunLog::Sink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit Sink(const fs::path& file) : stream_(file, std::ios::app) {
    if (!stream_) throw std::runtime_error(fmt::format("cannot write {}", shown(file)));
  }

  void write(const ordered_json& line) {
    const std::lock_guard hold(mutex_);
    put(line);
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const auto level = spdlog::level::to_string_view(message.level);
    put({{"time", in_utc(message.time)},
         {"event", "message"},
         {"level", std::string(level.data(), level.size())},
         {"text", std::string(message.payload.data(), message.payload.size())}});
  }
  void flush_() override { stream_.flush(); }

 private:
  void put(const ordered_json& line) {
    stream_ << line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) << '\n';
    stream_.flush();
  }
  std::ofstream stream_;
};

RunLog::RunLog(const fs::path& run) {
  const fs::path file = run / "log.jsonl";
  cut_after_last_line(file);
  sink_ = std::make_shared<Sink>(file);
  spdlog::default_logger()->sinks().push_back(sink_);
}

RunLog::~RunLog() { std::erase(spdlog::default_logger()->sinks(), sink_); }

void RunLog::event(const std::string& name, const nlohmann::json& facts) {
  ordered_json line{{"time", in_utc(std::chrono::system_clock::now())}, {"event", name}};
  for (const auto& [key, value] : facts.items()) line[key] = value;
  sink_->write(line);
}

}  // namespace firn::app
