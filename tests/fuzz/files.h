#pragma once

// Any bytes at all as a file that scenes name or that runs leave, through our own readers. A refusal with a sentence that names the
// file is the answer that is hoped for; anything else that is thrown is a finding and leaves the function.

#include <string_view>

#include "tests/fuzz/sandbox.h"

namespace firn::fuzz {

void check_array(const Sandbox& sandbox, std::string_view bytes);  // .npy: as values, as points, as an image
void check_image(const Sandbox& sandbox, std::string_view bytes);  // .png, or .f32 where it does not begin as a .png does
// The first byte says which kind: 'o' .obj, 'p' .ply. Read, mended, weighed, and asked what is inside.
void check_mesh(const Sandbox& sandbox, std::string_view bytes);
void check_stl(const Sandbox& sandbox, std::string_view bytes);  // the same
// A checkpoint in which one file is replaced, by the first byte: 'm' the manifest, 'h' the list of hashes, 'a' an array, 'p' an
// array before it is compressed. The list fits, unless it is the one.
void check_checkpoint(const Sandbox& sandbox, std::string_view bytes);
void check_manifest(const Sandbox& sandbox, std::string_view bytes);  // of a run, for --from

}  // namespace firn::fuzz
