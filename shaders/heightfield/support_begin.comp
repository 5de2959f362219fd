#include "heightfield/support_sums.glsl"
#include "lib/sums_begin.glsl"
