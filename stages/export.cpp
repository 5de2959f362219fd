#include "stages/export.h"

#include <cstring>

namespace firn::stages {
namespace {

template <typename T>
std::vector<T> typed(graph::ElementType type, std::span<const std::byte> bytes) {
  const std::vector<std::byte> packed = graph::unpadded(type, bytes);
  std::vector<T> values(packed.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), packed.data(), packed.size());
  return values;
}

}  // namespace

Copy::Copy(graph::HostContext& context, std::string_view port) {
  if (!context.bound(port)) return;
  type_ = context.view(port).type;
  bytes_ = context.read(port);
}
std::vector<float> Copy::floats() const { return typed<float>(type_, bytes_); }
std::vector<std::int32_t> Copy::integers() const { return typed<std::int32_t>(type_, bytes_); }

std::filesystem::path export_folder(const Problem& problem) { return std::filesystem::path(problem.output) / "export"; }

graph::ParameterSpec format_parameter(std::vector<std::string> formats, std::string doc) {
  const std::string first = formats.front();
  return {.name = "format",
          .kind = graph::ParameterKind::choice,
          .initial = first,
          .choices = std::move(formats),
          .doc = std::move(doc)};
}

graph::ParameterSpec compression_parameter() {
  return {.name = "compression",
          .kind = graph::ParameterKind::integer,
          .initial = std::int64_t{1},
          .min = 0,
          .max = 9,
          .unit = "1",
          .doc = "of .vtp and .vti files: 0: fast and large; 9: slow and a little smaller"};
}

std::string choice(const graph::ParameterValues& parameters, const char* name) {
  return std::get<std::string>(parameters.at(name));
}
int integer(const graph::ParameterValues& parameters, const char* name) {
  return static_cast<int>(std::get<std::int64_t>(parameters.at(name)));
}
double number(const graph::ParameterValues& parameters, const char* name) { return std::get<double>(parameters.at(name)); }

graph::Port for_host(graph::Port port, bool optional) {
  port.usage = graph::Usage::host;
  port.optional = port.optional || optional;
  return port;
}

}  // namespace firn::stages
