#include "estimators/exact_variance.h"

#include <Eigen/QR>
#include <array>
#include <boost/math/quadrature/gauss_kronrod.hpp>

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

  template <class Value>
  double integrate(const Value& value) const {
    // A jump inside an interval is bisected so often; where only rounding is left to be seen, it ends there too.
    constexpr unsigned kDepth = 14;
    constexpr double kTolerance = 1e-10;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < densities_.breaks.size(); ++i) {
      sum += boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
          [&](double x) { return value(at(x)); }, densities_.breaks[i], densities_.breaks[i + 1], kDepth, kTolerance);
    }
    return sum;
  }

 private:
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

/// ∫ p (w f / (share p) − mean)².
double spread(const Quadrature& q, std::size_t k, double share, double mean) {
  return q.integrate([&](const At& here) {
    const double p = here.pdfs[k];
    if (p == 0) return 0.0;
    const double d = here.weights[k] * here.f / (share * p) - mean;
    return p * d * d;
  });
}

double fold_variance(const Quadrature& q) {
  double sum = 0;
  for (std::size_t k = 0; k < q.techniques(); ++k) {
    const double mean = q.integrate([&](const At& here) { return here.weights[k] * here.f; });
    sum += spread(q, k, 1, mean) / q.count(k);
  }
  return sum;
}

double one_sample_variance(const Quadrature& q) {
  const double mean = q.integrate([](const At& here) { return here.f; });
  double all = 0, sum = 0;
  for (std::size_t k = 0; k < q.techniques(); ++k) all += q.count(k);
  for (std::size_t k = 0; k < q.techniques(); ++k) sum += q.count(k) / all * spread(q, k, q.count(k) / all, mean);
  return sum;
}

double optimal_variance(const Quadrature& q) {
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
  return q.integrate([&](const At& here) {
    double g = here.f;
    for (Eigen::Index k = 0; k < n; ++k) g -= alpha[k] * pdf(here, k);
    return over_mixture(here, g * g);
  });
}

}  // namespace

std::optional<double> exact_round_variance(const Estimator& estimator, const ExactDensities& densities) {
  const Quadrature q(estimator, densities);
  if (estimator.heuristic.kind == HeuristicKind::kOptimalProgressive) return std::nullopt;
  if (estimator.heuristic.kind == HeuristicKind::kOptimal) return optimal_variance(q);
  return estimator.allocation.one_sample ? one_sample_variance(q) : fold_variance(q);
}

}  // namespace halfslope
