#pragma once

// Material-point snow in double precision: one function per stage, each straight from its formula. README.md tells the conventions.

#include "tests/reference/collision.h"
#include "tests/reference/interpolation.h"
#include "tests/reference/material.h"
#include "tests/reference/particles.h"
#include "tests/reference/step.h"
#include "tests/reference/svd.h"
#include "tests/reference/transfers.h"
