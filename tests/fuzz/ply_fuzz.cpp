#include "tests/fuzz/mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return halfslope::fuzz_mesh(halfslope::parse_ply, data, size);
}
