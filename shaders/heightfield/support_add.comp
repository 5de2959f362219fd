#define ADDING
#include "heightfield/support_addends.glsl"
