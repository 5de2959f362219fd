#include "app/try_sizes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "app/arrays.h"
#include "config/nearest.h"
#include "config/reader.h"
#include "stages/heightfield_ports.h"
#include "stages/mpm_ports.h"

namespace firn::app {
namespace {

using graph::DomainSize;

bool is_image(const std::string& domain) { return domain == "image" || domain == "shadow_map"; }

std::vector<std::string> base_axes(const std::string& base) {
  if (base == "cells" || base == "tiles" || is_image(base)) return {"rows", "columns"};
  if (base == "nodes") return {"nz", "ny", "nx"};
  return {base};
}

DomainSize size_of(const std::string& base, const scene::NpyShape& shape) {
  DomainSize size;
  size.count = 1;
  for (const std::uint64_t extent : shape) size.count *= extent;
  size.shape = shape;
  if (shape.size() == 2) {
    size.width = static_cast<int>(shape[1]);
    size.height = static_cast<int>(shape[0]);
  }
  if (is_image(base) || shape.size() == 1) size.shape.clear();
  return size;
}

struct Factor {
  char sign = 0;  // '*', '/'; 0: none
  std::uint64_t value = 1;
};
Factor factor_of(const graph::DomainText& domain) {
  const auto sign = domain.find_first_of("*/");
  if (sign == std::string::npos) return {};
  Factor factor{domain[sign], 1};
  std::from_chars(domain.data() + sign + 1, domain.data() + domain.size(), factor.value);
  return factor;
}

// Axes of an array for a port, without those of its components: {"rows", "columns"} of cells, {"bodies"}, {"3 facets"}.
std::vector<std::string> axes(const graph::DomainText& domain) {
  const std::string base = graph::base_domain(domain);
  if (base.empty()) return {domain};
  const Factor factor = factor_of(domain);
  if (factor.sign == '*') return {fmt::format("{} {}", factor.value, base)};
  if (factor.sign == '/') return {domain};
  return base_axes(base);
}

class Sizing {
 public:
  Sizing(const graph::PlannedStage& stage, const GivenArrays& arrays, graph::Environment& environment,
         std::vector<std::string>& notes, config::Diagnostics& diagnostics)
      : stage_(stage), arrays_(arrays), environment_(environment), notes_(notes), diagnostics_(diagnostics) {}

  void run(const std::vector<std::string>& words) {
    find_needed();
    for (const std::string& word : words) read_size(word);
    for (std::size_t p = 0; p < stage_.spec.ports.size(); ++p)
      if (const graph::Port& port = stage_.spec.ports[p]; arrays_.contains(port.name)) infer(port);
    derive();
    for (const auto& [base, ports] : needed_)
      if (!environment_.domains.contains(base) && !misfits_.contains(base)) fill_in(base, ports);
    if (diagnostics_.has_errors()) return;
    for (const graph::Port& port : stage_.spec.ports)
      if (const auto given = arrays_.find(port.name); given != arrays_.end()) check_count(port, given->second);
  }

 private:
  // Base domains that need a size, with the ports that would give it.
  void find_needed() {
    const auto need = [&](const graph::DomainText& domain) -> std::vector<std::string>* {
      const std::string base = graph::base_domain(domain);
      return base.empty() ? nullptr : &needed_[base];
    };
    for (std::size_t p = 0; p < stage_.spec.ports.size(); ++p) {
      const graph::Port& port = stage_.spec.ports[p];
      if (port.optional && stage_.buffers[p] < 0) continue;
      std::vector<std::string>* ports = need(port.domain);
      if (ports != nullptr && port.access == graph::Access::read) ports->push_back(port.name);
    }
    for (const graph::Work& work : stage_.spec.work) {
      if (const auto* dispatch = std::get_if<graph::Dispatch>(&work)) need(dispatch->over);
      if (const auto* draw = std::get_if<graph::Draw>(&work)) {
        need(draw->instances);
        need(draw->vertices);
      }
    }
  }

  void set(const std::string& base, const scene::NpyShape& shape, const std::string& by, const config::Place& place) {
    const auto [first, is_new] = set_by_.emplace(base, std::pair{by, shape});
    if (is_new)
      environment_.domains[base] = size_of(base, shape);
    else if (first->second.second != shape)
      diagnostics_.error(place, fmt::format("{} says that '{}' is {}, but {} says {}", by, base, scene::to_string(shape),
                                            first->second.first, scene::to_string(first->second.second)));
  }

  void read_size(const std::string& word) {
    config::Diagnostics of_word;
    config::Override given = config::parse_override(word, of_word);
    given.place.file = "--size " + word;
    if (of_word.has_errors()) {
      diagnostics_.error({"--size " + word, 0, 0}, "expected DOMAIN=N or DOMAIN=[rows, columns], such as bodies=3");
      return;
    }
    const std::string base = given.path.front();
    if (given.path.size() > 1 || !needed_.contains(base)) {
      std::vector<std::string> names;
      for (const auto& [name, ports] : needed_) names.push_back(name);
      diagnostics_.error(given.place,
                         fmt::format("{} works on no '{}'{}", stage_.spec.name, base, config::suggestion(base, names)));
      return;
    }
    std::vector<config::Node> extents{given.value};
    if (given.value.kind == config::Node::Kind::sequence) extents = given.value.items;
    scene::NpyShape shape;
    for (const config::Node& extent : extents)
      if (const auto value = config::read_integer(extent, base, {.min = 0, .max = 2147483647}, of_word))
        shape.push_back(static_cast<std::uint64_t>(*value));
    if (of_word.has_errors() || shape.size() != base_axes(base).size())
      diagnostics_.error(given.place, fmt::format("the size of '{}' is {}: {} from 0", base, fmt::join(base_axes(base), ", "),
                                                  shape.size() == 1 ? "whole numbers" : "as many whole numbers"));
    else
      set(base, shape, given.place.file, given.place);
  }

  // What the array of a port says of its domain.
  void infer(const graph::Port& port) {
    const GivenArray& given = arrays_.at(port.name);
    const std::string base = graph::base_domain(port.domain);
    const scene::NpyShape parts = component_shape(port.type), &shape = given.array.shape;
    const std::size_t rank = axes(port.domain).size();
    const bool fits = shape.size() == rank + parts.size() && std::equal(parts.rbegin(), parts.rend(), shape.rbegin());
    if (!fits) {
      diagnostics_.error(
          given.place, fmt::format("{} has shape {}; {} wants {}, {} of every element of '{}'", given.file, scene::to_string(shape),
                                   port.name, expected_shape(port), graph::name(port.type), port.domain));
      return;
    }
    const Factor factor = factor_of(port.domain);
    if (base.empty() || factor.sign == '/') return;
    scene::NpyShape own(shape.begin(), shape.begin() + static_cast<std::ptrdiff_t>(rank));
    if (factor.sign == '*') {
      if (own[0] % factor.value != 0 || base_axes(base).size() > 1) return;  // check_count() tells
      own[0] /= factor.value;
    }
    set(base, own, given.file, given.place);
  }

  void derive() {
    const auto cells = environment_.domains.find("cells");
    if (cells != environment_.domains.end() && !set_by_.contains("tiles")) {
      const auto tiles = [](int extent) {
        return static_cast<std::uint64_t>((extent + stages::heightfield::tile_edge - 1) / stages::heightfield::tile_edge);
      };
      environment_.domains["tiles"] = size_of("tiles", {tiles(cells->second.height), tiles(cells->second.width)});
    }
    const auto nodes = environment_.domains.find("nodes");
    if (nodes == environment_.domains.end() || nodes->second.shape.size() != 3) return;
    const scene::NpyShape& n = nodes->second.shape;
    environment_.domains["grid_rows"] = DomainSize{n[0] * n[1]};
    const auto particles = environment_.domains.find("particles");
    const stages::mpm::BlockRoom room =
        stages::mpm::block_room({static_cast<int>(n[2]), static_cast<int>(n[1]), static_cast<int>(n[0])},
                                particles == environment_.domains.end() ? 0 : particles->second.count);
    environment_.domains["grid_blocks"] = DomainSize{room.blocks};
    environment_.domains["block_table"] = DomainSize{room.table};
    const graph::Vector3 per_axis{static_cast<double>(n[2]), static_cast<double>(n[1]), static_cast<double>(n[0])};
    std::erase_if(environment_.constants, [](const graph::Constant& constant) { return constant.name == "grid_nodes"; });
    environment_.constants.push_back({"grid_nodes", graph::ElementType::ivec3, per_axis, "1", "nodes per axis"});
  }

  // A size that no array has told.
  void fill_in(const std::string& base, const std::vector<std::string>& ports) {
    if (base == "facets" || base == "swept_facets" || base == "key_frames") {
      environment_.domains[base] = DomainSize{0};
      notes_.push_back(fmt::format("no {}: none were given", base != "key_frames" ? "triangles of bodies" : "key frames of paths"));
    } else if (is_image(base)) {
      environment_.domains[base] = base == "image" ? size_of(base, {720, 1280}) : size_of(base, {2048, 2048});
      notes_.push_back(fmt::format("'{}' is {} x {}", base, environment_.domains[base].width, environment_.domains[base].height));
    } else if (base == "tiles" || base == "grid_rows" || base == "grid_blocks" || base == "block_table") {
      const char* from = base == "tiles" ? "cells" : "nodes";
      if (!needed_.contains(from)) no_size(base, ports, fmt::format(", --size {}={}", base, base == "tiles" ? "[4, 4]" : "16"));
    } else {
      const std::size_t rank = base_axes(base).size();
      no_size(base, ports, fmt::format(", --size {}={}", base, rank == 3 ? "[16, 16, 16]" : rank == 2 ? "[64, 64]" : "4"));
    }
  }

  void no_size(const std::string& base, const std::vector<std::string>& ports, const std::string& by_hand) {
    std::string ways;
    for (const std::string& port : ports) ways += fmt::format(", --in {}=FILE.npy", port);
    ways += by_hand + ", --scene SCENE";
    diagnostics_.error({"try " + stage_.spec.name, 0, 0},
                       fmt::format("nothing tells the size of '{}'; give one of {}", base, std::string_view(ways).substr(2)));
  }

  void check_count(const graph::Port& port, const GivenArray& given) {
    const auto count = graph::element_count(port.domain, environment_);
    const std::uint64_t values = count.value_or(0) * static_cast<std::uint64_t>(graph::components(port.type));
    if (values != given.array.values.size())
      diagnostics_.error(given.place,
                         fmt::format("{} has {} values; {} wants {}: {} {} elements of {}", given.file, given.array.values.size(),
                                     port.name, values, count.value_or(0), port.domain, graph::name(port.type)));
  }

  const graph::PlannedStage& stage_;
  const GivenArrays& arrays_;
  graph::Environment& environment_;
  std::vector<std::string>& notes_;
  config::Diagnostics& diagnostics_;
  std::map<std::string, std::vector<std::string>> needed_;
  std::map<std::string, std::pair<std::string, scene::NpyShape>> set_by_;
  std::set<std::string> misfits_;  // domains of arrays whose shape is told to be wrong
};

}  // namespace

std::string expected_shape(const graph::Port& port) {
  std::vector<std::string> names = axes(port.domain);
  for (const std::uint64_t part : component_shape(port.type)) names.push_back(std::to_string(part));
  return names.size() == 1 ? fmt::format("({},)", names[0]) : fmt::format("({})", fmt::join(names, ", "));
}

void size_domains(const graph::PlannedStage& stage, const GivenArrays& arrays, const std::vector<std::string>& sizes,
                  graph::Environment& environment, std::vector<std::string>& notes, config::Diagnostics& diagnostics) {
  Sizing(stage, arrays, environment, notes, diagnostics).run(sizes);
}

}  // namespace firn::app
