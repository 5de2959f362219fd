#define NOTING
#include "heightfield/resistance_addends.glsl"
