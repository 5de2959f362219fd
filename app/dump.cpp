#include "app/dump.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/nearest.h"

namespace firn::app {

void check_dumps(const std::vector<NamedFile>& dumps, const graph::Plan& plan, const std::filesystem::path& output,
                 config::Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const graph::PlannedBuffer& buffer : plan.buffers)
    if (!graph::is_texel(buffer.type)) names.push_back(buffer.name);
  for (const NamedFile& dump : dumps)
    if (std::ranges::find(names, dump.name) == names.end())
      diagnostics.error(dump.place,
                        fmt::format("no buffer '{}' in this pipeline{}", dump.name, config::suggestion(dump.name, names)));
  std::vector<NamedFile> elsewhere = dumps;
  std::erase_if(elsewhere, [&](const NamedFile& dump) { return std::filesystem::path(dump.file).parent_path() == output; });
  check_folders(elsewhere, diagnostics);
}

}  // namespace firn::app
