#define ADDING
#define EACH add
#include "heightfield/push_addends.glsl"
