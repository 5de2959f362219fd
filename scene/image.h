#pragma once

// Grey images as sources of numbers: PNG files, two-dimensional .npy arrays, and .f32 files of nothing but floats (32 bits, little
// endian, row by row).
//
// PNG of 1 to 16 bits per channel: black is 0, white is 1, and the stored values are taken as they are, whatever gamma or profile
// the file names. Colour becomes grey by the weights of Rec. 709, 0.2126 R + 0.7152 G + 0.0722 B; grey is then multiplied by alpha,
// so that what is transparent counts as black. Arrays give their values unchanged.
// Row 0, the uppermost row of a picture, lies at the smallest z; column 0 at the smallest x.

#include <string>
#include <string_view>
#include <vector>

namespace firn::scene {

struct GreyImage {
  int width = 0, height = 0;
  std::vector<double> values;  // [row, column]
};

bool is_array(std::string_view file);  // plain values: does the name end in .npy or .f32?

// The kind of file is told by its name. An .f32 file does not say how wide it is: it has `width` x `height` values, or is square.
// Throws std::runtime_error with a sentence that names the file; values are finite.
GreyImage read_image(const std::string& file, int width = 0, int height = 0);
// `name` stands for the file in error texts.
GreyImage parse_png(std::string_view bytes, const std::string& name);

// Bilinear between the centres of the image's cells, constant beyond the outermost ones, so that an image of the same size comes
// through unchanged. A much larger image is sampled, not averaged.
GreyImage resample(const GreyImage& image, int width, int height);

}  // namespace firn::scene
