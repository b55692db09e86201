#include "estimators/exact_variance.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <vector>

#include "estimators/heuristics.h"

namespace halfslope {
namespace {

constexpr std::size_t kMostTechniques = 16;
using Numbers = std::array<double, kMostTechniques>;

/// f, the densities of an estimator's techniques and its weights at one x.
struct At {
  double f;
  Numbers pdfs, weights;
  double mixture;  ///< c = Σ c_k p_k
};

class Quadrature {
 public:
  Quadrature(const Estimator& estimator, const ExactDensities& densities)
      : estimator_(estimator), densities_(densities), n_(estimator.allocation.techniques.size()) {}

  std::size_t techniques() const { return n_; }
  double count(std::size_t k) const { return estimator_.allocation.counts[k]; }

  /// Adaptive, to an error of `tolerance` times the integral of the integrand's size.
  template <class Value>
  double integrate(const Value& value, double tolerance = 1e-10) const {
    std::vector<Piece> pieces;
    double total = 0;
    for (std::size_t i = 0; i + 1 < densities_.breaks.size(); ++i) {
      // Weights may jump close to where a density has its peak: intervals halve towards both ends.
      const double begin = densities_.breaks[i], end = densities_.breaks[i + 1], half = (end - begin) / 2;
      constexpr int kHalvings = 24;
      double inner = 0;
      for (int k = kHalvings; k >= 0; --k) {
        const double outer = std::ldexp(half, -k);
        pieces.push_back(piece(value, begin + inner, begin + outer));
        pieces.push_back(piece(value, end - outer, end - inner));
        inner = outer;
      }
    }
    for (const Piece& p : pieces) total += std::fabs(p.integral);
    // A jump takes some thirty; where only rounding is left to be seen there is no end to refine to.
    constexpr int kMostHalvings = 1000;
    const auto less = [](const Piece& p, const Piece& q) { return p.error < q.error; };
    std::make_heap(pieces.begin(), pieces.end(), less);
    for (int h = 0; h < kMostHalvings && pieces.front().error > tolerance * total; ++h) {
      std::pop_heap(pieces.begin(), pieces.end(), less);
      const Piece worst = pieces.back();
      const double middle = worst.begin + (worst.end - worst.begin) / 2;
      pieces.back() = piece(value, worst.begin, middle);
      std::push_heap(pieces.begin(), pieces.end(), less);
      pieces.push_back(piece(value, middle, worst.end));
      std::push_heap(pieces.begin(), pieces.end(), less);
    }
    double sum = 0;
    for (const Piece& p : pieces) sum += p.integral;
    return sum;
  }

 private:
  struct Piece {
    double begin, end, integral, error;
  };
  template <class Value>
  Piece piece(const Value& value, double begin, double end) const {
    double error = 0;
    const double integral = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
        [&](double x) { return value(at(x)); }, begin, end, 0, 0, &error);
    return {begin, end, integral, error};
  }

  At at(double x) const {
    const auto& techniques = estimator_.allocation.techniques;
    std::array<double, 64> all = {};
    At here = {densities_.evaluate(x, all), {}, {}, 0};
    Numbers ratios = {};
    for (std::size_t k = 0; k < n_; ++k) {
      here.pdfs[k] = all[static_cast<std::size_t>(techniques[k])];
      ratios[k] = count(k) * here.pdfs[k];
      here.mixture += ratios[k];
    }
    if (!is_fold(estimator_.heuristic.kind)) return here;
    const int n = static_cast<int>(n_);
    if (n > 1) to_ratios(ratios.data(), n);
    for (std::size_t k = 0; k < n_; ++k)
      here.weights[k] = weight(estimator_.heuristic, ratios.data(), n, static_cast<int>(k));
    return here;
  }

  const Estimator& estimator_;
  const ExactDensities& densities_;
  std::size_t n_;
};

/// a − b, but 0 where that is nothing but the error of the integrals in it: rounding has no end to refine to.
double difference(double a, double b) {
  constexpr double kQuadratureError = 1e-12;
  return std::fabs(a - b) > kQuadratureError * std::fabs(a) ? a - b : 0;
}

/// ∫ p_k (X − mean)^j for j = 2 … 8, where a sample of technique k is worth X; [0] and [1] stay 0.
using CentralMoments = std::array<double, Cumulants::kHighest + 1>;
template <class Worth>
CentralMoments central_moments(const Quadrature& q, std::size_t k, double mean, const Worth& worth) {
  // From the third on they say how a sample variance spreads, of which less need be known.
  constexpr double kTolerance = 1e-10, kHigherTolerance = 1e-6;
  CentralMoments moments = {};
  for (std::size_t j = 2; j < moments.size(); ++j) {
    const auto value = [&](const At& here) {
      const double p = here.pdfs[k];
      if (p == 0) return 0.0;
      const double d = difference(worth(here), mean);
      double power = p * d * d;
      for (std::size_t i = 2; i < j; ++i) power *= d;
      return power;
    };
    moments[j] = q.integrate(value, j == 2 ? kTolerance : kHigherTolerance);
  }
  return moments;
}

Cumulants fold_cumulants(const Quadrature& q) {
  Cumulants round;
  for (std::size_t k = 0; k < q.techniques(); ++k) {
    const double mean = q.integrate([&](const At& here) { return here.weights[k] * here.f; });
    const auto worth = [&](const At& here) { return here.weights[k] * here.f / here.pdfs[k]; };
    round.add(cumulants_from_central_moments(mean, central_moments(q, k, mean, worth)), q.count(k), 1 / q.count(k));
  }
  return round;
}

Cumulants one_sample_cumulants(const Quadrature& q) {
  const double mean = q.integrate([](const At& here) { return here.f; });
  double all = 0;
  for (std::size_t k = 0; k < q.techniques(); ++k) all += q.count(k);
  CentralMoments mixed = {};
  for (std::size_t k = 0; k < q.techniques(); ++k) {
    const double share = q.count(k) / all;
    const auto worth = [&](const At& here) { return here.weights[k] * here.f / (share * here.pdfs[k]); };
    const CentralMoments moments = central_moments(q, k, mean, worth);
    for (std::size_t j = 2; j < mixed.size(); ++j) mixed[j] += share * moments[j];
  }
  return cumulants_from_central_moments(mean, mixed);
}

Cumulants optimal_cumulants(const Quadrature& q) {
  const auto n = static_cast<Eigen::Index>(q.techniques());
  const auto pdf = [](const At& here, Eigen::Index k) { return here.pdfs[static_cast<std::size_t>(k)]; };
  const auto over_mixture = [](const At& here, double x) { return here.mixture > 0 ? x / here.mixture : 0; };
  Eigen::MatrixXd gram(n, n);
  Eigen::VectorXd moments(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    moments[i] = q.integrate([&](const At& here) { return over_mixture(here, here.f * pdf(here, i)); });
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram(i, j) = gram(j, i) =
          q.integrate([&](const At& here) { return over_mixture(here, pdf(here, i) * pdf(here, j)); });
    }
  }
  const Eigen::VectorXd alpha = gram.completeOrthogonalDecomposition().solve(moments);
  const auto worth = [&](const At& here) {
    double fit = 0;
    for (Eigen::Index k = 0; k < n; ++k) fit += alpha[k] * pdf(here, k);
    return over_mixture(here, difference(here.f, fit));
  };
  Cumulants round;
  for (std::size_t k = 0; k < q.techniques(); ++k)
    round.add(cumulants_from_central_moments(0, central_moments(q, k, 0, worth)), q.count(k));
  round.orders[1] = alpha.sum();
  return round;
}

}  // namespace

std::optional<Cumulants> exact_round_cumulants(const Estimator& estimator, const ExactDensities& densities) {
  const Quadrature q(estimator, densities);
  if (estimator.heuristic.kind == HeuristicKind::kOptimalProgressive) return std::nullopt;
  if (estimator.heuristic.kind == HeuristicKind::kOptimal) return optimal_cumulants(q);
  return estimator.allocation.one_sample ? one_sample_cumulants(q) : fold_cumulants(q);
}

}  // namespace halfslope
