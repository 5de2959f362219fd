#pragma once

// Height-field snow in double precision: one function per stage, each straight from its formula. README.md tells the conventions.

#include "tests/reference/heightfield_compress.h"
#include "tests/reference/heightfield_contour.h"
#include "tests/reference/heightfield_direction.h"
#include "tests/reference/heightfield_distance.h"
#include "tests/reference/heightfield_field.h"
#include "tests/reference/heightfield_flatten.h"
