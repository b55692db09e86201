# halfslope_embed_scenes(target): compiles the text of every scenes/*.xml into the target, so that a scene's name works
# wherever the program is started from or copied to. scenes/shipped_files.h declares what the generated file defines.
# Meshes and images that scenes name are copied to the build folder's `scenes`, beside the programs.
function(halfslope_embed_scenes target)
  file(GLOB scenes CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/scenes/*.xml")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${scenes})
  set(files "")
  foreach(scene IN LISTS scenes)
    file(READ "${scene}" text)
    get_filename_component(name "${scene}" NAME_WE)
    string(APPEND files "    {\"${name}\", R\"halfslope(${text})halfslope\"},\n")
  endforeach()
  file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/generated/shipped_files.cpp" @ONLY CONTENT
[[// Generated from scenes/*.xml by cmake/HalfslopeScenes.cmake.
#include "scenes/shipped_files.h"

namespace halfslope {

std::span<const ShippedFile> shipped_files() {
  static constexpr ShippedFile kFiles[] = {
@files@  };
  return kFiles;
}

}  // namespace halfslope
]])
  file(GLOB files CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/scenes/*.ply" "${CMAKE_CURRENT_SOURCE_DIR}/scenes/*.obj"
    "${CMAKE_CURRENT_SOURCE_DIR}/scenes/*.exr")
  foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME)
    configure_file("${file}" "${CMAKE_BINARY_DIR}/scenes/${name}" COPYONLY)
  endforeach()
  target_sources(${target} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/generated/shipped_files.cpp")
endfunction()
