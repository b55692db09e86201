// The law of the sample variance: of normal numbers it is known, of numbers that take few values it is a finite sum.
#include "analysis/sample_variance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "analysis/run_random.h"

namespace halfslope {
namespace {

Cumulants normal_law() {
  Cumulants law;
  law.orders[2] = 1;
  return law;
}

/// 0 or 1, the latter with probability p.
Cumulants two_valued_law(double p) {
  std::array<double, 9> moments = {};
  for (int j = 0; j <= 8; ++j)
    moments[static_cast<std::size_t>(j)] = p * std::pow(1 - p, j) + (1 - p) * std::pow(-p, j);
  return cumulants_from_central_moments(p, moments);
}

/// Calls each(V̂/V, probability) for every sample of R two-valued numbers: h of them 1, V̂ = h (R − h)/(R (R − 1)).
void each_sample(double p, int replicates, const std::function<void(double, double)>& each) {
  const double n = replicates;
  for (int h = 0; h <= replicates; ++h) {
    const double choices = std::lgamma(n + 1) - std::lgamma(h + 1) - std::lgamma(n - h + 1);
    each(h * (n - h) / (n * (n - 1)) / (p * (1 - p)), std::exp(choices + h * std::log(p) + (n - h) * std::log1p(-p)));
  }
}

/// Sums of two such numbers: a of the R are 1, b are 2.
void each_sample_of_sums(double p, int replicates, const std::function<void(double, double)>& each) {
  const double n = replicates, none = 2 * std::log1p(-p), one = std::log(2 * p * (1 - p)), both = 2 * std::log(p);
  for (int a = 0; a <= replicates; ++a) {
    for (int b = 0; a + b <= replicates; ++b) {
      const double choices = std::lgamma(n + 1) - std::lgamma(a + 1) - std::lgamma(b + 1) - std::lgamma(n - a - b + 1);
      const double mean = (a + 2 * b) / n, squares = a + 4 * b - n * mean * mean;
      each(squares / (n - 1) / (2 * p * (1 - p)), std::exp(choices + a * one + b * both + (n - a - b) * none));
    }
  }
}

// (R − 1) V̂/V is χ² of R − 1 degrees of freedom.
TEST(SampleVariance, OfNormalNumbersIsChiSquared) {
  for (const int replicates : {16, 1000}) {
    const double freedom = replicates - 1;
    const auto [deviation, skewness, excess] = sample_variance_law(normal_law(), replicates);
    EXPECT_NEAR(deviation, std::sqrt(2 / freedom), 1e-14);
    EXPECT_NEAR(skewness, std::sqrt(8 / freedom), 1e-13);
    EXPECT_NEAR(excess, 12 / freedom, 1e-12);
  }
  // Tables: 0.5 % of χ²(15) lie below 4.60092, 0.5 % above 32.80132. Each end leaves out a quarter of 2 %.
  const Interval range = sample_variance_range(normal_law(), 16, 0.98);
  EXPECT_NEAR(range.lo * 15, 4.60092, 1e-5);
  EXPECT_NEAR(range.hi * 15, 32.80132, 1e-5);
}

TEST(SampleVariance, OfTwoValuedNumbersHasTheMomentsOfAFiniteSum) {
  for (const double p : {0.5, 0.3, 0.05}) {
    for (const int replicates : {4, 16, 100}) {
      double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
      each_sample(p, replicates, [&](double v, double probability) { m1 += probability * v; });
      each_sample(p, replicates, [&](double v, double probability) {
        const double d = v - 1;
        m2 += probability * d * d, m3 += probability * d * d * d, m4 += probability * d * d * d * d;
      });
      EXPECT_NEAR(m1, 1, 1e-12);
      const auto [deviation, skewness, excess] = sample_variance_law(two_valued_law(p), replicates);
      EXPECT_NEAR(deviation, std::sqrt(m2), 1e-9) << p << ' ' << replicates;
      EXPECT_NEAR(skewness, m3 / std::pow(m2, 1.5), 1e-6) << p << ' ' << replicates;
      EXPECT_NEAR(excess, m4 / (m2 * m2) - 3, 1e-6) << p << ' ' << replicates;
    }
  }
}

TEST(SampleVariance, ARangeWantsReplicatesAsTailsAreHeavy) {
  EXPECT_TRUE(has_sample_variance_range(normal_law(), 16));
  // K = 1, 1 + 1/(p (1 − p)) − 3 about, and as much for the square of the skewness.
  EXPECT_TRUE(has_sample_variance_range(two_valued_law(0.5), 16));
  EXPECT_FALSE(has_sample_variance_range(two_valued_law(0.1), 16));
  EXPECT_FALSE(has_sample_variance_range(two_valued_law(0.1), 256));
  EXPECT_TRUE(has_sample_variance_range(two_valued_law(0.1), 512));
  EXPECT_FALSE(has_sample_variance_range(Cumulants(), 256)) << "no spread";
}

// By summing probabilities, so nothing here is left to chance.
TEST(SampleVariance, IsInItsRangeWithTheProbabilityThatIsSaid) {
  int tried = 0;
  const auto expect_held = [&](const Cumulants& law, int replicates, const std::string& what, const auto& each) {
    if (!has_sample_variance_range(law, replicates)) return;
    for (const double error : {1e-2, 1e-3, 1e-4, 1e-5}) {
      const Interval range = sample_variance_range(law, replicates, 1 - error);
      double outside = 0;
      each([&](double v, double probability) {
        if (v < range.lo - 1e-12 || v > range.hi + 1e-12) outside += probability;
      });
      EXPECT_LE(outside, error) << what << ", R = " << replicates;
      ++tried;
    }
  };
  for (const double p : {0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.05, 0.02, 0.01, 0.002}) {
    const Cumulants one = two_valued_law(p);
    Cumulants two;
    two.add(one, 2);
    for (const int replicates : {16, 20, 24, 32, 48, 64, 100, 128, 256, 1024, 4096}) {
      expect_held(one, replicates, "p = " + std::to_string(p),
                  [&](const auto& each) { each_sample(p, replicates, each); });
      if (replicates > 256) continue;
      expect_held(two, replicates, "two of p = " + std::to_string(p),
                  [&](const auto& each) { each_sample_of_sums(p, replicates, each); });
    }
  }
  EXPECT_GT(tried, 250);
}

/// Sums of numbers e^−T U, rare spikes where T is large: E of the j-th power is (1 − e^−jT)/(jT).
Cumulants spikes_law(double t, int count) {
  std::array<double, 9> raw = {1}, central = {};
  for (std::size_t j = 1; j <= 8; ++j) raw[j] = -std::expm1(-static_cast<double>(j) * t) / (static_cast<double>(j) * t);
  for (std::size_t j = 0; j <= 8; ++j) {
    double choices = 1;
    for (std::size_t i = 0; i <= j; ++i) {
      central[j] += choices * raw[i] * std::pow(-raw[1], static_cast<double>(j - i));
      choices *= static_cast<double>(j - i) / static_cast<double>(i + 1);
    }
  }
  Cumulants sum;
  sum.add(cumulants_from_central_moments(raw[1], central), count);
  return sum;
}

/// Of the sum of `count` exponential numbers: κ_j = count (j − 1)!.
Cumulants gamma_law(int count) {
  Cumulants law;
  for (std::size_t j = 1; j <= 8; ++j) law.orders[j] = count * std::tgamma(j);
  return law;
}

// The number of runs outside is Poisson's of mean 100, 10 or 1 at most: above mean + 5.2 √mean + 5 with probability
// 1e-7 or less.
TEST(LongSampleVariance, IsInItsRangeOfSpikesAndGammaNumbers) {
  struct Law {
    std::string name;
    Cumulants cumulants;
    std::function<double(RunRandom&)> draw;
  };
  std::vector<Law> laws;
  for (const int count : {2, 8, 32, 128}) {
    for (const double t : {3.0, 30.0, 100.0}) {
      laws.push_back(
          {"spikes " + std::to_string(count) + ' ' + std::to_string(t), spikes_law(t, count), [=](RunRandom& random) {
             double sum = 0;
             for (int i = 0; i < count; ++i) sum += std::exp(-t * random.uniform());
             return sum;
           }});
    }
    if (count > 32) continue;
    laws.push_back({"gamma " + std::to_string(count), gamma_law(count), [=](RunRandom& random) {
                      double product = 1;
                      for (int i = 0; i < count; ++i) product *= random.uniform();
                      return -std::log(product);
                    }});
  }
  for (std::size_t l = 0; l < laws.size(); ++l) {
    for (const int replicates : {16, 64, 256}) {
      const Law& law = laws[l];
      if (!has_sample_variance_range(law.cumulants, replicates)) continue;
      const int runs = replicates == 16 ? 100000 : 20000;
      std::vector<double> outside(3), errors = {1e-2, 1e-3, 1e-4}, values(static_cast<std::size_t>(replicates));
      std::vector<Interval> ranges;
      for (const double error : errors) ranges.push_back(sample_variance_range(law.cumulants, replicates, 1 - error));
      RunRandom random(2024, l, static_cast<std::uint32_t>(replicates));
      for (int run = 0; run < runs; ++run) {
        double mean = 0, squares = 0;
        for (double& value : values) mean += (value = law.draw(random)) / replicates;
        for (const double value : values) squares += (value - mean) * (value - mean);
        const double ratio = squares / (replicates - 1) / law.cumulants[2];
        for (std::size_t e = 0; e < errors.size(); ++e) outside[e] += ratio < ranges[e].lo || ratio > ranges[e].hi;
      }
      for (std::size_t e = 0; e < errors.size(); ++e) {
        const double most = runs * errors[e];
        EXPECT_LE(outside[e], most + 5.2 * std::sqrt(most) + 5) << law.name << ", R = " << replicates;
      }
    }
  }
}

}  // namespace
}  // namespace halfslope
