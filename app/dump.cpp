#include "app/dump.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "config/diagnostics.h"
#include "config/nearest.h"
#include "scene/npy.h"

namespace firn::app {
namespace {

namespace fs = std::filesystem;

template <typename T>
void write_as(const std::string& file, const std::vector<std::uint64_t>& shape, std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  scene::write_npy(file, shape, std::span<const T>(values));
}

}  // namespace

std::vector<Dump> parse_dumps(const std::vector<std::string>& words, const graph::Plan& plan) {
  config::Diagnostics diagnostics;
  std::vector<Dump> dumps;
  std::vector<std::string> names;
  for (const graph::PlannedBuffer& buffer : plan.buffers)
    if (!graph::is_texel(buffer.type)) names.push_back(buffer.name);
  for (const std::string& word : words) {
    const config::Place place{"--dump " + word, 0, 0};
    const auto sign = word.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == word.size()) {
      diagnostics.error(place, "expected BUFFER=FILE.npy, such as position=positions.npy");
      continue;
    }
    const Dump dump{word.substr(0, sign), word.substr(sign + 1)};
    if (std::find(names.begin(), names.end(), dump.buffer) == names.end())
      diagnostics.error(place,
                        fmt::format("no buffer '{}' in this pipeline{}", dump.buffer, config::suggestion(dump.buffer, names)));
    // Told now, not after hours of simulation.
    if (const fs::path folder = fs::path(dump.file).parent_path(); !folder.empty() && !fs::is_directory(folder))
      diagnostics.error(place, fmt::format("there is no folder '{}'", folder.string()));
    dumps.push_back(dump);
  }
  config::throw_if_errors(diagnostics);
  return dumps;
}

void write_dump(const execution::Execution& execution, const Dump& dump) {
  const graph::Plan& plan = execution.plan();
  const graph::PlannedBuffer& buffer = plan.buffers[static_cast<std::size_t>(plan.buffer(dump.buffer))];
  std::vector<std::uint64_t> shape;
  if (const auto domain = plan.environment.domains.find(buffer.domain); domain != plan.environment.domains.end())
    shape = domain->second.shape;
  if (shape.empty()) shape = {buffer.count};
  if (buffer.type == graph::ElementType::mat3)
    shape.insert(shape.end(), {3, 3});
  else if (const int parts = graph::components(buffer.type); parts > 1)
    shape.push_back(static_cast<std::uint64_t>(parts));
  const std::vector<std::byte> values = graph::unpadded(buffer.type, execution.read(dump.buffer));
  switch (graph::scalar(buffer.type)) {
    case graph::Scalar::integer:
      write_as<std::int32_t>(dump.file, shape, values);
      break;
    case graph::Scalar::natural:
      write_as<std::uint32_t>(dump.file, shape, values);
      break;
    default:
      write_as<float>(dump.file, shape, values);
      break;
  }
}

}  // namespace firn::app
