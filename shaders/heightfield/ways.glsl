// Ways of snow from cell to cell, down the distances: neighbours of strictly lower distance receive, those of strictly higher one give. In one
// word per cell: a bit for each neighbour that receives, 8 bits further up for each that gives, and in the upper half how many of the latter
// have still to do so.
#include "lib/cells.glsl"

const int givers_shift = 8, givers_left_shift = 16;

uint receivers_of(uint way) { return bitCount(way & 0xffu); }
