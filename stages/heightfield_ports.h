#pragma once

// The buffers of the height-field stages, each declared once: type, domain, unit and meaning. A stage takes what it needs.
// Arrays over `cells` are [z, x], row 0 at the smallest z, x fastest in memory. science: part H of the guide, numbers [H ...].

#include "graph/spec.h"

namespace firn::stages::heightfield {

using graph::Access;
using graph::ElementType;
using graph::Port;
using graph::Usage;

// One buffer by its name; std::logic_error for a name that is not in the table.
Port port(const char* name, Access access, Usage usage = Usage::storage);
// The same, which may stay unbound.
Port optional(const char* name, Access access);
// A rigid body's, which may stay unbound.
Port optional_body(const char* name, Access access);

// Ports of several names with the same access.
std::vector<Port> ports(std::initializer_list<const char*> names, Access access);

// --- all cells, or those of the tiles that heightfield.active_tiles found: the parameter `cells` ---
graph::ParameterSpec cells_parameter();
std::vector<Port> cell_choice_ports();
// A dispatch with one invocation per cell of that choice.
std::vector<graph::Work> over_cells(const std::string& kernel, std::vector<graph::PortUse> uses);
// With one for half a tile's edge of cells, one above another (lib/own_column.glsl); of all cells, one for each.
std::vector<graph::Work> over_columns(const std::string& kernel, std::vector<graph::PortUse> uses);

// --- how strongly a body pushes to a side [H 3.12-3.19] ---
std::vector<graph::ParameterSpec> direction_parameters(double k);

// Constants that every kernel over cells needs.
std::vector<std::string> field_constants(std::initializer_list<const char*> more = {});

// Several lists of work one after another.
std::vector<graph::Work> sequence(std::initializer_list<std::vector<graph::Work>> lists);

inline constexpr int tile_edge = 16;                   // cells; shaders/lib/cells.glsl has the same
inline constexpr int columns_of_tile = 2 * tile_edge;  // each half as long; shaders/lib/own_column.glsl has the same

}  // namespace firn::stages::heightfield
