#include "analysis/measures.h"

#include <algorithm>
#include <limits>

#include "analysis/curve_measures.h"
#include "analysis/measure_limits.h"
#include "analysis/quadratic_discrepancy.h"
#include "analysis/spacing.h"
#include "analysis/star_bounds.h"
#include "analysis/t_value.h"
#include "core/error.h"

namespace halfslope {
namespace {

constexpr std::size_t kAnyDims = std::numeric_limits<std::size_t>::max();

/// A measure without parameters that is one number, exact.
template <double (*kMeasure)(const PointSet&)>
MeasureInfo exact(std::string name, std::string description, std::string reference, std::size_t max_dims,
                  std::string (*refusal)(std::size_t count, std::size_t dims), std::size_t min_dims = 1) {
  MeasureInfo info = {std::move(name), std::move(description), std::move(reference), max_dims, {}, false, {}, min_dims};
  info.make = [name = info.name, refusal](const std::string&, const Parameters&) {
    return Measure{name, refusal, [name](std::size_t, std::size_t) { return std::vector{name}; },
                   [](const PointSet& points) {
                     const double value = kMeasure(points);
                     return std::vector<MeasuredValue>{{value, value, value, "exact"}};
                   }};
  };
  return info;
}

/// A discrepancy of quadratic_discrepancy.h.
template <double (*kMeasure)(const PointSet&)>
MeasureInfo quadratic(std::string name, std::string description, std::string reference,
                      std::size_t max_dims = kQuadraticDims) {
  return exact<kMeasure>(std::move(name), std::move(description), std::move(reference), max_dims,
                         quadratic_discrepancy_refusal);
}

std::vector<MeasuredValue> net_t_value(const GeneratorMatrices& matrices, std::size_t count) {
  constexpr double kMostSteps = 3e9;  // about half a minute
  const TValueBounds t = t_value_bounds(matrices, exponent_of(count, matrices.base).value(), kMostSteps);
  const bool exact = t.lower == t.upper;
  return {{static_cast<double>(t.lower), static_cast<double>(t.lower), static_cast<double>(t.upper),
           exact ? "exact" : "bounds: the search ended early"}};
}

/// Base 0 stands for that of a sampler's matrices, else for 2.
MeasureInfo t_value_info() {
  MeasureInfo info = {"t-value",
                      "smallest t for which base^m points are a (t,m,d)-net; base 0: the sampler's own, or 2",
                      "H. Niederreiter, \"Point sets and sequences with small discrepancy\", Monatsh. Math. 104, 1987",
                      kAnyDims,
                      {{"base", 0}},
                      false,
                      {}};
  info.make = [](const std::string& subject, const Parameters& parameters) {
    const auto wanted = static_cast<std::uint32_t>(parameters.whole(subject, "base", 0, 1 << 20));
    if (wanted == 1) fail(ExitCode::kBadInput, "{}: base must be at least 2, or 0 for the sampler's own", subject);
    const std::uint32_t base = wanted == 0 ? 2 : wanted;
    const std::string name = wanted == 0 ? "t-value" : fmt::format("t-value:base={}", base);
    return Measure{name,
                   [base](std::size_t count, std::size_t dims) { return t_value_refusal(count, dims, base); },
                   [name](std::size_t, std::size_t) { return std::vector{name}; },
                   [base](const PointSet& points) {
                     const double value = t_value(points, base);
                     return std::vector<MeasuredValue>{{value, value, value, "exact"}};
                   },
                   [wanted](const GeneratorMatrices& matrices, std::size_t count) {
                     const std::optional<int> m = exponent_of(count, matrices.base);
                     return m && *m <= matrices.digits && (wanted == 0 || wanted == matrices.base);
                   },
                   net_t_value};
  };
  return info;
}

/// Its value is the lower bound, which a box attains.
MeasureInfo star() {
  MeasureInfo info = {
      "star",
      "largest |share of the points - volume| over boxes anchored at the origin",
      "H. Niederreiter, \"Random Number Generation and Quasi-Monte Carlo Methods\", 1992, definition 2.1",
      kAnyDims,
      {},
      false,
      {}};
  info.make = [](const std::string&, const Parameters&) {
    return Measure{"star", star_refusal, [](std::size_t, std::size_t) { return std::vector<std::string>{"star"}; },
                   [](const PointSet& points) {
                     const StarBounds found = star_bounds(points);
                     return std::vector<MeasuredValue>{{found.lower, found.lower, found.upper, star_method(found)}};
                   }};
  };
  return info;
}

}  // namespace

// The menu. To add a measure: a function of a PointSet in a file of its own, and a row here.
std::span<const MeasureInfo> measure_catalogue() {
  static const std::vector<MeasureInfo> catalogue = {
      star(),
      quadratic<l2_star_discrepancy>(
          "l2-star", "root of the mean of (share of the points - volume)^2 over boxes anchored at the origin",
          "T. T. Warnock, \"Computational investigations of low discrepancy point sets\", 1972"),
      quadratic<centered_l2_discrepancy>(
          "centered-l2", "root of Hickernell's CD^2: boxes from each place to its nearest corner, and all projections",
          "F. J. Hickernell, \"A generalized discrepancy and quadrature error bound\", Math. Comp. 67, 1998"),
      quadratic<wraparound_l2_discrepancy>(
          "wraparound-l2", "root of Hickernell's WD^2: boxes that may go round the torus, and all projections",
          "F. J. Hickernell, \"Lattice rules: how well do they measure up?\", 1998"),
      quadratic<mixture_l2_discrepancy>(
          "mixture-l2", "root of MD^2: a compromise of centered and wrap-around, and all projections",
          "Y.-D. Zhou, K.-T. Fang, J.-H. Ning, \"Mixture discrepancy for quasi-random point sets\", J. Complexity 29, "
          "2013"),
      quadratic<symmetric_l2_discrepancy>(
          "symmetric-l2", "root of Hickernell's SD^2: unions of boxes at corners of even parity, and all projections",
          "F. J. Hickernell, \"A generalized discrepancy and quadrature error bound\", Math. Comp. 67, 1998"),
      quadratic<extreme_l2_discrepancy>(
          "extreme-l2", "root of the integral of (share of the points - volume)^2 over all boxes (unanchored)",
          "W. J. Morokoff, R. E. Caflisch, \"Quasi-random sequences and their discrepancies\", "
          "SIAM J. Sci. Comput. 15, 1994",
          kExtremeDims),
      quadratic<periodic_l2_discrepancy>(
          "periodic-l2", "root of the mean of (share of the points - volume)^2 over all boxes of the torus",
          "A. Hinrichs, R. Kritzinger, F. Pillichshammer, \"Extreme and periodic L2 discrepancy of plane point sets\", "
          "Acta Arith. 199, 2021"),
      quadratic<diaphony>("diaphony", "root of Zinterhof's F^2, over that of one point: weighted Fourier coefficients",
                          "P. Zinterhof, \"Ueber einige Abschaetzungen bei der Approximation von Funktionen mit "
                          "Gleichverteilungsmethoden\", 1976"),
      t_value_info(),
      exact<min_distance>("min-distance", "smallest distance between two points",
                          "A. Lagae, P. Dutre, \"A comparison of methods for generating Poisson disk distributions\", "
                          "Computer Graphics Forum 27(1), 2008",
                          kAnyDims, neighbours_refusal),
      exact<min_distance_toroidal>(
          "min-distance-toroidal", "smallest distance between two points on the torus",
          "A. Lagae, P. Dutre, \"A comparison of methods for generating Poisson disk distributions\", "
          "Computer Graphics Forum 27(1), 2008",
          kAnyDims, neighbours_refusal),
      exact<mean_nn_distance>(
          "mean-nn-distance", "mean over the points of the distance to the nearest other one",
          "P. J. Clark, F. C. Evans, \"Distance to nearest neighbor as a measure of spatial relationships in "
          "populations\", Ecology 35(4), 1954",
          kAnyDims, neighbours_refusal),
      exact<mean_nn_distance_toroidal>(
          "mean-nn-distance-toroidal", "mean over the points of the distance to the nearest other one, on the torus",
          "K. P. Donnelly, \"Simulations to determine the variance and edge-effect of total nearest neighbour "
          "distance\", 1978",
          kAnyDims, neighbours_refusal),
      exact<relative_radius>(
          "relative-radius", "smallest toroidal distance over that of the densest packing of as many points",
          "A. Lagae, P. Dutre, \"A comparison of methods for generating Poisson disk distributions\", "
          "Computer Graphics Forum 27(1), 2008, section 2",
          kMostPackedDims, neighbours_refusal),
      exact<dispersion>(
          "dispersion", "radius of the largest circle centred in the unit square that holds no point",
          "H. Niederreiter, \"Random Number Generation and Quasi-Monte Carlo Methods\", 1992, definition 6.2", 2,
          dispersion_refusal, 2),
      exact<dispersion_toroidal>(
          "dispersion-toroidal", "radius of the largest circle on the torus that holds no point",
          "H. Niederreiter, \"Random Number Generation and Quasi-Monte Carlo Methods\", 1992, definition 6.2", 2,
          dispersion_refusal, 2),
      {"pcf",
       "pair correlation: pairs at each toroidal distance, over those expected of independent points",
       "D. Stoyan, W. S. Kendall, J. Mecke, \"Stochastic Geometry and its Applications\", 1995, section 4.5",
       kAnyDims,
       {{"bins", 200}, {"max", 0}},
       true,
       make_pair_correlation},
      {"spectrum",
       "power |sum_j exp(-2 pi i k x_j)|^2 / N at integer frequencies k",
       "R. A. Ulichney, \"Dithering with blue noise\", Proc. IEEE 76(1), 1988",
       2,
       {{"size", 64}},
       true,
       make_spectrum,
       2},
      {"radial-spectrum",
       "mean power over each ring of frequencies, round(|k|) = f",
       "R. A. Ulichney, \"Dithering with blue noise\", Proc. IEEE 76(1), 1988",
       2,
       {{"size", 64}},
       true,
       make_radial_spectrum,
       2},
      {"anisotropy",
       "variance of the power over each ring, over its squared mean, in dB",
       "R. A. Ulichney, \"Dithering with blue noise\", Proc. IEEE 76(1), 1988",
       2,
       {{"size", 64}},
       true,
       make_anisotropy,
       2},
  };
  return catalogue;
}

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const MeasureInfo& info : measure_catalogue()) names.push_back(info.name);
  return names;
}

Measure make_measure(const std::string& name) {
  const SplitName split = split_name(name);
  for (const MeasureInfo& info : measure_catalogue()) {
    if (info.name != split.head) continue;
    const std::string subject = "measure '" + name + "'";
    Measure measure = info.make(subject, parse_parameters(subject, split.parameters, info.parameters));
    measure.name = name;
    const auto refusal = measure.refusal;
    measure.refusal = [refusal, least = info.min_dims, most = info.max_dims](std::size_t count, std::size_t dims) {
      if (least == most && dims != most) return fmt::format("it takes points of {} dimensions", most);
      return dims > most ? fmt::format("it takes at most {} dimensions", most) : refusal(count, dims);
    };
    return measure;
  }
  fail(ExitCode::kBadInput, "there is no measure '{}'{}", split.head, did_you_mean(split.head, measure_names()));
}

std::size_t measure_rank(std::string_view name) {
  const std::vector<std::string> names = measure_names();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), split_name(name).head) - names.begin());
}

}  // namespace halfslope
