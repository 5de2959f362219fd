#define ADDING
#include "heightfield/resistance_addends.glsl"
