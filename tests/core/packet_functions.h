// core/packet.h as each instruction set compiles it, so that one test program can hold them all to one standard.
#pragma once

#include <cstddef>

namespace halfslope {

/// One function over arrays of three arguments (it may need fewer), in packets and one number at a time. `count` is a
/// multiple of 16, arrays are aligned to 64 bytes.
template <class T>
struct PacketFunction {
  using Apply = void (*)(const T* x, const T* y, const T* z, std::size_t count, T* out);
  const char* name;
  Apply packets, scalars;
};

struct PacketFunctions {
  const PacketFunction<float>* f32;
  const PacketFunction<double>* f64;
  std::size_t count;
  int width_f32, width_f64;
};

/// The name of the libraries' one entry: extern "C" const void*(), a PacketFunctions.
inline constexpr const char* kPacketFunctions = "halfslope_packet_test_kernels";

}  // namespace halfslope
