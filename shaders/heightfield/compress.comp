// What bodies displace is partly pressed together in its cell and partly pushed away [H 3.9-3.11].
#include "lib/own_cell.glsl"

void main() {
  ivec2 cell;
  if (!own_cell(cell)) return;
  int i = cell_index(cell);
  float d = overlap[i], leaving = 0.0, height = 0.0;
  if (d > 0.0) {
    float s = depth[i], before = density[i], rest = max(s - d, 0.0);
    leaving = before * s;  // all of it where the body stands on the ground
    if (rest > 0.0) {
      // Where the limits are one, as with sand, all of it is pushed.
      float w = max_density > min_density ? clamp((before - min_density) / (max_density - min_density), 0.0, 1.0) : before >= min_density ? 1.0 : 0.0;
#if MODEL_CONSERVING
      float pressed = before * (s - d * w) / rest;
#else
      float pressed = before * s / (s - d * (1.0 - w));
#endif
      float held = min(pressed, max_density);
      density[i] = held;
      leaving = before * d * w + (pressed - held) * rest;
    }
    depth[i] = rest;
    height = before > 0.0 ? leaving / before : 0.0;
#if HAS_CHANGED_TILES
    changed_tiles[tile_of(cell)] = 1u;
#endif
  }
  displaced[i] = leaving;
#if HAS_DISPLACED_HEIGHT
  displaced_height[i] = height;
#endif
}
