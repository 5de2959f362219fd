// Sums over the particles of one block, one number of each kind for every node that they reach: 7 x 7 x 7 of them, from three below the block's
// own lowest node to its highest. One kind after another: mass, momentum (x, y, z), force (x, y, z), in N times the cell's edge.
const int SUM_EDGE = 7;
const int SUM_NODES = SUM_EDGE * SUM_EDGE * SUM_EDGE;
const int SUM_KINDS = 7;

int sum_index(ivec3 node) { return node.x + SUM_EDGE * (node.y + SUM_EDGE * node.z); }
