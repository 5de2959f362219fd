#include "stages/series.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>

namespace firn::stages {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

constexpr const char* entry_start = "    { \"name\" : \"";

}  // namespace

void write_beside(const fs::path& file, const std::function<void(const fs::path& part)>& write) {
  fs::path part = file;
  part += ".part";
  std::error_code error, ignored;
  try {
    write(part);
  } catch (...) {
    fs::remove(part, ignored);
    throw;
  }
  fs::rename(part, file, error);
  if (!error) return;
  fs::remove(part, ignored);
  fail_to_write(file, error.message());
}

void write_stream_beside(const fs::path& file, const std::function<void(std::FILE* stream)>& write) {
  write_beside(file, [&](const fs::path& part) {
    std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(part.c_str(), "wbe"));
    if (!stream) fail_to_write(file, std::strerror(errno));
    write(stream.get());
    // Disks may run full as late as here.
    if (std::fclose(stream.release()) != 0) fail_to_write(file, std::strerror(errno));
  });
}

void write_file(const fs::path& file, std::string_view bytes) {
  write_stream_beside(file, [&](std::FILE* stream) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), stream) != bytes.size()) fail_to_write(file, std::strerror(errno));
  });
}

void fail_to_write(const fs::path& file, const std::string& why) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), why));
}

Series::Series(fs::path folder, std::string stem, std::string extension)
    : folder_(std::move(folder)), stem_(std::move(stem)), extension_(std::move(extension)) {}

fs::path Series::file(std::uint64_t frame, const std::string& suffix) {
  if (!begun_) begin(frame);
  return folder_ / fmt::format("{}_{:04}{}.{}", stem_, frame, suffix, extension_);
}

void Series::begin(std::uint64_t frame) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw std::runtime_error(fmt::format("cannot make the folder {}: {}", folder_.string(), error.message()));
  read_times(frame);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(stem_ + "_") || !name.ends_with("." + extension_)) continue;
    std::uint64_t number = 0;
    if (std::sscanf(name.c_str() + stem_.size() + 1, "%lu", &number) == 1 && number >= frame) fs::remove(entry.path(), error);
  }
  begun_ = true;
}

void Series::read_times(std::uint64_t before) {
  std::ifstream stream(folder_ / fmt::format("{}.{}.series", stem_, extension_));
  const std::string start = entry_start + stem_ + "_";
  for (std::string line; std::getline(stream, line);) {
    std::uint64_t frame = 0;
    double time = 0;
    const std::size_t comma = line.find("\", \"time\" : ");
    if (!line.starts_with(start) || comma == std::string::npos) continue;
    if (std::sscanf(line.c_str() + start.size(), "%lu", &frame) == 1 &&
        std::sscanf(line.c_str() + comma, "\", \"time\" : %lf", &time) == 1 && frame < before)
      times_[frame] = time;
  }
}

void Series::add(std::uint64_t frame, double time) {
  if (extension_ != "vtp" && extension_ != "vti") return;
  times_[frame] = time;
  std::string series = "{\n  \"file-series-version\" : \"1.0\",\n  \"files\" : [\n";
  std::string collection = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const auto& [number, seconds] : times_) {
    const std::string name = file(number).filename().string();
    series +=
        fmt::format("{}{}\", \"time\" : {:.12g} }}{}\n", entry_start, name, seconds, number == times_.rbegin()->first ? "" : ",");
    collection += fmt::format("    <DataSet timestep=\"{:.12g}\" part=\"0\" file=\"{}\"/>\n", seconds, name);
  }
  write_file(folder_ / fmt::format("{}.{}.series", stem_, extension_), series + "  ]\n}\n");
  write_file(folder_ / fmt::format("{}.pvd", stem_), collection + "  </Collection>\n</VTKFile>\n");
}

}  // namespace firn::stages
