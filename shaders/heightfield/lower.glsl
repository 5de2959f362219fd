// Which neighbours of a cell are nearer the way out: equal within a relative 1e-6 counts as equal.
#include "lib/cells.glsl"

bool strictly_lower(float a, float b) { return a < b * (1.0 - 1.0e-6); }

// The neighbours that snow may be handed to.
#if NEIGHBOURS_4
#define FOR_RECEIVERS(DO) DO(0) DO(1) DO(2) DO(3)
#else
#define FOR_RECEIVERS(DO) FOR_NEIGHBORS(DO)
#endif
