// core/packet.h in every instruction set that this processor runs, against long double.
#include "core/packet.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/kernel_library.h"
#include "core/point_block.h"
#include "tests/core/packet_functions.h"

namespace halfslope {
namespace {

constexpr std::size_t kCount = 1 << 15;

const PacketFunctions& functions(Isa isa) {
  const std::string path = std::string(HALFSLOPE_BINARY_DIR) + "/tests/packet-functions-" + to_string(isa) + ".so";
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw std::runtime_error(dlerror());
  return *static_cast<const PacketFunctions*>(reinterpret_cast<const void* (*)()>(dlsym(library, kPacketFunctions))());
}

template <class T>
const PacketFunction<T>& function(Isa isa, const std::string& name) {
  const PacketFunctions& table = functions(isa);
  const PacketFunction<T>* entries;
  if constexpr (std::is_same_v<T, float>) {
    entries = table.f32;
  } else {
    entries = table.f64;
  }
  for (std::size_t i = 0; i < table.count; ++i) {
    if (name == entries[i].name) return entries[i];
  }
  throw std::runtime_error("no " + name);
}

template <class T>
struct Arguments {
  AlignedBuffer<T> x{kCount}, y{kCount}, z{kCount};
};

template <class T>
AlignedBuffer<T> call(typename PacketFunction<T>::Apply apply, const Arguments<T>& in) {
  AlignedBuffer<T> out(kCount);
  apply(in.x.data(), in.y.data(), in.z.data(), kCount, out.data());
  return out;
}

/// |found − exact| in units of the last place of T at exact.
template <class T>
long double ulps(T found, long double exact) {
  if (static_cast<long double>(found) == exact) return 0;
  int exponent;
  std::frexp(exact, &exponent);
  exponent = std::max(exponent, std::numeric_limits<T>::min_exponent);
  return std::fabs(static_cast<long double>(found) - exact) /
         std::ldexp(1.0L, exponent - std::numeric_limits<T>::digits);
}

/// Arguments over [low, high]: half of them evenly spread, half with every magnitude from `least` up equally likely.
template <class T>
Arguments<T> spread(T low, T high, T least) {
  Arguments<T> in;
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t i = 0; i < kCount; ++i) {
    long double x = low + (static_cast<long double>(high) - low) * (static_cast<double>(i) + unit(random)) / kCount;
    if (i % 2) {
      const bool negative = low < 0 && (high <= 0 || random() % 2);
      const long double most = negative ? -static_cast<long double>(low) : static_cast<long double>(high);
      const long double smallest =
          negative ? std::max<long double>(least, -static_cast<long double>(high)) : std::max<long double>(least, low);
      x = (negative ? -1 : 1) * smallest * std::exp(std::log(most / smallest) * static_cast<long double>(unit(random)));
    }
    in.x[i] = std::min(std::max(static_cast<T>(x), low), high);
  }
  in.x[0] = low;
  in.x[1] = high;
  return in;
}

/// exact(x, y); an error that `absolute` covers does not count.
template <class T>
void expect_ulps(const std::string& name, long double (*exact)(long double, long double), const Arguments<T>& in,
                 double bound, double absolute = 0) {
  for (const Isa isa : supported_isas()) {
    const PacketFunction<T>& f = function<T>(isa, name);
    for (const auto apply : {f.packets, f.scalars}) {
      const AlignedBuffer<T> found = call<T>(apply, in);
      long double worst = 0;
      std::size_t where = 0;
      for (std::size_t i = 0; i < kCount; ++i) {
        const long double promised = exact(static_cast<long double>(in.x[i]), static_cast<long double>(in.y[i]));
        if (std::fabs(static_cast<long double>(found[i]) - promised) <= absolute) continue;
        const long double error = ulps(found[i], promised);
        if (!(error <= worst)) worst = error, where = i;
      }
      EXPECT_LE(worst, bound) << name << ' ' << to_string(isa) << (apply == f.packets ? " packets" : " scalars") << " f"
                              << 8 * sizeof(T) << " at " << in.x[where] << ": " << found[where];
    }
  }
}
template <class T>
void expect_ulps(const std::string& name, long double (*exact)(long double), const Arguments<T>& in, double bound,
                 double absolute = 0) {
  static long double (*function)(long double);
  function = exact;
  expect_ulps<T>(
      name, +[](long double x, long double) { return function(x); }, in, bound, absolute);
}

// The functions of a packet's lanes, one at a time: bit for bit.
template <class T, class Exact>
void expect_bits(const std::string& name, const Arguments<T>& in, const Exact& exact) {
  for (const Isa isa : supported_isas()) {
    const PacketFunction<T>& f = function<T>(isa, name);
    for (const auto apply : {f.packets, f.scalars}) {
      const AlignedBuffer<T> found = call<T>(apply, in);
      for (std::size_t i = 0; i < kCount; ++i) {
        const T promised = exact(isa, in.x[i], in.y[i], in.z[i]);
        ASSERT_EQ(std::memcmp(&found[i], &promised, sizeof(T)), 0)
            << name << ' ' << to_string(isa) << (apply == f.packets ? " packets" : " scalars") << " of " << in.x[i]
            << ", " << in.y[i] << ", " << in.z[i] << ": " << found[i] << ", promised " << promised;
      }
    }
  }
}

/// Numbers of all magnitudes and signs, with zeros, infinities and NaN among them.
template <class T>
Arguments<T> anything() {
  Arguments<T> in;
  std::mt19937_64 random(7);
  const T odd[] = {T(0),
                   -T(0),
                   std::numeric_limits<T>::infinity(),
                   -std::numeric_limits<T>::infinity(),
                   std::numeric_limits<T>::quiet_NaN(),
                   T(1),
                   std::numeric_limits<T>::min(),
                   std::numeric_limits<T>::max()};
  for (std::size_t i = 0; i < kCount; ++i) {
    for (AlignedBuffer<T>* array : {&in.x, &in.y, &in.z}) {
      const T mantissa = static_cast<T>(static_cast<double>(random()) * 0x1p-63 - 1);
      (*array)[i] = random() % 4 ? std::ldexp(mantissa, static_cast<int>(random() % 121) - 60) : odd[random() % 8];
    }
  }
  return in;
}

template <class T>
class PacketFunctionsOf : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(PacketFunctionsOf, Numbers);

TYPED_TEST(PacketFunctionsOf, ArithmeticIsExactToTheBit) {
  using T = TypeParam;
  Arguments<T> in = anything<T>();
  expect_bits<T>("abs", in, [](Isa, T x, T, T) { return std::fabs(x); });
  expect_bits<T>("select", in, [](Isa, T x, T y, T z) { return x < y ? y : z; });
  expect_bits<T>("min", in, [](Isa, T x, T y, T) { return x < y ? x : y; });
  expect_bits<T>("max", in, [](Isa, T x, T y, T) { return x > y ? x : y; });
  for (std::size_t i = 0; i < kCount; ++i) in.x[i] = std::fabs(in.x[i]);
  expect_bits<T>("sqrt", in, [](Isa, T x, T, T) { return std::sqrt(x); });
}

TYPED_TEST(PacketFunctionsOf, FmaRoundsOnceExceptInTheBaseline) {
  using T = TypeParam;
  Arguments<T> in = anything<T>();
  for (std::size_t i = 0; i < kCount; ++i) {
    for (AlignedBuffer<T>* array : {&in.x, &in.y, &in.z}) {
      if (!std::isfinite((*array)[i])) (*array)[i] = T(0.75);
    }
    // Half of them cancel, where one rounding and two differ most.
    if (i % 2) in.z[i] = -(in.x[i] * in.y[i]);
  }
  expect_bits<T>("fma", in, [](Isa isa, T x, T y, T z) {
    volatile T product = x * y;
    return isa == Isa::kBaseline ? product + z : std::fma(x, y, z);
  });
}

TYPED_TEST(PacketFunctionsOf, FloorPositiveIsTheIntegerBelow) {
  using T = TypeParam;
  Arguments<T> in = spread<T>(0, std::is_same_v<T, float> ? T(2147483520.0) : T(2147483647.5), T(0.01));
  for (std::size_t i = 2; i < kCount; i += 3) in.x[i] = std::floor(in.x[i]);
  expect_bits<T>("floor_positive", in, [](Isa, T x, T, T) { return std::floor(x); });
}

TYPED_TEST(PacketFunctionsOf, AnyLaneLooksAtAWholePacketAndNoFurther) {
  using T = TypeParam;
  Arguments<T> in;
  for (std::size_t i = 0; i < kCount; ++i) in.y[i] = i % 37 == 0 ? T(1) : T(0);
  for (const Isa isa : supported_isas()) {
    const PacketFunctions& table = functions(isa);
    const auto width = static_cast<std::size_t>(sizeof(T) == 4 ? table.width_f32 : table.width_f64);
    EXPECT_EQ(width, isa == Isa::kScalar ? 1
                                         : (isa == Isa::kBaseline ? 16u
                                            : isa == Isa::kAvx2   ? 32u
                                                                  : 64u) /
                                               sizeof(T));
    const AlignedBuffer<T> found = call<T>(function<T>(isa, "any_lane").packets, in);
    for (std::size_t i = 0; i < kCount; i += width) {
      bool any = false;
      for (std::size_t lane = i; lane < i + width; ++lane) any = any || lane % 37 == 0;
      for (std::size_t lane = i; lane < i + width; ++lane) ASSERT_EQ(found[lane], any ? T(1) : T(0)) << lane;
    }
  }
}

TYPED_TEST(PacketFunctionsOf, TranscendentalFunctionsAreWithinAFewUlps) {
  using T = TypeParam;
  constexpr bool kSingle = std::is_same_v<T, float>;
  const T normal = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max();
  expect_ulps<T>("exp", std::exp, spread<T>(kSingle ? T(-87) : T(-708), kSingle ? T(88) : T(709), T(1e-30)), 1.5);
  expect_ulps<T>("log", std::log, spread<T>(normal, most, normal), 1);
  expect_ulps<T>("log", std::log, spread<T>(T(0.5), T(2), T(0.5)), 1);
  expect_ulps<T>("log1p", std::log1p, spread<T>(-1 + std::numeric_limits<T>::epsilon() / 2, T(1e30), T(1e-30)), 1);
  expect_ulps<T>("log1p", std::log1p, spread<T>(T(-0.999), T(2), T(1e-6)), 1);
  expect_ulps<T>("expm1", std::expm1, spread<T>(kSingle ? T(-87) : T(-708), kSingle ? T(88) : T(709), T(1e-30)), 2.5);
  expect_ulps<T>("expm1", std::expm1, spread<T>(T(-2), T(2), T(1e-6)), 2.5);
  expect_ulps<T>("erf", std::erf, spread<T>(T(-10), T(10), T(1e-30)), kSingle ? 2.5 : 80);
  expect_ulps<T>("erf", std::erf, spread<T>(T(-2), T(2), T(1e-6)), kSingle ? 2.5 : 80);
}

TYPED_TEST(PacketFunctionsOf, ExtremesGoWhereTheyMust) {
  using T = TypeParam;
  const T inf = std::numeric_limits<T>::infinity();
  const struct {
    const char* name;
    T x, value;
  } cases[] = {{"exp", 0, 1},        {"exp", -inf, 0}, {"exp", T(-1e4), 0}, {"exp", T(-1e30), 0},  {"exp", inf, inf},
               {"exp", T(1e4), inf}, {"log", 1, 0},    {"log", 0, -inf},    {"log", inf, inf},     {"log1p", 0, 0},
               {"log1p", -1, -inf},  {"expm1", 0, 0},  {"expm1", -inf, -1}, {"expm1", T(-1e4), -1}};
  Arguments<T> in;
  for (const auto& c : cases) {
    std::fill_n(in.x.data(), kCount, c.x);
    expect_bits<T>(c.name, in, [&](Isa, T, T, T) { return c.value; });
  }
  std::fill_n(in.x.data(), kCount, std::numeric_limits<T>::quiet_NaN());
  for (const char* name : {"exp", "log", "log1p", "expm1"}) {
    for (const Isa isa : supported_isas()) {
      EXPECT_TRUE(std::isnan(call<T>(function<T>(isa, name).packets, in)[3])) << name << ' ' << to_string(isa);
    }
  }
}

TYPED_TEST(PacketFunctionsOf, SinAndCosOfTurns) {
  using T = TypeParam;
  // Reduced exactly, so that the errors at zeros of either are relative too.
  const auto sine = +[](long double u) {
    const long double quarter = std::floor(4 * u + 0.5L), x = (u - quarter / 4) * 2 * std::acos(-1.0L);
    const int q = static_cast<int>(quarter) % 4;
    return q == 0 ? std::sin(x) : q == 1 ? std::cos(x) : q == 2 ? -std::sin(x) : -std::cos(x);
  };
  const auto cosine = +[](long double u) {
    const long double quarter = std::floor(4 * u + 0.5L), x = (u - quarter / 4) * 2 * std::acos(-1.0L);
    const int q = static_cast<int>(quarter) % 4;
    return q == 0 ? std::cos(x) : q == 1 ? -std::sin(x) : q == 2 ? -std::cos(x) : std::sin(x);
  };
  const Arguments<T> in = spread<T>(0, 1, T(1e-30));
  expect_ulps<T>("sin_2pi", sine, in, 2);
  expect_ulps<T>("cos_2pi", cosine, in, 2);
}

TYPED_TEST(PacketFunctionsOf, SinAndCosOfAngles) {
  using T = TypeParam;
  // At most a rounding of π/2's third part is left of the zeros.
  const double absolute = sizeof(T) == 4 ? 1e-14 : 0x1p-115;
  const Arguments<T> in = spread<T>(0, T(6.2831853071795864769), T(1e-30));
  expect_ulps<T>("sin", std::sin, in, 2, absolute);
  expect_ulps<T>("cos", std::cos, in, 2, absolute);
}

TYPED_TEST(PacketFunctionsOf, AnglesOfPointsAndOfCosines) {
  using T = TypeParam;
  for (const T least : {T(0.01), T(1e-15)}) {
    Arguments<T> in = spread<T>(T(-1), T(1), least);
    const Arguments<T> other = spread<T>(T(-3), T(3), least);
    for (std::size_t i = 0; i < kCount; ++i) in.y[i] = other.x[(i * 17) % kCount];
    expect_ulps<T>(
        "arctan2", +[](long double x, long double y) { return std::atan2(y, x); }, in, 2);
    expect_ulps<T>("arcsin", std::asin, in, 3);
    expect_ulps<T>("arccos", std::acos, in, 3);
    for (std::size_t i = 0; i < kCount; ++i) in.x[i] = 1 - std::fabs(in.x[i]);
    expect_ulps<T>("arccos", std::acos, in, 3);
  }
}

TYPED_TEST(PacketFunctionsOf, AnglesOnTheAxesAreExact) {
  using T = TypeParam;
  const T pi = static_cast<T>(3.14159265358979323846L), least = std::numeric_limits<T>::min();
  const struct {
    T x, y, angle;
  } cases[] = {{0, 0, 0},
               {1, 0, 0},
               {-1, 0, pi},
               {-1, -T(0), pi},
               {0, 1, pi / 2},
               {0, -1, -pi / 2},
               {-T(0), -1, -pi / 2},
               {least, 0, 0},
               {-least, 0, pi},
               {0, least, pi / 2},
               {1, 1, pi / 4},
               {-1, -1, -3 * (pi / 4)},
               {T(1e30), T(1e30), pi / 4}};
  for (const auto& c : cases) {
    Arguments<T> in;
    std::fill_n(in.x.data(), kCount, c.x);
    std::fill_n(in.y.data(), kCount, c.y);
    for (const Isa isa : supported_isas()) {
      const PacketFunction<T>& f = function<T>(isa, "arctan2");
      for (const auto apply : {f.packets, f.scalars}) {
        EXPECT_NEAR(call<T>(apply, in)[1], c.angle, 2 * std::numeric_limits<T>::epsilon()) << c.x << ' ' << c.y;
      }
    }
  }
  Arguments<T> ends;
  std::fill_n(ends.x.data(), kCount, T(1));
  expect_bits<T>("arccos", ends, [](Isa, T, T, T) { return T(0); });
  expect_bits<T>("arcsin", ends, [&](Isa, T, T, T) { return pi / 2; });
  std::fill_n(ends.x.data(), kCount, T(-1));
  expect_bits<T>("arccos", ends, [&](Isa, T, T, T) { return pi; });
}

TYPED_TEST(PacketFunctionsOf, PowersOfTwoAreTheLargestBelow) {
  using T = TypeParam;
  const Arguments<T> in =
      spread<T>(std::numeric_limits<T>::min(), std::numeric_limits<T>::max(), std::numeric_limits<T>::min());
  expect_bits<T>("power_of_two_below", in, [](Isa, T x, T, T) { return std::ldexp(T(1), std::ilogb(x)); });
}

// Our own functions are one text for all, so scalars and packets differ in nothing.
TYPED_TEST(PacketFunctionsOf, ScalarsHaveThePacketsBits) {
  using T = TypeParam;
  Arguments<T> in = spread<T>(0, T(6.25), T(1e-20));
  for (std::size_t i = 0; i < kCount; ++i) in.y[i] = in.x[(i * 17) % kCount] - T(3);
  for (const char* name : {"sin", "cos", "arctan2", "arccos", "arcsin", "power_of_two_below"}) {
    if (name[0] == 'a') {
      for (std::size_t i = 0; i < kCount; ++i) in.x[i] = std::fmod(in.x[i], T(1));
    }
    for (const Isa isa : supported_isas()) {
      const PacketFunction<T>& f = function<T>(isa, name);
      const AlignedBuffer<T> packets = call<T>(f.packets, in), scalars = call<T>(f.scalars, in);
      EXPECT_EQ(std::memcmp(packets.data(), scalars.data(), kCount * sizeof(T)), 0) << name << ' ' << to_string(isa);
    }
  }
}

// One lane never changes another, and AVX2 and AVX-512 give the same bits.
TYPED_TEST(PacketFunctionsOf, LanesStandAloneAndAvx2AndAvx512AgreeToTheBit) {
  using T = TypeParam;
  const std::vector<Isa> isas = supported_isas();
  Arguments<T> in = spread<T>(std::is_same_v<T, float> ? T(-87) : T(-708), T(88), T(1e-30));
  for (std::size_t i = 0; i < kCount; ++i) {
    in.y[i] = in.x[kCount - 1 - i];
    in.z[i] = in.x[(i * 17) % kCount];
  }
  Arguments<T> rotated;
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t from = (i * 5 + 3) % kCount;
    rotated.x[i] = in.x[from], rotated.y[i] = in.y[from], rotated.z[i] = in.z[from];
  }
  for (std::size_t f = 0; f < functions(isas[0]).count; ++f) {
    const std::string name = functions(isas[0]).f32[f].name;
    if (name == "any_lane") continue;
    AlignedBuffer<T> avx2;
    for (const Isa isa : isas) {
      AlignedBuffer<T> found = call<T>(function<T>(isa, name).packets, in);
      const AlignedBuffer<T> other = call<T>(function<T>(isa, name).packets, rotated);
      for (std::size_t i = 0; i < kCount; ++i) {
        ASSERT_EQ(std::memcmp(&other[i], &found[(i * 5 + 3) % kCount], sizeof(T)), 0) << name << ' ' << to_string(isa);
      }
      if (isa == Isa::kAvx512) {
        EXPECT_EQ(std::memcmp(found.data(), avx2.data(), kCount * sizeof(T)), 0) << name;
      }
      if (isa == Isa::kAvx2) avx2 = std::move(found);
    }
  }
}

}  // namespace
}  // namespace halfslope
