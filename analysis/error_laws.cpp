#include "analysis/error_laws.h"

#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <memory>

#include "analysis/compensated_sum.h"
#include "analysis/coverage.h"

namespace halfslope {

ErrorLaw gaussian_errors() {
  return {"Gaussian", 1, [](RunRandom& random) { return random.normal(); }};
}

ErrorLaw uniform_errors() {
  return {"uniform", 1.0 / 3, [](RunRandom& random) { return 2 * random.uniform() - 1; }};
}

ErrorLaw laplace_errors() {
  return {"Laplace", 2, [](RunRandom& random) {
            const double u = random.uniform();
            return u < 0.5 ? std::log(2 * u) : -std::log(2 - 2 * u);
          }};
}

ErrorLaw lognormal_errors(double sigma) {
  const double mean = std::exp(sigma * sigma / 2);
  return {fmt::format("lognormal({:g})", sigma), std::expm1(sigma * sigma) * mean * mean,
          [=](RunRandom& random) { return std::exp(sigma * random.normal()) - mean; }};
}

ErrorLaw pareto_errors(double alpha) {
  const double mean = alpha / (alpha - 1);
  return {fmt::format("Pareto({:g})", alpha), alpha / ((alpha - 1) * (alpha - 1) * (alpha - 2)),
          [=](RunRandom& random) { return std::pow(random.uniform(), -1 / alpha) - mean; }};
}

ErrorLaw mean_errors(const ErrorLaw& law, int count, std::uint64_t seed, int threads) {
  constexpr std::uint32_t kPool = 1 << 20, kRuns = 1024;
  const auto pool = std::make_shared<std::vector<double>>(kPool);
  for_each_run({kRuns, seed, threads}, 0, [&](std::int64_t run) {
    RunRandom random(seed, static_cast<std::uint64_t>(run), 0x706f6f6c);
    for (std::uint32_t i = 0; i < kPool / kRuns; ++i) {
      double sum = 0;
      for (int k = 0; k < count; ++k) sum += law.draw(random);
      (*pool)[static_cast<std::size_t>(run) * (kPool / kRuns) + i] = sum / count;
    }
  });
  CompensatedSum sum, squares;
  for (const double value : *pool) sum.add(value);
  for (double& value : *pool) {
    value -= sum.value() / kPool;
    squares.add(value * value);
  }
  return {fmt::format("means of {} {}", count, law.name), squares.value() / kPool,
          [pool](RunRandom& random) { return (*pool)[random.below(kPool)]; }};
}

std::vector<double> lognormal_scales(int count, double sigma) {
  const boost::math::normal normal;
  std::vector<double> scales;
  for (int i = 0; i < count; ++i) scales.push_back(std::exp(sigma * boost::math::quantile(normal, (i + 0.5) / count)));
  return scales;
}

}  // namespace halfslope
