#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "scenes/loader.h"

/// Files that a scene names are looked for in a folder that does not exist: what is read is the text alone.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    halfslope::parse_scene(std::string_view(reinterpret_cast<const char*>(data), size), "/nonexistent/scene.xml");
  } catch (const halfslope::Error& error) {
    if (error.code() != halfslope::ExitCode::kBadInput) __builtin_trap();
  }
  return 0;
}
