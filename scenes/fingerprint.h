#pragma once

#include <string>

#include "scenes/scene.h"

namespace halfslope {

/// All of a scene that determines what is integrated over its pixels, but the image's size: numbers in full, what
/// meshes and images hold by their 64-bit hash.
std::string scene_fingerprint(const Scene& scene);

}  // namespace halfslope
