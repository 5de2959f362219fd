#define NOTING
#include "heightfield/support_addends.glsl"
