// Squared errors against a reference in two independent halves, without its variance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace halfslope {

/// What two halves A and B of a reference say of its error. With W = (A + B)/2, δ its error, and D = (A − B)/2: where
/// the halves are independent with the same mean I and the same variance, δ and D are uncorrelated and of one variance,
/// so mean D² estimates V̄ = mean Var(W) with one degree of freedom an integral. And
///   (Î − A)(Î − B) = (Î − W)² − D²,
/// so the mean of the product is M − mean D²: nothing need be known of W but its halves.
struct HalfBuffers {
  double mean_square = 0;  ///< mean over the integrals of D²
  /// Variance of mean (δ² − D²), which no replicate shows: 4 Σ V_p²/P² for normal errors, twice that of a known V_p
  /// (analysis/reference_noise.h). Here (4/3) Σ (Σ_c D²)²/P², summed over each pixel's channels first: E D⁴ = 3V², and
  /// channels that share samples go together.
  double noise = 0;
};
/// Both halves pixel-major, channels fastest, of the same size, a multiple of `channels`.
HalfBuffers compare_halves(std::span<const double> a, std::span<const double> b, std::size_t channels);

/// The mean over the integrals p of (Î_p − A_p)(Î_p − B_p), for one replicate Î. With A = I + α, B = I + β, Î = I + ε,
///   E (ε − α)(ε − β) = E ε² − E εα − E εβ + E αβ = E ε²
/// where the three are independent and α and β of mean 0: the mean squared error itself, whatever the halves' variance
/// is. Of one replicate it may be negative. The three have the same size, anything else aborts; NaN for none.
///
/// F. Rousselle, C. Knaus, M. Zwicker, "Adaptive rendering with non-local means filtering", 2012, take the difference
/// of two half buffers for a pixel's variance.
double half_buffer_mse(std::span<const double> estimate, std::span<const double> a, std::span<const double> b);

/// A mean squared error by half buffers; an end that is not positive is empty, and so is the interval of replicates
/// that give none. `mse` may be negative where the reference errs as much as what it judges: it is not clamped.
struct HalfBufferMse {
  double mse = 0;
  std::optional<double> lo, hi;
};

/// The mean of half_buffer_mse over R replicates, with its 95 % interval: that of log M, M = the mean of the
/// replicates' (Î − W)² (log_mean_bootstrap_t; above 4096 log_mean_t), made wider for what the halves leave unknown
/// (widened_for_reference), its ends less mean D². NaN for no replicates.
HalfBufferMse half_buffer_interval(std::span<const double> replicates, const HalfBuffers& halves, std::uint64_t seed);

}  // namespace halfslope
