// The power spectrum of two-dimensional points.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/discrepancy.h"

namespace halfslope {

/// P(kx, ky) = |Σ_j exp(−2πi (kx x_j + ky y_j))|²/N at all integer frequencies up to some `most` in both directions:
/// the Fourier series of the points on the torus itself, not of a picture of them. P(0, 0) = N; P(−kx, −ky) = P(kx,
/// ky). Independent uniform points have the expectation 1 everywhere else.
class PowerSpectrum {
 public:
  /// `points`: of two dimensions (any other number aborts); `most`: at least 0.
  ///
  /// The sum factors into cosines and sines of each coordinate, so all of it is one product of two matrices,
  /// (2 most + 2) × N and N × (2 most + 2), in blocks of 512 points: 8 N (most + 1)² flops, and
  /// 32 (most + 1)² + 16 kB · (most + 1) bytes whatever N. Angles are reduced to a turn exactly, and each cosine is
  /// right to 1e-15, so the sum over N points is right to 1e-14 N and better, P to 2e-14 √(N P).
  PowerSpectrum(const PointSet& points, int most);

  int most() const { return most_; }
  /// |kx|, |ky| ≤ most.
  double at(int kx, int ky) const;

 private:
  int most_;
  std::vector<double> same_, opposite_;  ///< by |ky|, |kx|: where kx and ky have one sign, or two
};

/// Rings of frequencies: ring f holds all integer (kx, ky) with round(√(kx² + ky²)) = f, f ≥ 1. It has about 2πf of
/// them, half of which mirror the other half.
///
/// The mean of P over each of the rings f = 1 … most, all of them whole; ring f is at place f − 1. Independent points:
/// expectation 1.
std::vector<double> radial_spectrum(const PowerSpectrum& spectrum);

/// R. Ulichney, "Dithering with blue noise", Proc. IEEE 76(1), 1988: 10 log₁₀ of (the variance of P in ring f over the
/// square of its mean), dB, place f − 1. Variance and mean are over the m frequencies of half the ring, the variance
/// with m − 1, since the other half repeats them. For one set of N independent points each P is nearly exponential, and
/// the ratio has the expectation m/(m + 1) as N grows: about 0 dB. (A mean of R periodograms, as Ulichney takes, has
/// −10 log₁₀ R dB; this is of one.) −∞ where all P of a ring are equal, NaN where all are 0.
std::vector<double> anisotropy(const PowerSpectrum& spectrum);

}  // namespace halfslope
