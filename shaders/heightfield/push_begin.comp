#include "heightfield/push_sums.glsl"
#include "lib/sums_begin.glsl"
