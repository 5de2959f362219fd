#define NOTING
#include "heightfield/push_addends.glsl"
