// The .xml files of this folder, compiled in by cmake/HalfslopeScenes.cmake.
#pragma once

#include <span>
#include <string_view>

namespace halfslope {

struct ShippedFile {
  std::string_view name;  ///< without ".xml"
  std::string_view text;
};

std::span<const ShippedFile> shipped_files();

}  // namespace halfslope
