// The quadratic discrepancies' kernels, their ways by dimension, and the table of measures made of them.
#include "analysis/quadratic_discrepancy.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/quadratic_plane.h"
#include "core/assertion.h"
#include "core/kernel_library.h"

namespace halfslope {
namespace {

using Form = QuadraticForm;

// (1 + π²/3)/π², for the diaphony: its k = 1 + 2π² (1/6 − |z − z'| + (z − z')²), taken 2/π² times.
constexpr DoubleDouble kDiaphonyG0 = {0x1.bd1612dde071dp-2, 0x1.0c2b0f170a6c6p-56};

}  // namespace

// To add one: its k in the general form, taken 2^doublings times so that both ∫∫ k and k(z, z) are near 1.
const QuadraticKernel kL2Star = {Form::kMinimum, {0.5, 0}, -1, 0, 0, 0, 1, 1};
const QuadraticKernel kExtremeL2 = {Form::kInterval, {0.5, 0}, 0, 0, 0, -4, 2, 2};
const QuadraticKernel kSymmetricL2 = {Form::kSymmetric, {0.5, 0}, 0, 0, 0, 0, 1, -1};
const QuadraticKernel kCenteredL2 = {Form::kCentered, {0.5, 0}, 0, 0.5, 0, 0, 0.5, 0};
const QuadraticKernel kWraparoundL2 = {Form::kPeriodic, {0.75, 0}, 0, 0, 1, -2, 1, 0};
const QuadraticKernel kPeriodicL2 = {Form::kPeriodic, {0.5, 0}, 0, 0, 2, -4, 2, 1};
const QuadraticKernel kMixtureL2 = {Form::kMixture, {15.0 / 16, 0}, 0, -0.25, 0.5, -1, 0.75, 0};
const QuadraticKernel kDiaphony = {Form::kPeriodic, kDiaphonyG0, 0, 0, 4, -8, 4, 0, true};

namespace {

DoubleDouble power(DoubleDouble base, std::size_t exponent) {
  DoubleDouble result = {1, 0};
  for (std::size_t k = 0; k < exponent; ++k) result = result * base;
  return result;
}

DoubleDouble g(const QuadraticKernel& kernel, DoubleDouble z) {
  const DoubleDouble magnitude = z.high < 0 ? -z : z;
  return kernel.g0 + z * kernel.g1 + magnitude * kernel.g2 + z * z * kernel.g3;
}

// D² · 4N² in one dimension, where the double sum is one of squares: with x in ascending order, e_i = 2N x_i − (2i − 1)
// and ē their mean,
//   D² = 2c ∫ (F − F̄)² + (2c + h) F̄²,  F(t) = #{x_i < t}/N − t,  F̄ = ∫ F = −ē/(2N),
//   4N² ∫ (F − F̄)² = 1/3 + Σ (e_i − ē)²/N:
// for a signed measure μ of mass 0, here the points' less the uniform one, ∬ g(z) dμ dμ = 0, −∬ |z − z'| dμ dμ = 2 ∫ F²
// and ∫ z dμ = −∫ F (with h = 0 and c = ½ it is Niederreiter's formula, 1992, section 2.1).
DoubleDouble line(std::span<const double> x, const QuadraticKernel& kernel) {
  std::vector<double> sorted(x.begin(), x.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  const auto offset = [&](std::size_t i) {
    return DoubleDouble::product(2 * n, sorted[i]) - DoubleDouble{2 * static_cast<double>(i) + 1, 0};
  };
  DoubleDouble sum;
  for (std::size_t i = 0; i < sorted.size(); ++i) sum = sum + offset(i);
  const DoubleDouble mean = sum / n;
  DoubleDouble squares;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const DoubleDouble difference = offset(i) - mean;
    squares = squares + difference * difference;
  }
  const DoubleDouble variance = DoubleDouble{1, 0} / 3.0 + squares / n;
  return variance * (2 * kernel.c) + mean * mean * (2 * kernel.c + kernel.h);
}

/// The points as the kernels of an instruction set want them, and their sum of Π f.
class PreparedPoints {
 public:
  PreparedPoints(const PointSet& points, const QuadraticKernel& kernel)
      : count_(points.count()), stride_((count_ + kLanes - 1) / kLanes * kLanes) {
    const std::size_t size = stride_ * points.dims();
    bool coarse = true;  // all coordinates are multiples of 2⁻⁵³
    for (std::size_t k = 0; k < points.dims(); ++k)
      for (const double x : points.column(k)) coarse = coarse && whole(x) == x;
    z_ = aligned(size, storage_[0]);
    if (!coarse)
      z_low_ = aligned(size, storage_[1]), g_ = aligned(size, storage_[2]), g_low_ = aligned(size, storage_[3]);
    std::vector<DoubleDouble> products(count_, DoubleDouble{1, 0});
    const DoubleDouble centre = kernel.mean_g() - DoubleDouble{kernel.c / 4, 0};
    for (std::size_t k = 0; k < points.dims(); ++k) {
      for (std::size_t i = 0; i < count_; ++i) {
        const double x = points.column(k)[i], high = whole(x) - 0.5, low = x - whole(x);
        const DoubleDouble z = DoubleDouble::sum(high, low), g_of_z = g(kernel, z);
        products[i] = products[i] * (g_of_z + centre - z * z * kernel.c);
        const std::size_t at = k * stride_ + i;
        z_[at] = high;
        if (!coarse) z_low_[at] = low, g_[at] = g_of_z.high, g_low_[at] = g_of_z.low;
      }
    }
    for (const DoubleDouble& product : products) singles = singles + product;
    const DoubleDouble offset = kernel.g0 * 2.0 - DoubleDouble{kernel.g3 / 4, 0};
    pairs = {coarse ? kernel.form : Form::kGeneral,
             points.dims(),
             count_,
             stride_,
             z_,
             z_low_,
             g_,
             g_low_,
             kernel.h,
             kernel.c,
             {offset.high, offset.low},
             kernel.g3};
  }

  PairProducts pairs;
  DoubleDouble singles;

 private:
  static constexpr std::size_t kLanes = PairProducts::kPairLanes;

  static double whole(double x) { return std::nearbyint(x * 0x1p53) * 0x1p-53; }
  static double* aligned(std::size_t size, std::vector<double>& storage) {
    storage.resize(size + kLanes);
    const auto address = reinterpret_cast<std::uintptr_t>(storage.data());
    return storage.data() + (64 - address % 64) % 64 / sizeof(double);
  }

  std::size_t count_, stride_;
  std::vector<double> storage_[4];
  double *z_ = nullptr, *z_low_ = nullptr, *g_ = nullptr, *g_low_ = nullptr;
};

// D² · N² of the kernel as it is taken. Tiles of pairs, those below the diagonal twice.
DoubleDouble by_pairs(const PointSet& points, const QuadraticKernel& kernel) {
  constexpr std::size_t kTile = 256;
  const PreparedPoints prepared(points, kernel);
  const auto& kernels = halfslope::kernels<AnalysisKernels>();
  const std::size_t count = points.count();
  DoubleDouble pairs;
  for (std::size_t i = 0; i < count; i += kTile) {
    for (std::size_t j = 0; j <= i; j += kTile) {
      const PairSum tile =
          kernels.pair_products(prepared.pairs, i, std::min(i + kTile, count), j, std::min(j + kTile, count));
      pairs = pairs + DoubleDouble{tile.high, tile.low} * (j < i ? 2.0 : 1.0);
    }
  }
  const auto n = static_cast<double>(count);
  return power(kernel.mean(), points.dims()) * n * n - prepared.singles * (2 * n) + pairs;
}

// k(z, z)^d − C^d with k(z, z) = `diagonal`.
DoubleDouble excess(const QuadraticKernel& kernel, std::size_t dims, DoubleDouble diagonal) {
  return power(diagonal, dims) - power(kernel.mean(), dims);
}

double root(DoubleDouble squared, std::size_t dims, const QuadraticKernel& kernel) {
  if (kernel.normalised) return std::sqrt((squared / excess(kernel, dims, kernel.g0 * 2.0).value()).value());
  const int exponent = -kernel.doublings * static_cast<int>(dims), odd = exponent & 1;
  return std::ldexp(std::sqrt(std::ldexp(squared.value(), odd)), (exponent - odd) / 2);
}

}  // namespace

double quadratic_discrepancy_by_pairs(const PointSet& points, const QuadraticKernel& kernel) {
  assert_equal(points.dims() <= kQuadraticDims, true, "dimensions of a quadratic discrepancy");
  const auto n = static_cast<double>(points.count());
  return root(by_pairs(points, kernel) / n / n, points.dims(), kernel);
}

double quadratic_discrepancy(const PointSet& points, const QuadraticKernel& kernel) {
  const auto n = static_cast<double>(points.count());
  if (points.dims() == 1) return root(line(points.column(0), kernel) / (4 * n) / n, 1, kernel);
  if (points.dims() > 2) return quadratic_discrepancy_by_pairs(points, kernel);
  const DoubleDouble constant = kernel.mean();
  return root((constant * constant * n * n + plane_sums(points, kernel)) / n / n, 2, kernel);
}

std::string quadratic_discrepancy_refusal(std::size_t count, std::size_t dims) {
  const auto n = static_cast<double>(count);
  if (dims > 2) {
    constexpr double kMost = 1e12;
    const double work = static_cast<double>(dims) * n * n / 2;
    if (work <= kMost) return "";
    return fmt::format("{} points in {} dimensions would take {:.1e} kernels, d N^2/2 (at most {:.0e})", count, dims,
                       work, kMost);
  }
  if (dims == 2 && count > kPlanePoints) return fmt::format("{} points: in the plane it takes at most 2^26", count);
  const double bytes = n * static_cast<double>(dims == 2 ? kPlaneBytes : sizeof(double));
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (bytes <= memory) return "";
  return fmt::format("{} points would take {:.1f} GB of memory, and this machine has {:.1f}", count, bytes / 1e9,
                     memory / 1e9);
}

double quadratic_discrepancy_variance(std::size_t dims, const QuadraticKernel& kernel) {
  const DoubleDouble diagonal = kernel.mean_g() * 2.0 + DoubleDouble{kernel.h, 0} / 12.0;
  const double scaled = excess(kernel, dims, diagonal).value();
  if (kernel.normalised) return scaled / excess(kernel, dims, kernel.g0 * 2.0).value();
  return std::ldexp(scaled, -kernel.doublings * static_cast<int>(dims));
}

double l2_star_discrepancy(const PointSet& points) { return quadratic_discrepancy(points, kL2Star); }
double centered_l2_discrepancy(const PointSet& points) { return quadratic_discrepancy(points, kCenteredL2); }
double wraparound_l2_discrepancy(const PointSet& points) { return quadratic_discrepancy(points, kWraparoundL2); }
double mixture_l2_discrepancy(const PointSet& points) { return quadratic_discrepancy(points, kMixtureL2); }
double symmetric_l2_discrepancy(const PointSet& points) { return quadratic_discrepancy(points, kSymmetricL2); }
double extreme_l2_discrepancy(const PointSet& points) { return quadratic_discrepancy(points, kExtremeL2); }
double periodic_l2_discrepancy(const PointSet& points) { return quadratic_discrepancy(points, kPeriodicL2); }
double diaphony(const PointSet& points) { return quadratic_discrepancy(points, kDiaphony); }

}  // namespace halfslope
