#pragma once

// What the scene and the program tell the graph: sizes of domains, constants for kernels, choices. Plain data; the graph knows no
// snow.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "graph/types.h"

namespace firn::graph {

struct DomainSize {
  std::uint64_t count = 0;
  int width = 0, height = 0;              // of two-dimensional domains, which textures can have; 0 else
  std::vector<std::uint64_t> shape = {};  // of arrays in files, slowest index first: [nz, ny, nx]; empty: [count]
};

struct Constant {
  std::string name;
  ElementType type = ElementType::float1;  // float1, int1, uint1, vec3, ivec3
  Value value;                             // Vector3 for vec3 and ivec3
  std::string unit, doc;
};

struct Environment {
  std::map<std::string, DomainSize> domains;
  std::map<std::string, std::string>
      missing;  // known domains and constants without a value here, and why ("the scene has no field")
  std::vector<Constant> constants;
  std::map<std::string, std::string> listed_by;  // domains whose elements a buffer lists: {"grid_blocks", "active_blocks"}
  std::set<std::string> provided;                // buffers that come from, or go, elsewhere: they need neither writer nor reader
  std::map<std::string, std::string> choices;    // for conditions of specs: {"time_step", "auto"}

  [[nodiscard]] const Constant* constant(const std::string& name) const;
};

// The number of elements of a domain text; nothing where its domain is unknown or the product exceeds 2^53.
std::optional<std::uint64_t> element_count(const std::string& domain, const Environment& environment);

// The domain's name without scaling; empty for plain counts.
std::string base_domain(const std::string& domain);

}  // namespace firn::graph
