// Compiled once for each instruction set, like the kernels (tests/CMakeLists.txt).
#include "tests/core/packet_functions.h"

#include <iterator>

#include "core/packet.h"

namespace halfslope {
namespace {

// Calls are unqualified and the bodies templates over F, as in the kernels.
struct Abs {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return abs(x);
  }
};
struct Sqrt {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return sqrt(x);
  }
};
struct Min {
  template <class F>
  static F at(const F& x, const F& y, const F&) {
    return min(x, y);
  }
};
struct Max {
  template <class F>
  static F at(const F& x, const F& y, const F&) {
    return max(x, y);
  }
};
struct Fma {
  template <class F>
  static F at(const F& x, const F& y, const F& z) {
    return fma(x, y, z);
  }
};
struct Select {
  template <class F>
  static F at(const F& x, const F& y, const F& z) {
    return select(x < y, y, z);
  }
};
/// 1 in every lane of a packet where x < y in any.
struct AnyLane {
  template <class F>
  static F at(const F& x, const F& y, const F&) {
    return F(scalar_t<F>(any_lane(x < y) ? 1 : 0));
  }
};
struct FloorPositive {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return floor_positive(x);
  }
};
struct Exp {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return exp(x);
  }
};
struct Log {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return log(x);
  }
};
struct Log1p {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return log1p(x);
  }
};
struct Expm1 {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return expm1(x);
  }
};
struct Erf {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return erf(x);
  }
};
struct Sin2Pi {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return sin_cos_2pi(x).sin;
  }
};
struct Cos2Pi {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return sin_cos_2pi(x).cos;
  }
};
struct Sin {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return sin_cos(x).sin;
  }
};
struct Cos {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return sin_cos(x).cos;
  }
};
struct Arctan2 {
  template <class F>
  static F at(const F& x, const F& y, const F&) {
    return arctan2(y, x);
  }
};
struct Arccos {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return arccos(x);
  }
};
struct Arcsin {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return arcsin(x);
  }
};
struct PowerOfTwoBelow {
  template <class F>
  static F at(const F& x, const F&, const F&) {
    return power_of_two_below(x);
  }
};

template <class Function, class F>
void apply(const scalar_t<F>* x, const scalar_t<F>* y, const scalar_t<F>* z, std::size_t count, scalar_t<F>* out) {
  for (std::size_t i = 0; i < count; i += static_cast<std::size_t>(kWidth<F>))
    store(out + i, Function::at(load<F>(x + i), load<F>(y + i), load<F>(z + i)));
}

template <class T, class Function>
constexpr PacketFunction<T> entry(const char* name) {
  return {name, apply<Function, NativePacket<T>>, apply<Function, T>};
}

template <class T>
constexpr PacketFunction<T> kFunctions[] = {
    entry<T, Abs>("abs"),
    entry<T, Sqrt>("sqrt"),
    entry<T, Min>("min"),
    entry<T, Max>("max"),
    entry<T, Fma>("fma"),
    entry<T, Select>("select"),
    entry<T, AnyLane>("any_lane"),
    entry<T, FloorPositive>("floor_positive"),
    entry<T, Exp>("exp"),
    entry<T, Log>("log"),
    entry<T, Log1p>("log1p"),
    entry<T, Expm1>("expm1"),
    entry<T, Erf>("erf"),
    entry<T, Sin2Pi>("sin_2pi"),
    entry<T, Cos2Pi>("cos_2pi"),
    entry<T, Sin>("sin"),
    entry<T, Cos>("cos"),
    entry<T, Arctan2>("arctan2"),
    entry<T, Arccos>("arccos"),
    entry<T, Arcsin>("arcsin"),
    entry<T, PowerOfTwoBelow>("power_of_two_below"),
};

}  // namespace
}  // namespace halfslope

extern "C" __attribute__((visibility("default"))) const void* halfslope_packet_test_kernels() {
  using namespace halfslope;
  static constexpr PacketFunctions kTable = {kFunctions<float>, kFunctions<double>, std::size(kFunctions<float>),
                                             kWidth<NativePacket<float>>, kWidth<NativePacket<double>>};
  return &kTable;
}
