#include "graph/format_version.h"

#include <fmt/format.h>

namespace firn::graph {

void read_version(config::Reader& reader, std::string_view what) {
  if (reader.node().kind == config::Node::Kind::map && !reader.has("firn"))
    reader.diagnostics().error(reader.node().place,
                               fmt::format("missing key 'firn': {} begins with 'firn: 1', the version of its format", what));
  reader.integer("firn", 1, {.min = 1, .max = 1});
}

}  // namespace firn::graph
