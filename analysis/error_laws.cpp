#include "analysis/error_laws.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <memory>

namespace halfslope {

ErrorLaw gaussian_errors() {
  return {"Gaussian", 1, [](RunRandom& random) { return random.normal(); }, nullptr};
}

ErrorLaw uniform_errors() {
  return {"uniform", 1.0 / 3, [](RunRandom& random) { return 2 * random.uniform() - 1; }, nullptr};
}

ErrorLaw laplace_errors() {
  return {"Laplace", 2,
          [](RunRandom& random) {
            const double u = random.uniform();
            return u < 0.5 ? std::log(2 * u) : -std::log(2 - 2 * u);
          },
          nullptr};
}

ErrorLaw lognormal_errors(double sigma) {
  const double mean = std::exp(sigma * sigma / 2);
  return {fmt::format("lognormal({:g})", sigma), std::expm1(sigma * sigma) * mean * mean,
          [=](RunRandom& random) { return std::exp(sigma * random.normal()) - mean; },
          [=](double q) { return std::exp(-sigma * boost::math::quantile(boost::math::normal(), q)) - mean; }};
}

ErrorLaw pareto_errors(double alpha) {
  const double mean = alpha / (alpha - 1);
  const auto quantile = [=](double q) { return std::pow(q, -1 / alpha) - mean; };
  return {fmt::format("Pareto({:g})", alpha), alpha / ((alpha - 1) * (alpha - 1) * (alpha - 2)),
          [=](RunRandom& random) { return quantile(random.uniform()); }, quantile};
}

namespace {

/// Quantiles between knots. A probability q = 2^e (1 + j/64 + …) lies in the cell of its own leading bits, so cells are
/// narrow where the tail is steep.
class TabulatedLaw {
 public:
  explicit TabulatedLaw(std::function<double(double)> upper_quantile) : quantile_(std::move(upper_quantile)) {
    for (std::uint64_t k = 0; k < std::size(knots_); ++k) {
      const double q = std::bit_cast<double>((kFirst + k) << kShift);
      knots_[k] = quantile_(std::min(q, 1 - 0x1p-33));  // the other end of the law may be infinite
    }
  }

  double draw(RunRandom& random) const {
    const std::uint32_t word = random.word();
    if (word < 4096) return quantile_((word + random.uniform()) * 0x1p-32);
    const auto bits = std::bit_cast<std::uint64_t>((word + 0.5) * 0x1p-32);
    const std::uint64_t cell = (bits >> kShift) - kFirst;
    const double within = static_cast<double>(bits & ((std::uint64_t{1} << kShift) - 1)) * 0x1p-46;
    return knots_[cell] + within * (knots_[cell + 1] - knots_[cell]);
  }

 private:
  static constexpr int kShift = 46;                          // 6 bits of the mantissa are left
  static constexpr std::uint64_t kFirst = (1023 - 20) * 64;  // of 2^−20, the least probability
  std::function<double(double)> quantile_;
  std::array<double, 20 * 64 + 1> knots_{};
};

}  // namespace

ErrorLaw mean_errors(const ErrorLaw& law, int count) {
  const auto table = std::make_shared<const TabulatedLaw>(law.upper_quantile);
  return {fmt::format("means of {} {}", count, law.name), law.variance / count,
          [table, count](RunRandom& random) {
            double sum = 0;
            for (int k = 0; k < count; ++k) sum += table->draw(random);
            return sum / count;
          },
          nullptr};
}

std::vector<double> lognormal_scales(int count, double sigma) {
  const boost::math::normal normal;
  std::vector<double> scales;
  for (int i = 0; i < count; ++i) scales.push_back(std::exp(sigma * boost::math::quantile(normal, (i + 0.5) / count)));
  return scales;
}

}  // namespace halfslope
