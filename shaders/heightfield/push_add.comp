#define ADDING
#include "heightfield/push_addends.glsl"
