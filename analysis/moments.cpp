#include "analysis/moments.h"

#include "analysis/compensated_sum.h"

namespace halfslope {

// The mean is summed first; its rounding leaves δ = mean of (x − x̄) that is not quite 0. With s_k = Σ (x − x̄)^k about
// the rounded mean, the central sums about the true mean x̄ + δ, δ = s_1/n, follow from the binomial theorem:
//   M_2 = s_2 − n δ²
//   M_3 = s_3 − 3 δ s_2 + 2 n δ³
//   M_4 = s_4 − 4 δ s_3 + 6 δ² s_2 − 3 n δ⁴
void Moments::add(std::span<const double> values) {
  if (values.empty()) return;
  const auto n = static_cast<double>(values.size());
  CompensatedSum sum;
  for (const double x : values) sum.add(x);
  const double centre = sum.value() / n;
  CompensatedSum sum1, sum2, sum3, sum4;
  for (const double x : values) {
    const double d = x - centre, square = d * d;
    sum1.add(d);
    sum2.add(square);
    sum3.add(square * d);
    sum4.add(square * square);
  }
  const double delta = sum1.value() / n, s2 = sum2.value(), s3 = sum3.value(), s4 = sum4.value();
  const double delta2 = delta * delta;
  merge({static_cast<std::int64_t>(values.size()), centre + delta, s2 - n * delta2,
         s3 - 3 * delta * s2 + 2 * n * delta2 * delta,
         s4 - 4 * delta * s3 + 6 * delta2 * s2 - 3 * n * delta2 * delta2});
}

// Sample a has n_a values with mean a and central sums A_k, sample b likewise, n = n_a + n_b, δ = b − a. The joint mean
// is a + δ n_b/n, so the values of a, seen from it, move by −δ n_b/n and those of b by +δ n_a/n. Expanding Σ (d +
// shift)^k over each sample, where Σ d = 0, and adding:
//   M_2 = A_2 + B_2 + δ² n_a n_b / n
//   M_3 = A_3 + B_3 + δ³ n_a n_b (n_a − n_b) / n² + 3 δ (n_a B_2 − n_b A_2) / n
//   M_4 = A_4 + B_4 + δ⁴ n_a n_b (n_a² − n_a n_b + n_b²) / n³ + 6 δ² (n_a² B_2 + n_b² A_2) / n² + 4 δ (n_a B_3 − n_b
//   A_3) / n
void Moments::merge(const Moments& other) {
  if (other.count == 0) return;
  if (count == 0) {
    *this = other;
    return;
  }
  const auto na = static_cast<double>(count), nb = static_cast<double>(other.count);
  const double n = na + nb, a = na / n, b = nb / n;  // shares, so that no product of counts overflows or loses bits
  const double delta = other.mean - mean, delta2 = delta * delta;
  const double between = delta2 * na * b;  // δ² n_a n_b / n
  central4 += other.central4 + between * delta2 * (a * a - a * b + b * b) +
              6 * delta2 * (a * a * other.central2 + b * b * central2) +
              4 * delta * (a * other.central3 - b * central3);
  central3 += other.central3 + between * delta * (a - b) + 3 * delta * (a * other.central2 - b * central2);
  central2 += other.central2 + between;
  mean += delta * b;
  count += other.count;
}

}  // namespace halfslope
