#define NOTING
#define EACH note
#include "heightfield/push_addends.glsl"
