// Every kernel against its formula as it is written on paper, in extended precision.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "tests/scenes/integrand_data.h"
#include "tests/scenes/integrand_samples.h"

namespace halfslope {
namespace {

using Real = long double;
using X = std::span<const Real>;
constexpr Real kPiL = std::numbers::pi_v<Real>;

/// f, and how far rounding of what it is computed from may throw it beyond a few ulps, in units of epsilon.
struct Smooth {
  std::string id;
  std::function<Real(X)> f;
  std::function<Real(X)> slack = [](X) { return Real(4); };
};

/// 1 where side(x) > 0.
struct Step {
  std::string id;
  std::function<Real(X)> side;
};

Real ramp(Real x) { return std::fmin(std::fmax(x, 0.0L), 1.0L); }
Real radius(X x, Real centre) {
  Real sum = 0;
  for (const Real u : x) sum += (u - centre) * (u - centre);
  return std::sqrt(sum);
}
Real sum(X x) {
  Real total = 0;
  for (const Real u : x) total += u;
  return total;
}
template <class Factor>
Real product(X x, Factor factor) {
  Real result = 1;
  for (std::size_t i = 0; i < x.size(); ++i) result *= factor(i, x[i]);
  return result;
}
Real normal_quantile(Real x) { return -std::sqrt(2.0L) * boost::math::erfc_inv(2 * x); }

std::vector<Step> steps() {
  const Real phi = (1 + std::sqrt(5.0L)) / 2;
  return {
      {"stepx", [](X x) { return 1 / kPiL - x[0]; }},
      {"quarterdisk", [](X x) { return 2 / kPiL - x[0] * x[0] - x[1] * x[1]; }},
      {"fulldisk", [](X x) { return 1 / (2 * kPiL) - std::pow(radius(x, 0.5L), 2.0L); }},
      {"triangle", [](X x) { return 1 - x[0] - x[1]; }},
      {"halfplane_irr", [=](X x) { return x[0] / (phi * phi) + 0.2L - x[1]; }},
      {"halfspace3_irr", [](X x) { return x[0] - x[1] / std::sqrt(2.0L) + x[2] / std::sqrt(3.0L) - 0.1L; }},
      {"halfspace4_irr",
       [](X x) { return x[0] + x[1] / std::sqrt(2.0L) - x[2] / std::sqrt(3.0L) - x[3] / std::sqrt(5.0L) - 0.1L; }},
      {"simplex4", [](X x) { return 2 - sum(x); }},
      {"ball3", [](X x) { return 0.4L - radius(x, 0.5L); }},
      {"ball4", [](X x) { return 0.4L - radius(x, 0.5L); }},
      {"ball:d=5,r=0.25", [](X x) { return 0.25L - radius(x, 0.5L); }},
  };
}

// The tables that Genz's families are published with.
const std::vector<Real> kCentres = {0.5L, 0.2326L, 0.6652L, 0.3979L, 0.8305L, 0.5631L};
std::vector<Real> genz_widths(const std::string& family, std::size_t d) {
  if (family == "oscillatory") {
    if (d == 2) return {1.125L, 3.375L};
    if (d == 4) return {0.2812L, 0.8438L, 1.4062L, 1.9688L};
    return {0.125L, 0.375L, 0.625L, 0.875L, 1.125L, 1.375L};
  }
  if (family == "productpeak") {
    if (d == 2) return {0.9062L, 2.7188L};
    if (d == 4) return {0.2266L, 0.6797L, 1.1328L, 1.5859L};
    return {0.1007L, 0.3021L, 0.5035L, 0.7049L, 0.9062L, 1.1076L};
  }
  if (family == "cornerpeak") {
    if (d == 2) return {0.2313L, 0.6938L};
    if (d == 4) return {0.0578L, 0.1734L, 0.2891L, 0.4047L};
    return {0.0257L, 0.0771L, 0.1285L, 0.1799L, 0.2313L, 0.2826L};
  }
  if (family == "gaussian") {
    if (d == 2) return {0.8788L, 2.6362L};
    if (d == 4) return {0.2197L, 0.6591L, 1.0984L, 1.5378L};
    return {0.0976L, 0.2929L, 0.4882L, 0.6835L, 0.8788L, 1.074L};
  }
  if (family == "continuous") {
    if (d == 2) return {1, 3};
    if (d == 4) return {0.25L, 0.75L, 1.25L, 1.75L};
    return {0.1111L, 0.3333L, 0.5556L, 0.7778L, 1, 1.2222L};
  }
  if (d == 2) return {0.5375L, 1.6125L};
  if (d == 4) return {0.1344L, 0.4031L, 0.6719L, 0.9406L};
  return {0.0597L, 0.1792L, 0.2986L, 0.4181L, 0.5375L, 0.6569L};
}

Real genz(const std::string& family, X x) {
  const std::vector<Real> a = genz_widths(family, x.size());
  Real linear = 0, squares = 0, distances = 0, peaks = 1;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Real offset = x[i] - kCentres[i];
    linear += a[i] * x[i];
    squares += a[i] * a[i] * offset * offset;
    distances += a[i] * std::fabs(offset);
    peaks /= 1 / (a[i] * a[i]) + offset * offset;
  }
  if (family == "oscillatory") return std::cos(2 * kPiL * kCentres[0] + linear);
  if (family == "productpeak") return peaks;
  if (family == "cornerpeak") return std::pow(1 + linear, -static_cast<Real>(x.size() + 1));
  if (family == "gaussian") return std::exp(-squares);
  if (family == "continuous") return std::exp(-distances);
  return x[0] <= kCentres[0] && x[1] <= kCentres[1] ? std::exp(linear) : 0;
}

void add_genz(std::vector<Smooth>& all) {
  for (const std::string family :
       {"oscillatory", "productpeak", "cornerpeak", "gaussian", "continuous", "discontinuous"}) {
    for (const int d : {2, 4, 6}) {
      all.push_back({fmt::format("genz_{}_d{}", family, d), [=](X x) { return genz(family, x); },
                     [=](X x) {
                       if (family == "oscillatory") return Real(40);  // the argument's own rounding, 8 at most
                       return family == "gaussian" || family == "continuous" ? 8 + genz(family, x)
                                                                             : 8 * genz(family, x);
                     }});
    }
  }
}

void add_products(std::vector<Smooth>& all) {
  const auto add = [&](const std::string& name, const std::vector<int>& dims, const std::function<Real(X)>& f,
                       Real slack = 4) {
    for (const int d : dims) all.push_back({fmt::format("{}_d{}", name, d), f, [=](X) { return slack; }});
  };
  add(
      "sobol_g", {4, 6, 8, 13},
      [](X x) {
        return product(x, [&](std::size_t i, Real u) {
          const std::vector<Real> six = {0, 0.5L, 3, 9}, others = {0, 1, 4.5L, 9};
          const Real a = i > 3 ? 99 : x.size() == 6 ? six[i] : others[i];
          return (std::fabs(4 * u - 2) + a) / (1 + a);
        });
      },
      16);
  add("sumsq", {3, 5, 7}, [](X x) { return sum(x) * sum(x); });
  add("oddprod", {2, 4, 6, 9},
      [](X x) { return product(x, [](std::size_t, Real u) { return std::sqrt(12.0L) * (u - 0.5L); }); });
  add(
      "morokoff", {3, 6, 10, 40},
      [](X x) {
        const Real d = static_cast<Real>(x.size());
        return std::pow(1 + 1 / d, d) * product(x, [=](std::size_t, Real u) { return std::pow(u, 1 / d); });
      },
      64);
  add(
      "subcube", {5, 10, 12},
      [](X x) {
        const Real d = static_cast<Real>(x.size());
        return product(x, [=](std::size_t, Real u) { return (d - u) / (d - 0.5L); });
      },
      16);
  add("bratley", {4, 8, 11}, [](X x) {
    Real total = 0, term = 1;
    for (const Real u : x) total += term *= -u;
    return total;
  });
  add("bernoulli2", {2, 4, 9},
      [](X x) { return product(x, [](std::size_t, Real u) { return 1 + u * u - u + 1 / 6.0L; }); });
}

std::vector<Smooth> smooth() {
  std::vector<Smooth> all = {
      {"rampx", [](X x) { return ramp(1 - (x[0] - 0.2L) / 0.2L); }},
      {"linearx", [](X x) { return x[0]; }},
      {"gaussx", [](X x) { return std::exp(-x[0] * x[0]); }},
      {"sinpix", [](X x) { return std::sin(kPiL * x[0]); }},
      {"sin2pix", [](X x) { return std::sin(2 * kPiL * x[0]); }},
      {"checker8", [](X x) { return std::fmod(std::floor(8 * x[0]) + std::floor(8 * x[1]), 2.0L); }},
      {"checker7", [](X x) { return std::fmod(std::floor(7 * x[0]) + std::floor(7 * x[1]), 2.0L); }},
      {"checker:n=100", [](X x) { return std::fmod(std::floor(100 * x[0]) + std::floor(100 * x[1]), 2.0L); }},
      {"quarterdiskramp", [](X x) { return ramp(1 - (radius(x, 0) - 0.7L) / 0.2L); }, [](X) { return Real(16); }},
      {"fulldiskramp", [](X x) { return ramp(1 - (radius(x, 0.5L) - 0.35L) / 0.1L); }, [](X) { return Real(16); }},
      {"triangleramp", [](X x) { return std::fmin(std::fmax(5 * (x[1] - x[0]), -0.5L), 0.5L) + 0.5L; }},
      {"smoothdisk",
       [](X x) {
         const Real t = ramp((radius(x, 0.5L) - 0.3L) / 0.2L);
         return 1 - t * t * (3 - 2 * t);
       },
       [](X) { return Real(16); }},
      {"kinkmax", [](X x) { return std::fmax(x[0] + x[1] - 1, 0.0L); }},
      {"quartergaussian", [](X x) { return std::exp(-x[0] * x[0] - x[1] * x[1]); }},
      {"fullgaussian", [](X x) { return std::exp(-std::pow(radius(x, 0.5L), 2.0L)); }},
      {"bilinear", [](X x) { return x[0] * x[1]; }, [](X) { return Real(0); }},
      {"biquadratic", [](X x) { return x[0] * x[0] * x[1] * x[1]; }, [](X) { return Real(0); }},
      {"sinxy", [](X x) { return std::sin(kPiL * (x[0] + x[1])); }},
      // The argument is a hundred times r², and rounds with it: a few units in 200.
      {"zoneplate100", [](X x) { return 0.5L + 0.5L * std::cos(100 * std::pow(radius(x, 0), 2.0L)); },
       [](X) { return Real(400); }},
      {"sininvr", [](X x) { return radius(x, 0) == 0 ? 0 : std::sin(kPiL / radius(x, 0)); },
       [](X x) { return 4 + 4 * kPiL / radius(x, 0); }},
      {"expprod", [](X x) { return x[0] * std::exp(x[0] * x[1]); }},
      {"invsqrtprod2", [](X x) { return product(x, [](std::size_t, Real u) { return 0.7L * std::pow(u, -0.3L); }); },
       [](X x) { return 40 * product(x, [](std::size_t, Real u) { return std::pow(u, -0.3L); }); }},
      {"invsqrt_heavy", [](X x) { return product(x, [](std::size_t, Real u) { return 0.4L * std::pow(u, -0.6L); }); },
       [](X x) { return 40 * product(x, [](std::size_t, Real u) { return std::pow(u, -0.6L); }); }},
      {"invr", [](X x) { return 1 / radius(x, 0); }, [](X) { return Real(0); }},
      {"formfactor_rect", [](X x) { return 0.25L / (kPiL * std::pow(x[0] * x[0] + x[1] * x[1] + 0.25L, 2.0L)); }},
      {"ishigami",
       [](X x) {
         const auto t = [&](std::size_t i) { return kPiL * (2 * x[i] - 1); };
         return std::sin(t(0)) + 7 * std::pow(std::sin(t(1)), 2.0L) + 0.1L * std::pow(t(2), 4.0L) * std::sin(t(0));
       },
       [](X) { return Real(64); }},
  };
  for (const int d : {1, 3, 5}) {
    all.push_back({fmt::format("keister_d{}", d),
                   [=](X x) {
                     Real squares = 0;
                     for (const Real u : x) {
                       if (u == 0) return Real(0);
                       squares += std::pow(normal_quantile(u), 2.0L);
                     }
                     return std::pow(kPiL, d / 2.0L) * std::cos(std::sqrt(squares / 2));
                   },
                   [=](X) { return 100 * std::pow(kPiL, d / 2.0L); }});
  }
  add_genz(all);
  add_products(all);
  return all;
}

template <class T>
class IntegrandFormulas : public Integrands<T> {};
TYPED_TEST_SUITE(IntegrandFormulas, Numbers);

TYPED_TEST(IntegrandFormulas, AreOneOnTheRightSide) {
  for (const Step& step : steps()) {
    SCOPED_TRACE(step.id);
    const auto scene = make_analytic_scene(step.id);
    ASSERT_TRUE(scene);
    Samples<TypeParam> samples(*scene, 0);
    const int dims = samples.points.dims();
    std::size_t near_the_edge = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      std::vector<Real> x;
      for (int d = 0; d < dims; ++d) x.push_back(static_cast<Real>(samples.u(d, i)));
      const Real side = step.side(x);
      if (std::fabs(side) < 1e-6L && ++near_the_edge > 0) continue;
      ASSERT_EQ(samples.value(i), side > 0 ? 1 : 0);
      ASSERT_EQ(samples.pdf(0, i), 1);
    }
    EXPECT_LE(near_the_edge, 2u);
  }
}

TYPED_TEST(IntegrandFormulas, GiveTheValuesOfThePaperOnes) {
  const Real epsilon = static_cast<Real>(std::numeric_limits<TypeParam>::epsilon());
  for (const Smooth& known : smooth()) {
    SCOPED_TRACE(known.id);
    const auto scene = make_analytic_scene(known.id);
    ASSERT_TRUE(scene);
    Samples<TypeParam> samples(*scene, 0);
    const int dims = samples.points.dims();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      std::vector<Real> x;
      for (int d = 0; d < dims; ++d) x.push_back(static_cast<Real>(samples.u(d, i)));
      const Real exact = known.f(x), found = static_cast<Real>(samples.value(i));
      ASSERT_EQ(samples.pdf(0, i), 1);
      if (found == exact) continue;  // infinities too
      const Real tolerance = epsilon * (16 * std::fabs(exact) + known.slack(x));
      ASSERT_LE(std::fabs(found - exact), tolerance)
          << i << ": " << static_cast<double>(found) << " is not " << static_cast<double>(exact);
    }
  }
}

TEST(IntegrandFormulas, CoverAllThatIsKnown) {
  std::set<std::string> covered;
  for (const Step& step : steps()) covered.insert(step.id);
  for (const Smooth& known : smooth()) covered.insert(known.id);
  for (const KnownIntegrand& known : known_integrands()) EXPECT_TRUE(covered.contains(known.id)) << known.id;
}

}  // namespace
}  // namespace halfslope
