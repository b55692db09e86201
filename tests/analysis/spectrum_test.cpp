#include "analysis/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/analysis/point_sets.h"

namespace halfslope {
namespace {

/// k x is exact in 64 bits, and so are its whole turns.
double power(const Columns& points, int kx, int ky) {
  long double re = 0, im = 0;
  for (std::size_t j = 0; j < points[0].size(); ++j) {
    const long double turns = std::fmod(kx * static_cast<long double>(points[0][j]), 1.0L) +
                              std::fmod(ky * static_cast<long double>(points[1][j]), 1.0L);
    re += std::cos(2 * std::numbers::pi_v<long double> * turns);
    im += std::sin(2 * std::numbers::pi_v<long double> * turns);
  }
  return static_cast<double>((re * re + im * im) / static_cast<long double>(points[0].size()));
}

// What the header promises: the sum is right to 1e-14 N.
void expect_power(const PowerSpectrum& spectrum, const Columns& points, int kx, int ky) {
  const auto n = static_cast<double>(points[0].size());
  const double expected = power(points, kx, ky);
  EXPECT_NEAR(spectrum.at(kx, ky), expected, 2e-14 * std::sqrt(n * expected) + 1e-28 * n) << kx << ' ' << ky;
}

TEST(Spectrum, IsTheSumOfEachFrequency) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {1, 2, 100, 512, 513, 1500}) {  // blocks are of 512
    SCOPED_TRACE(count);
    const Columns points = random_points(count, 2, random);
    const PowerSpectrum spectrum(view(points), 6);
    for (int ky = -6; ky <= 6; ++ky) {
      for (int kx = -6; kx <= 6; ++kx) expect_power(spectrum, points, kx, ky);
    }
  }
}

TEST(Spectrum, OfHighFrequencies) {
  std::mt19937_64 random(2);
  Columns points = random_points(1000, 2, random);
  points[0][0] = 1, points[1][0] = 0x1p-60, points[0][1] = 0x1p-1000, points[1][1] = 0x1.fffffffffffffp-1;
  const PowerSpectrum spectrum(view(points), 512);
  for (const auto& [kx, ky] : {std::pair(512, 512), {-512, 512}, {511, -3}, {0, 512}, {256, 0}, {-17, -400}, {1, 1}})
    expect_power(spectrum, points, kx, ky);
}

TEST(Spectrum, IsSymmetricAndHasAllPointsAt0) {
  std::mt19937_64 random(3);
  const PowerSpectrum spectrum(view(random_points(777, 2, random)), 9);
  EXPECT_EQ(spectrum.at(0, 0), 777);
  for (int ky = -9; ky <= 9; ++ky) {
    for (int kx = -9; kx <= 9; ++kx) EXPECT_EQ(spectrum.at(kx, ky), spectrum.at(-kx, -ky));
  }
  EXPECT_NE(spectrum.at(3, 4), spectrum.at(3, -4));
  const PowerSpectrum mean(view(random_points(10, 2, random)), 0);
  EXPECT_EQ(mean.at(0, 0), 10);
}

// The points (i/N, g i/N) have the power N where kx + g ky ≡ 0 mod N, and none elsewhere.
TEST(Spectrum, OfLatticesIsExactPeaks) {
  for (const auto& [n, g] : {std::pair(21, 13), {144, 89}, {1024, 363}}) {
    Columns points(2);
    for (int i = 0; i < n; ++i) points[0].push_back(1.0 * i / n), points[1].push_back(1.0 * (i * g % n) / n);
    const PowerSpectrum spectrum(view(points), 64);
    int peaks = 0;
    for (int ky = -64; ky <= 64; ++ky) {
      for (int kx = -64; kx <= 64; ++kx) {
        const bool peak = (kx + g * ky) % n == 0;
        peaks += peak;
        // Elsewhere the coordinates' own rounding is left, which is 2π |k| 2⁻⁵⁴ N at most.
        EXPECT_NEAR(spectrum.at(kx, ky), peak ? n : 0, peak ? 1e-12 * n : 1e-26 * n) << kx << ' ' << ky;
      }
    }
    EXPECT_GT(peaks, 10);
  }
}

// Each power has mean 1 and variance 1 − 1/N, nearly exponential, the sum of 400 nearly gamma: beyond 6 standard errors
// once in 5e7 sums, 24 of them: false alarm 5e-7.
TEST(Spectrum, OfIndependentPointsIs1) {
  std::mt19937_64 random(4);
  constexpr int kReplicates = 400, kN = 256;
  std::vector<double> sums(24);
  for (int r = 0; r < kReplicates; ++r) {
    const PowerSpectrum spectrum(view(random_points(kN, 2, random)), 24);
    for (int k = 0; k < 24; ++k)
      sums[static_cast<std::size_t>(k)] += k % 3 == 0 ? spectrum.at(k + 1, 0) : spectrum.at(k, k % 2 == 0 ? k : -7);
  }
  for (const double sum : sums) EXPECT_NEAR(sum / kReplicates, 1, 6 * std::sqrt((1 - 1.0 / kN) / kReplicates));
}

// One point anywhere in each cell of an n × n grid: the mean of each exponential is known, and only its variance is
// left of the power: 1 − (sinc(kx/n) sinc(ky/n))², sinc x = sin(πx)/(πx), but at multiples of n in both. Powers are
// nearly exponential; 6 standard errors as above.
TEST(Spectrum, OfJitteredPoints) {
  std::mt19937_64 random(5);
  constexpr int kSide = 16, kReplicates = 400;
  const std::pair<int, int> frequencies[] = {{1, 0},  {0, 3},  {2, -5},  {7, 7},   {-8, 8},
                                             {12, 1}, {16, 3}, {16, 16}, {20, -23}};
  std::vector<double> sums(std::size(frequencies));
  for (int r = 0; r < kReplicates; ++r) {
    Columns points = random_points(kSide * kSide, 2, random);
    for (int i = 0; i < kSide * kSide; ++i) {
      const auto j = static_cast<std::size_t>(i);
      points[0][j] = (i % kSide + points[0][j]) / kSide;
      points[1][j] = (i / kSide + points[1][j]) / kSide;
    }
    const PowerSpectrum spectrum(view(points), 24);
    for (std::size_t f = 0; f < sums.size(); ++f) sums[f] += spectrum.at(frequencies[f].first, frequencies[f].second);
  }
  const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); };
  for (std::size_t f = 0; f < sums.size(); ++f) {
    const auto [kx, ky] = frequencies[f];
    const double expected = 1 - std::pow(sinc(1.0 * kx / kSide) * sinc(1.0 * ky / kSide), 2);
    EXPECT_NEAR(sums[f] / kReplicates, expected, 6 * expected / std::sqrt(kReplicates)) << kx << ' ' << ky;
  }
}

/// All frequencies of a ring, both halves.
std::vector<double> ring(const PowerSpectrum& spectrum, int f) {
  std::vector<double> powers;
  for (int ky = -f; ky <= f; ++ky) {
    for (int kx = -f; kx <= f; ++kx) {
      if (std::lround(std::hypot(kx, ky)) == f) powers.push_back(spectrum.at(kx, ky));
    }
  }
  return powers;
}

TEST(RadialSpectrum, IsTheMeanOfWholeRings) {
  std::mt19937_64 random(6);
  const PowerSpectrum spectrum(view(random_points(300, 2, random)), 40);
  const std::vector<double> radial = radial_spectrum(spectrum), decibels = anisotropy(spectrum);
  ASSERT_EQ(radial.size(), 40u);
  ASSERT_EQ(decibels.size(), 40u);
  EXPECT_EQ(ring(spectrum, 1).size(), 8u);  // (±1, 0), (0, ±1), (±1, ±1)
  for (int f = 1; f <= 40; ++f) {
    const std::vector<double> powers = ring(spectrum, f);
    double sum = 0, squares = 0;
    for (const double p : powers) sum += p;
    const auto n = static_cast<double>(powers.size());
    const double mean = sum / n;
    for (const double p : powers) squares += (p - mean) * (p - mean);
    const auto place = static_cast<std::size_t>(f - 1);
    EXPECT_NEAR(radial[place], mean, 1e-13 * mean) << f;
    // Half of them are copies: n/2 values, n/2 − 1 degrees of freedom.
    EXPECT_NEAR(decibels[place], 10 * std::log10(squares / 2 / (n / 2 - 1) / (mean * mean)), 1e-10) << f;
  }
}

// The variance of m exponentials over their squared mean is m/(m + 1) in the mean. Ring 10 has m = 28 of them; powers
// of 1000 points are exponential to 1/1000. Standard errors are taken from the 300 replicates: 7 of them, a false alarm
// in 1e6 runs even with the ratio's skewness (about 1 for one, 0.06 for the mean).
TEST(Anisotropy, OfIndependentPointsIsNear0dB) {
  std::mt19937_64 random(7);
  constexpr int kReplicates = 300;
  double m = 0, sum = 0, squares = 0;
  for (int r = 0; r < kReplicates; ++r) {
    const PowerSpectrum spectrum(view(random_points(1000, 2, random)), 10);
    m = static_cast<double>(ring(spectrum, 10).size()) / 2;
    const double ratio = std::pow(10, anisotropy(spectrum).back() / 10);
    sum += ratio, squares += ratio * ratio;
  }
  const double mean = sum / kReplicates;
  const double error = std::sqrt((squares / kReplicates - mean * mean) / (kReplicates - 1));
  EXPECT_NEAR(mean, m / (m + 1), 7 * error + 2e-3);
}

// Points on the diagonal have one power along each line kx + ky = const, and N where it is 0.
// A lattice has no power but at its dual's frequencies, so on a ring without any there is nothing but rounding.
TEST(Anisotropy, OfRingsWithoutPowerIsUndefined) {
  constexpr std::size_t kSide = 12;  // whose coordinates are no binary fractions
  Columns points(2);
  for (std::size_t i = 0; i < kSide * kSide; ++i) {
    points[0].push_back((static_cast<double>(i % kSide) + 0.5) / kSide);
    points[1].push_back((static_cast<double>(i / kSide) + 0.5) / kSide);
  }
  const PowerSpectrum spectrum(view(points), 12);
  const auto power = radial_spectrum(spectrum), decibels = anisotropy(spectrum);
  for (std::size_t f = 1; f <= 12; ++f) {
    if (f < 12) {
      EXPECT_LT(power[f - 1], 1e-25) << f;
      EXPECT_TRUE(std::isnan(decibels[f - 1])) << f;
    } else {
      EXPECT_GT(power[f - 1], 1) << f;  // 144 at (12, 0) and at (0, 12)
      EXPECT_TRUE(std::isfinite(decibels[f - 1])) << f;
    }
  }
}

TEST(Anisotropy, OfPointsOnALine) {
  std::mt19937_64 random(8);
  Columns line = random_points(500, 1, random);
  line.push_back(line[0]);
  EXPECT_GT(anisotropy(PowerSpectrum(view(line), 20))[15], 10);
}

TEST(SpectrumDeathTest, IsOfTwoDimensions) {
  EXPECT_DEATH(PowerSpectrum(view({{0.5}}), 4), "dimensions of a power spectrum");
  EXPECT_DEATH(PowerSpectrum(view({{0.5}, {0.5}}), 4).at(5, 0), "a frequency of the spectrum");
}

}  // namespace
}  // namespace halfslope
