// Images of textures and environments.
#pragma once

#include <filesystem>

#include "scenes/texture.h"

namespace halfslope {

/// A PNG of 1 to 16 bits a channel (grey, RGB or palette; an alpha channel is left out), taken from sRGB to linear
/// unless `raw`; or an OpenEXR of channels R, G, B or Y, which is linear. At most 2^26 pixels. Throws Error(kBadInput)
/// with the path for another kind of image, named; a broken file; one whose header claims more than a file of its size
/// can hold, before it is allocated; a pixel that is negative or not finite.
Bitmap read_bitmap(const std::filesystem::path& path, bool raw);

}  // namespace halfslope
