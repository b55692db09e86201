// Sums over pairs of points of a product over dimensions, in about 100 bits.
//
// A product p_1 p_2 … is carried as its rounded value and the sum of what each rounding lost (the compensated product
// of S. Graillat, "Accurate floating-point product and exponentiation", IEEE Trans. Comput. 58(7), 2009): right to
// about (d ε)². The sum over pairs likewise (Ogita, Rump, Oishi 2005, algorithm 4.4), in kPairLanes running sums that
// are added in one order whatever the packet.
#include <array>

#include "analysis/kernel_functions.h"
#include "core/packet.h"

namespace halfslope::kernel {
namespace {

template <class F>
struct Pair {
  F high, low;
};

template <class F>
inline Pair<F> two_sum(const F& a, const F& b) {
  const F s = a + b, rounded = s - a;
  return {s, (a - (s - rounded)) + (b - rounded)};
}

/// Exact where |a| ≥ |b|.
template <class F>
inline Pair<F> ordered_sum(const F& a, const F& b) {
  const F s = a + b;
  return {s, b - (s - a)};
}

#ifndef __FMA__
template <class F>
inline Pair<F> split(const F& a) {
  const F t = a * F(134217729.0), high = t - (t - a);
  return {high, a - high};
}
#endif

template <class F>
inline Pair<F> two_product(const F& a, const F& b) {
  const F p = a * b;
#ifdef __FMA__
  return {p, fma(a, b, -p)};
#else
  const Pair<F> x = split(a), y = split(b);
  return {p, ((x.high * y.high - p) + x.high * y.low + x.low * y.high) + x.low * y.low};
#endif
}

/// The product so far.
template <class F>
struct Product {
  F value = F(1.0), error = F(0.0);

  void multiply(const F& factor) {
    const Pair<F> p = two_product(value, factor);
    error = fma(error, factor, p.low);
    value = p.high;
  }
  void multiply(const Pair<F>& factor) {
    const Pair<F> p = two_product(value, factor.high);
    error = fma(error, factor.high, fma(value, factor.low, p.low));
    value = p.high;
  }
};

// The kernels of one dimension; their formulas are QuadraticForm's. Coordinates are multiples of 2⁻⁵³ in [−½, ½], so
// their differences are exact.
template <class F>
struct Point {
  F z, z_low, g, g_low;
};

struct Minimum {
  template <class F>
  static void apply(const PairProducts&, const Point<F>& a, const Point<F>& b, Product<F>& product) {
    const F nearest = F(0.5) - max(a.z, b.z);
    product.multiply(nearest + nearest);
  }
};
struct Interval {
  template <class F>
  static void apply(const PairProducts&, const Point<F>& a, const Point<F>& b, Product<F>& product) {
    const F right = F(0.5) - max(a.z, b.z), left = F(0.5) + min(a.z, b.z);
    product.multiply(right + right);
    product.multiply(left + left);
  }
};
struct Symmetric {
  template <class F>
  static void apply(const PairProducts&, const Point<F>& a, const Point<F>& b, Product<F>& product) {
    product.multiply(F(1.0) - abs(a.z - b.z));
  }
};
struct Centered {
  template <class F>
  static void apply(const PairProducts&, const Point<F>& a, const Point<F>& b, Product<F>& product) {
    const F zero(0.0);
    product.multiply(ordered_sum(F(1.0), max(min(a.z, b.z), zero) - min(max(a.z, b.z), zero)));
  }
};
struct Periodic {
  template <class F>
  static void apply(const PairProducts& in, const Point<F>& a, const Point<F>& b, Product<F>& product) {
    const F t = F(0.5) - abs(a.z - b.z);
    const Pair<F> square = two_product(F(in.scale) * t, t);
    const Pair<F> sum = two_sum(F(in.offset.high), square.high);
    product.multiply({sum.high, sum.low + (square.low + F(in.offset.low))});
  }
};
struct Mixture {
  // 8 k = (3/2 − 2|z − z'|)² + 51/4 − 2 (|z| + |z'|)
  template <class F>
  static void apply(const PairProducts&, const Point<F>& a, const Point<F>& b, Product<F>& product) {
    const F t = F(0.75) - abs(a.z - b.z);
    const Pair<F> square = two_product(t, t * F(0.5));
    const Pair<F> centre = two_sum(F(51.0 / 32), F(-0.25) * (abs(a.z) + abs(b.z)));
    const Pair<F> sum = two_sum(centre.high, square.high);
    product.multiply({sum.high, sum.low + (centre.low + square.low)});
  }
};
struct General {
  static constexpr bool kGeneral = true;
  template <class F>
  static void apply(const PairProducts& in, const Point<F>& a, const Point<F>& b, Product<F>& product) {
    const Pair<F> g = two_sum(a.g, b.g);
    const F scaled = F(in.h) * a.z;
    const Pair<F> mixed = two_product(scaled, b.z);
    const F mixed_low = fma(scaled, b.z_low, fma(F(in.h) * a.z_low, b.z, mixed.low));
    const F d = a.z - b.z, d_low = a.z_low - b.z_low;
    // The low part of |d|: the sign of d decides, and where d is 0 its own.
    const F distance_low = select(d == F(0.0), abs(d_low), select(d < F(0.0), -d_low, d_low));
    const Pair<F> distance = two_product(F(-in.c), abs(d));
    const Pair<F> first = two_sum(g.high, mixed.high), second = two_sum(first.high, distance.high);
    const F low = (second.low + first.low) + (g.low + a.g_low + b.g_low) +
                  (mixed_low + fma(F(-in.c), distance_low, distance.low));
    product.multiply(ordered_sum(second.high, low));
  }
};

template <class Kernel>
constexpr bool is_general = requires {
  Kernel::kGeneral;
};

template <class F, class Kernel>
inline Point<F> point(const PairProducts& in, std::size_t at) {
  if constexpr (is_general<Kernel>) {
    return {load<F>(in.z_high + at), load<F>(in.z_low + at), load<F>(in.g_high + at), load<F>(in.g_low + at)};
  } else {
    return {load<F>(in.z_high + at), F(0.0), F(0.0), F(0.0)};
  }
}
template <class F, class Kernel>
inline Point<F> same_point(const PairProducts& in, std::size_t at) {
  if constexpr (is_general<Kernel>) {
    return {F(in.z_high[at]), F(in.z_low[at]), F(in.g_high[at]), F(in.g_low[at])};
  } else {
    return {F(in.z_high[at]), F(0.0), F(0.0), F(0.0)};
  }
}

constexpr std::size_t kLanes = PairProducts::kPairLanes;

template <class F, class Kernel>
PairSum sum(const PairProducts& in, std::size_t i_begin, std::size_t i_end, std::size_t j_begin, std::size_t j_end) {
  constexpr auto kPacket = static_cast<std::size_t>(kWidth<F>);
  constexpr std::size_t kPackets = kLanes / kPacket;
  std::array<F, kPackets> sums, errors;
  sums.fill(F(0.0)), errors.fill(F(0.0));
  // The lanes of the last chunk that are points.
  alignas(64) std::array<double, kLanes> present;
  for (std::size_t l = 0; l < kLanes; ++l) present[l] = l < (j_end - j_begin - 1) % kLanes + 1 ? 1 : 0;
  for (std::size_t i = i_begin; i < i_end; ++i) {
    for (std::size_t j = j_begin; j < j_end; j += kLanes) {
      std::array<Product<F>, kPackets> products;
      for (std::size_t k = 0; k < in.dims; ++k) {
        const Point<F> a = same_point<F, Kernel>(in, k * in.stride + i);
        for (std::size_t p = 0; p < kPackets; ++p)
          Kernel::apply(in, a, point<F, Kernel>(in, k * in.stride + j + p * kPacket), products[p]);
      }
      const bool last = j + kLanes >= j_end;
      for (std::size_t p = 0; p < kPackets; ++p) {
        if (last) {
          const F here = load<F>(present.data() + p * kPacket);
          products[p].value = products[p].value * here;
          products[p].error = products[p].error * here;
        }
        const Pair<F> s = two_sum(sums[p], products[p].value);
        sums[p] = s.high;
        errors[p] = errors[p] + (s.low + products[p].error);
      }
    }
  }
  alignas(64) std::array<double, kLanes> highs, lows;
  for (std::size_t p = 0; p < kPackets; ++p) {
    store(highs.data() + p * kPacket, sums[p]);
    store(lows.data() + p * kPacket, errors[p]);
  }
  Pair<double> total = {0, 0};
  for (std::size_t l = 0; l < kLanes; ++l) {
    const Pair<double> s = two_sum(total.high, highs[l]);
    total = {s.high, total.low + (s.low + lows[l])};
  }
  total = ordered_sum(total.high, total.low);
  return {total.high, total.low};
}

}  // namespace

PairSum pair_products(const PairProducts& points, std::size_t i_begin, std::size_t i_end, std::size_t j_begin,
                      std::size_t j_end) {
  using F = NativePacket<double>;
  switch (points.form) {
    case QuadraticForm::kMinimum:
      return sum<F, Minimum>(points, i_begin, i_end, j_begin, j_end);
    case QuadraticForm::kInterval:
      return sum<F, Interval>(points, i_begin, i_end, j_begin, j_end);
    case QuadraticForm::kSymmetric:
      return sum<F, Symmetric>(points, i_begin, i_end, j_begin, j_end);
    case QuadraticForm::kCentered:
      return sum<F, Centered>(points, i_begin, i_end, j_begin, j_end);
    case QuadraticForm::kPeriodic:
      return sum<F, Periodic>(points, i_begin, i_end, j_begin, j_end);
    case QuadraticForm::kMixture:
      return sum<F, Mixture>(points, i_begin, i_end, j_begin, j_end);
    case QuadraticForm::kGeneral:
      break;
  }
  return sum<F, General>(points, i_begin, i_end, j_begin, j_end);
}

}  // namespace halfslope::kernel
