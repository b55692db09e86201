#include "analysis/spectrum.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/compensated_sum.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr Eigen::Index kBlock = 512;

struct Turn {
  double cos, sin;
};

/// The angle 2πkx, for 0 ≤ x ≤ 1 and 0 ≤ k < 2²⁶. Both parts of x are short enough for exact products with k, so whole
/// turns are taken away without rounding.
Turn turn(int k, double x) {
  constexpr double kShift = 0x1.8p26;  // adding it leaves 26 bits behind the point
  const double high = (x + kShift) - kShift, low = x - high;
  const double turns = k * high;
  const double angle = 2 * std::numbers::pi * ((turns - std::rint(turns)) + k * low);
  return {std::cos(angle), std::sin(angle)};
}

/// Rows k = 0 … most: cos 2πkx; after them as many of sines. A column is a point.
class WaveTable {
 public:
  explicit WaveTable(int most) : rows_(most + 1), step_(1), values_(2 * (most + 1), kBlock) {
    while (step_ * step_ < rows_) ++step_;
    short_.resize(static_cast<std::size_t>(step_));
  }

  // k = a + b·step: of ~2√most angles sine and cosine are taken, all others are one rotation away.
  void fill(std::span<const double> coordinates) {
    for (std::size_t j = 0; j < coordinates.size(); ++j) {
      const double x = coordinates[j];
      double* column = values_.col(static_cast<Eigen::Index>(j)).data();
      for (int a = 0; a < step_; ++a) short_[static_cast<std::size_t>(a)] = turn(a, x);
      for (int k = 0; k < rows_; k += step_) {
        const Turn far = turn(k, x);
        for (int a = 0; a < std::min(step_, rows_ - k); ++a) {
          const Turn near = short_[static_cast<std::size_t>(a)];
          column[k + a] = far.cos * near.cos - far.sin * near.sin;
          column[rows_ + k + a] = far.sin * near.cos + far.cos * near.sin;
        }
      }
    }
  }

  auto first(std::size_t points) const { return values_.leftCols(static_cast<Eigen::Index>(points)); }

 private:
  int rows_, step_;
  Eigen::MatrixXd values_;
  std::vector<Turn> short_;
};

/// What ring a frequency lies in, rounded exactly: √s rounds to f for whole s in (f − 1/2, f + 1/2)², that is in
/// [f² − f + 1, f² + f].
int ring_of(int kx, int ky) {
  const int square = kx * kx + ky * ky;
  auto f = static_cast<int>(std::lround(std::sqrt(static_cast<double>(square))));
  while (square > f * f + f) ++f;
  while (square <= f * f - f && f > 0) --f;
  return f;
}

/// Each ring's values, one of each mirrored pair of frequencies.
std::vector<std::vector<double>> half_rings(const PowerSpectrum& spectrum) {
  std::vector<std::vector<double>> rings(static_cast<std::size_t>(spectrum.most()));
  for (int ky = 0; ky <= spectrum.most(); ++ky) {
    for (int kx = -spectrum.most(); kx <= spectrum.most(); ++kx) {
      const int ring = ring_of(kx, ky);
      if (ring < 1 || ring > spectrum.most() || (ky == 0 && kx < 0)) continue;
      rings[static_cast<std::size_t>(ring) - 1].push_back(spectrum.at(kx, ky));
    }
  }
  return rings;
}

double mean_of(const std::vector<double>& values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return sum.value() / static_cast<double>(values.size());
}

}  // namespace

// With C, S the cosines and sines of kx x_j and c, s those of ky y_j, kx and ky not negative,
//   Σ exp(−i (kx x ± ky y)) = Σ (C c ∓ S s) − i Σ (S c ± C s):
// the four sums of products are the quarters of [C; S] [c; s]ᵀ.
PowerSpectrum::PowerSpectrum(const PointSet& points, int most) : most_(most) {
  assert_equal(points.dims(), 2u, "dimensions of a power spectrum");
  assert_equal(most >= 0, true, "a spectrum's largest frequency is at least 0");
  const Eigen::Index rows = most + 1;
  WaveTable x(most), y(most);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(2 * rows, 2 * rows);
  for (std::size_t begin = 0; begin < points.count(); begin += kBlock) {
    const std::size_t count = std::min<std::size_t>(kBlock, points.count() - begin);
    x.fill(points.column(0).subspan(begin, count));
    y.fill(points.column(1).subspan(begin, count));
    sums.noalias() += x.first(count) * y.first(count).transpose();
  }
  const auto n = static_cast<double>(points.count());
  for (Eigen::Index ky = 0; ky < rows; ++ky) {
    for (Eigen::Index kx = 0; kx < rows; ++kx) {
      const double cc = sums(kx, ky), ss = sums(rows + kx, rows + ky);
      const double sc = sums(rows + kx, ky), cs = sums(kx, rows + ky);
      same_.push_back(((cc - ss) * (cc - ss) + (sc + cs) * (sc + cs)) / n);
      opposite_.push_back(((cc + ss) * (cc + ss) + (sc - cs) * (sc - cs)) / n);
    }
  }
}

double PowerSpectrum::at(int kx, int ky) const {
  assert_equal(std::max(std::abs(kx), std::abs(ky)) <= most_, true, "a frequency of the spectrum");
  const auto place = static_cast<std::size_t>(std::abs(ky) * (most_ + 1) + std::abs(kx));
  return (kx < 0) == (ky < 0) ? same_[place] : opposite_[place];
}

std::vector<double> radial_spectrum(const PowerSpectrum& spectrum) {
  std::vector<double> means;
  for (const auto& ring : half_rings(spectrum)) means.push_back(mean_of(ring));
  return means;
}

// A power of 0 is the rounding of sums of N terms, squared over N: about 1e-31 N (P(0, 0) = N).
constexpr double kNoPower = 1e-26;

std::vector<double> anisotropy(const PowerSpectrum& spectrum) {
  std::vector<double> decibels;
  for (const auto& ring : half_rings(spectrum)) {
    const double mean = mean_of(ring);
    if (mean < kNoPower * spectrum.at(0, 0)) {
      decibels.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    CompensatedSum squares;
    for (const double value : ring) squares.add((value - mean) * (value - mean));
    const double variance = squares.value() / static_cast<double>(ring.size() - 1);
    decibels.push_back(10 * std::log10(variance / (mean * mean)));
  }
  return decibels;
}

}  // namespace halfslope
