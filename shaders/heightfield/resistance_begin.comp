#include "heightfield/resistance_sums.glsl"
#include "lib/sums_begin.glsl"
