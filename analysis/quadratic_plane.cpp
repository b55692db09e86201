// With g_i = g(z) of point i's first coordinate x_i (less ½), G_i of its second, y_i, and all sums over all points, the
// kernels' general form multiplies out to
//   ΣΣ k k = 2N Σ g_i G_i + 2 Σ g_i Σ G_i + 2h (Σ g_i y_i Σ y_i + Σ G_i x_i Σ x_i) + h² (Σ x_i y_i)²
//            − 2c (Σ_i g_i Σ_j |y_i − y_j| + Σ_i G_i Σ_j |x_i − x_j|)
//            − c h (ΣΣ x_i x_j |y_i − y_j| + ΣΣ y_i y_j |x_i − x_j|) + c² ΣΣ |x_i − x_j| |y_i − y_j|.
// In the order of y, with r_i the rank of i, Σ_j |y_i − y_j| = y_i (2 r_i − N) + Σ y − 2 Σ_{before i} y, and
// ΣΣ x_i x_j |y_i − y_j| is twice the sum over gaps between neighbours of the gap times the sum of the x on either
// side. The last double sum is 2 Σ_i x_i b_i with b_i = Σ_j σ_ij τ_ij (y_i − y_j), σ and τ the signs of x_i − x_j and
// of y_i − y_j (for equal ones, of their ranks; such pairs then add 0 together). Of the four quadrants around i the
// lower left one is enough, because the rest follow from it, from all before i in x, and from all before it in y:
//   b_i = 4 Σ_{lower left} (y_i − y_j) − 2 Σ_{before i in x} (y_i − y_j) − 2 Σ_{before i in y} (y_i − y_j) + N y_i − Σ
//   y.
#include "analysis/quadratic_plane.h"

#include <cmath>
#include <vector>

#include "analysis/quadrants.h"
#include "analysis/radix_sort.h"
#include "analysis/wide_integer.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr int kPlaces = 61;  ///< of coordinates, after the point
constexpr int kFine = 96;    ///< of g and f
constexpr std::int64_t kHalf = std::int64_t{1} << (kPlaces - 1);

Int128 fine(DoubleDouble a) {
  return static_cast<Int128>(std::ldexp(a.high, kFine)) + static_cast<Int128>(std::ldexp(a.low, kFine));
}

/// g and f in integers; kMixed where g3 or h is not 0.
template <bool kMixed>
class FixedKernel {
 public:
  explicit FixedKernel(const QuadraticKernel& k)
      : g0_(fine(k.g0)),
        f0_(fine(k.g0 + k.mean_g() - DoubleDouble{k.c / 4, 0})),
        g1_(quarters(k.g1)),
        g2_(quarters(k.g2)),
        g3_(quarters(k.g3)),
        c_(quarters(k.c)) {}

  struct Values {
    Int128 g, f;
  };
  Values operator()(std::int64_t z) const {
    const Int128 square = (static_cast<Int128>(z) * z) >> (2 * kPlaces - kFine - 2);  // 4 times as fine
    Int128 varying = static_cast<Int128>(g1_ * z + g2_ * (z < 0 ? -z : z)) << (kFine - kPlaces - 2);
    if constexpr (kMixed) varying += (square * g3_) >> 4;
    return {g0_ + varying, f0_ + varying - ((square * c_) >> 4)};
  }

 private:
  static std::int64_t quarters(double a) { return static_cast<std::int64_t>(4 * a); }

  Int128 g0_, f0_;
  std::int64_t g1_, g2_, g3_, c_;
};

/// Σ gap · P (T − P) over the gaps between neighbours in one order, P the sum of weights before and T of all: half of
/// ΣΣ w_i w_j |distance|.
class GapSum {
 public:
  explicit GapSum(Int128 total) : total_(total) {}
  void add(std::int64_t position, std::int64_t weight) {
    const WideProduct sides(before_, total_ - before_);
    sum_.add((sides.high << (128 - kPlaces)) | static_cast<Int128>(sides.low >> kPlaces), position - last_);
    before_ += weight;
    last_ = position;
  }
  DoubleDouble value() const { return sum_.value(-2 * kPlaces); }

 private:
  Int128 total_, before_ = 0;
  std::int64_t last_ = -kHalf;
  WideSum sum_;
};

/// A coordinate in units of 2⁻⁶¹.
std::uint64_t fixed(double x) { return static_cast<std::uint64_t>(std::llrint(x * 0x1p61)); }
std::int64_t centred(std::uint64_t fixed) { return static_cast<std::int64_t>(fixed) - kHalf; }

/// The points in the order of x, each knowing its rank in y, and room for as many again: in one piece, and before all
/// else, so that the C library keeps it for the next point set rather than give it back to the system.
std::vector<QuadrantPoint> in_order(const PointSet& points) {
  const std::size_t count = points.count();
  std::vector<QuadrantPoint> items(2 * count);
  std::vector<KeyedPoint> by_x(count), by_y(count);
  for (std::size_t i = 0; i < count; ++i) by_x[i] = {fixed(points.column(0)[i]), fixed(points.column(1)[i])};
  radix_sort(by_x);
  for (std::size_t k = 0; k < count; ++k) by_y[k] = {by_x[k].load, k};
  radix_sort(by_y);
  std::vector<std::uint32_t> ranks(count);
  for (std::uint32_t r = 0; r < count; ++r) ranks[by_y[r].load] = r;
  for (std::size_t k = 0; k < count; ++k) items[k] = {0, 0, centred(by_x[k].key), centred(by_x[k].load), ranks[k]};
  return items;
}

template <bool kMixed>
DoubleDouble sums(const PointSet& points, const QuadraticKernel& kernel) {
  const auto n = static_cast<std::int64_t>(points.count());
  const FixedKernel<kMixed> values(kernel);

  std::vector<QuadrantPoint> items = in_order(points);
  Int128 x_total = 0, y_total = 0;
  for (const QuadrantPoint& item : std::span(items).first(points.count())) x_total += item.x, y_total += item.y;
  WideSum distances;
  GapSum x_gaps(y_total), y_gaps(x_total);
  Int128 x_before = 0, y_before = 0;
  for (std::int64_t k = 0; k < n; ++k) {
    QuadrantPoint& item = items[static_cast<std::size_t>(k)];
    const std::int64_t x = item.x, y = item.y;
    distances.add(values(y).g, static_cast<Int128>(x) * (2 * k - n) + x_total - 2 * x_before);
    if constexpr (kMixed) x_gaps.add(x, y);
    item.set_sum(y_before - static_cast<Int128>(y) * k);
    x_before += x, y_before += y;
  }

  WideSum singles, g_G, quadrants, g_y, G_x, x_y;
  Int128 g_total = 0, G_total = 0;
  y_before = 0;
  const auto visit = [&](const QuadrantPoint& item) {
    const std::int64_t x = item.x, y = item.y;
    const auto [g, f] = values(x);
    const auto [G, F] = values(y);
    const Int128 before = static_cast<Int128>(y) * static_cast<std::int64_t>(item.rank) - y_before,
                 after = n * static_cast<Int128>(y) - y_total;
    g_G.add(g, G);
    distances.add(g, 2 * before - after);
    quadrants.add(2 * (item.sum() - before) + after, x);
    singles.add(f, F);
    g_total += g, G_total += G;
    if constexpr (kMixed) {
      g_y.add(g, y), G_x.add(G, x), x_y.add(x, y);
      y_gaps.add(y, x);
    }
    y_before += y;
  };
  Quadrants(std::span(items), visit);

  const double c = kernel.c, h = kernel.h;
  DoubleDouble half = (g_G.value(-2 * kFine) - singles.value(-2 * kFine)) * static_cast<double>(n) +
                      to_double_double(g_total, -kFine) * to_double_double(G_total, -kFine) -
                      distances.value(-kFine - kPlaces) * c + quadrants.value(-2 * kPlaces) * (c * c);
  if constexpr (kMixed) {
    const DoubleDouble xy = x_y.value(-2 * kPlaces);
    half = half +
           (g_y.value(-kFine - kPlaces) * to_double_double(y_total, -kPlaces) +
            G_x.value(-kFine - kPlaces) * to_double_double(x_total, -kPlaces)) *
               h +
           xy * xy * (h * h / 2) - (x_gaps.value() + y_gaps.value()) * (c * h);
  }
  return half * 2.0;
}

}  // namespace

DoubleDouble plane_sums(const PointSet& points, const QuadraticKernel& kernel) {
  assert_equal(points.dims(), std::size_t{2}, "dimensions of plane_sums");
  assert_equal(points.count() <= kPlanePoints, true, "at most 2^26 points in the plane");
  return kernel.h == 0 ? sums<false>(points, kernel) : sums<true>(points, kernel);
}

}  // namespace halfslope
