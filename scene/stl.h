#pragma once

// STL files: triangles, each with corners of its own, as binary or as text.

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace firn::scene {

using StlTriangle = std::array<Eigen::Vector3f, 3>;  // corners as the file has them

// Binary where the file is as long as its number of triangles says, else text where it begins with "solid"; normals are passed
// over. Throws std::runtime_error with a sentence that names the file, and the line or the triangle: cut off, of another form, with
// a coordinate that is no finite number.
std::vector<StlTriangle> read_stl(const std::string& file);
std::vector<StlTriangle> parse_stl(std::string_view bytes, const std::string& name);  // `name` stands for the file

}  // namespace firn::scene
