// Tiles of the picture, each with a list of the bodies that can be seen in it.

const int tile_pixels = 16;
const int tile_list = 64;  // numbers per tile: how many bodies, then the bodies

int tiles_across() { return (image_width + tile_pixels - 1) / tile_pixels; }
// As many as tile_bodies has room for; very small pictures have more tiles.
int tiles_with_lists() {
  int rows = (image_height + tile_pixels - 1) / tile_pixels;
  return min(tiles_across() * rows, int(image_count) / 2 / tile_list);
}
