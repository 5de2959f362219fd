// The cell of this invocation, by the parameter `cells`: of all, or of the tiles that relaxation listed.
#define OWN_TILES flatten_tiles
#include "lib/own_cell.glsl"
