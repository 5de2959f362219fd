#pragma once

// log.jsonl: what a run said and did, one JSON object per line.

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace firn::app {

// While it lives, everything that goes to the log on stderr goes here too, as {"time", "event": "message", "level", "text"}.
class RunLog {
 public:
  // Goes on after the last whole line of an earlier process. Throws std::runtime_error where the file cannot be written.
  explicit RunLog(const std::filesystem::path& run);
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  // {"time", "event", ...facts}. Throws std::runtime_error where this, or a message since the last event, cannot be written.
  void event(const std::string& name, const nlohmann::json& facts = nlohmann::json::object());

 private:
  class Sink;
  std::shared_ptr<Sink> sink_;
};

}  // namespace firn::app
