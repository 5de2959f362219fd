// Tiles of cells of the height field.

const int tile_edge = 16;             // cells
const uint no_tile = 0xffffffffu;     // in lists
