// Which neighbours of a cell are nearer the way out: equal within a relative 1e-6 counts as equal.
bool strictly_lower(float a, float b) { return a < b * (1.0 - 1.0e-6); }

#if NEIGHBOURS_4
const int neighbor_count = 4;
#else
const int neighbor_count = 8;
#endif
